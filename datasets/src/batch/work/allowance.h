// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Memory that several threads may take together.

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

namespace exactvo::datasets::batch {

class Allowance {
 public:
  /// Memory that a holder has taken; free again when the holder is destroyed.
  using Taken = std::shared_ptr<const void>;

  /// 0: as much as they want.
  explicit Allowance(std::uint64_t most_bytes) : most_(most_bytes) {}
  Allowance(const Allowance&) = delete;
  Allowance& operator=(const Allowance&) = delete;

  /// Waits until so much is free. What is more than all there is goes alone.
  Taken take(std::uint64_t bytes) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return most_ == 0 || taken_ == 0 || taken_ + bytes <= most_; });
    taken_ += bytes;
    return {this, [this, bytes](const void*) { give_back(bytes); }};
  }

 private:
  void give_back(std::uint64_t bytes) {
    const std::lock_guard<std::mutex> lock(mutex_);
    taken_ -= bytes;
    changed_.notify_all();
  }

  std::uint64_t most_;
  std::uint64_t taken_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace exactvo::datasets::batch
