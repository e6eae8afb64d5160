// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Workers that take a reader's chunks apart while it reads on. What they make does not depend on how many they are:
/// every job writes a file of its own.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace exactvo::datasets::batch {

class Crew {
 public:
  /// `workers` threads, the caller's among them. `most_bytes` bounds the sum of what jobs under way say they take.
  Crew(int workers, std::uint64_t most_bytes);
  /// Waits.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Runs it soon, perhaps now. Waits, and lends a hand, while too much is under way. Throws what an earlier job threw.
  void run(std::function<void()> job, std::uint64_t bytes);
  /// Until all is done. Throws what a job threw.
  void finish();

 private:
  tbb::global_control threads_;  ///< as many as asked for, be there fewer processors
  tbb::task_arena arena_;
  tbb::task_group group_;
  std::uint64_t most_bytes_;
  std::size_t most_jobs_;
  std::uint64_t bytes_ = 0;  ///< handed out since the last wait
  std::size_t jobs_ = 0;
  std::atomic<bool> failed_{false};
};

}  // namespace exactvo::datasets::batch
