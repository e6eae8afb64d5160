// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Ranks that are threads of one process, for tests of what is stepped over ranks.

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "exactvo/formation/ranks.h"

namespace exactvo::formation::test {

/// Where the ranks meet.
class Meeting {
 public:
  explicit Meeting(int size) : size_(size), bytes_(static_cast<std::size_t>(size)), first_failed_(size) {}

  int size() const { return size_; }

  /// Waits for all.
  void meet() {
    std::unique_lock lock(mutex_);
    const int meeting = meeting_;
    if (++arrived_ == size_) {
      arrived_ = 0;
      ++meeting_;
      all_.notify_all();
    } else {
      all_.wait(lock, [&] { return meeting_ != meeting; });
    }
  }

  /// Throws AnotherRankFailed where a rank has.
  void agree() {
    meet();
    const std::lock_guard lock(mutex_);
    if (first_failed_ < size_) throw AnotherRankFailed();
  }

  bool fail(int rank) {
    {
      const std::lock_guard lock(mutex_);
      first_failed_ = std::min(first_failed_, rank);
    }
    meet();
    const std::lock_guard lock(mutex_);
    return first_failed_ == rank;
  }

  /// What each rank shows the others, between two meetings.
  std::vector<std::string> show(int rank, std::string bytes) {
    agree();
    bytes_[static_cast<std::size_t>(rank)] = std::move(bytes);
    meet();
    std::vector<std::string> all = bytes_;
    meet();
    return all;
  }

 private:
  const int size_;
  std::mutex mutex_;
  std::condition_variable all_;
  int arrived_ = 0, meeting_ = 0;
  std::vector<std::string> bytes_;
  int first_failed_;
};

class ThreadRank final : public Ranks {
 public:
  ThreadRank(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return meeting_.size(); }

  void share(const std::vector<SharedArray>& arrays) override {
    for (const SharedArray& a : arrays) {
      auto* const array = static_cast<char*>(a.bytes);
      const auto own = static_cast<std::size_t>(rank_);
      const auto begin = [&](std::size_t r) { return r > 0 ? a.ends[r - 1] : 0; };
      const auto all = meeting_.show(rank_, std::string(array + begin(own), a.ends[own] - begin(own)));
      for (std::size_t r = 0; r < all.size(); ++r) std::copy(all[r].begin(), all[r].end(), array + begin(r));
    }
  }

  std::int64_t least(std::int64_t value) override {
    const auto all = meeting_.show(rank_, std::string(reinterpret_cast<const char*>(&value), 8));
    for (const std::string& bytes : all) value = std::min(value, number(bytes));
    return value;
  }

  std::vector<std::string> gather(const std::string& own) override {
    auto all = meeting_.show(rank_, own);
    if (rank_ > 0) all.clear();
    return all;
  }

  std::string broadcast(const std::string& bytes) override { return meeting_.show(rank_, bytes)[0]; }
  bool fail() override { return meeting_.fail(rank_); }

 private:
  static std::int64_t number(const std::string& bytes) {
    std::int64_t value = 0;
    std::memcpy(&value, bytes.data(), 8);
    return value;
  }

  Meeting& meeting_;
  int rank_;
};

/// Calls work(ranks) in `count` threads, one a rank; throws what the first that failed threw. `quiet` counts the others
/// that learned of it.
template <class Work>
void in_ranks(int count, const Work& work, int* quiet = nullptr) {
  Meeting meeting(count);
  std::mutex mutex;
  std::exception_ptr failure;
  std::vector<std::thread> threads;
  for (int r = 0; r < count; ++r)
    threads.emplace_back([&, r] {
      ThreadRank ranks(meeting, r);
      try {
        work(ranks);
        ranks.least(0);
      } catch (const AnotherRankFailed&) {
        const std::lock_guard lock(mutex);
        if (quiet) ++*quiet;
      } catch (...) {
        const std::exception_ptr thrown = std::current_exception();
        if (!ranks.fail()) return;
        const std::lock_guard lock(mutex);
        failure = thrown;
      }
    });
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace exactvo::formation::test
