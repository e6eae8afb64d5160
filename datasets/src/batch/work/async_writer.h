// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A thread that waits for the disk, so that no worker does: one part's fsync takes a tenth of what it takes to make
/// the part, file systems do one after the other, and two workers that wait themselves lose twice as much by it as one.

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace exactvo::datasets::batch {

class AsyncWriter {
 public:
  AsyncWriter();
  /// Waits; what fails then is not said.
  ~AsyncWriter();
  AsyncWriter(const AsyncWriter&) = delete;
  AsyncWriter& operator=(const AsyncWriter&) = delete;

  /// Runs it soon, in the order given; at once in the caller's thread, where jobs that hold kMostBytesWaiting wait
  /// already. Throws what an earlier job threw, whereupon none is run any more.
  void run(std::function<void()> job, std::uint64_t bytes);
  /// Until nothing waits. Throws what a job threw, each time.
  void finish();

  /// Two or three parts with everything wanted.
  static constexpr std::uint64_t kMostBytesWaiting = std::uint64_t{32} << 20;

 private:
  struct Job {
    std::function<void()> work;
    std::uint64_t bytes = 0;
  };
  void work_on();
  void run_next(std::unique_lock<std::mutex>& lock);
  void rethrow() const;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;  ///< the first one may be under way
  std::uint64_t bytes_ = 0;
  std::exception_ptr failure_;
  bool ends_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace exactvo::datasets::batch
