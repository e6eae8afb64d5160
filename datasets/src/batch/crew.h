// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Workers that take a reader's chunks apart while it reads on. What they make does not depend on how many they are:
/// every job writes a file of its own. One more thread waits for the disk.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include "batch/scribe.h"

namespace exactvo::datasets::batch {

class Crew {
 public:
  /// `workers` threads, the caller's among them. `most_bytes` bounds the sum of what jobs under way say they take.
  Crew(int workers, std::uint64_t most_bytes);
  /// Waits.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Runs it soon; now, where enough is waiting for the others, so that nobody stands idle and little is held. Waits
  /// while more than `most_bytes` are under way. Throws what an earlier job threw, or this one.
  void run(std::function<void()> job, std::uint64_t bytes);
  /// Of a job: has `write`, which holds so many bytes, run soon by the thread that waits for the disk (Scribe).
  void put_away(std::function<void()> write, std::uint64_t bytes) { scribe_.run(std::move(write), bytes); }
  /// Until all is done and put away. Throws what a job threw.
  void finish();

 private:
  Scribe scribe_;                ///< first: jobs use it until the end
  tbb::global_control threads_;  ///< as many as asked for, be there fewer processors
  tbb::task_arena arena_;
  tbb::task_group group_;
  std::uint64_t most_bytes_;
  std::size_t most_jobs_;
  std::atomic<std::uint64_t> bytes_{0};  ///< of jobs handed out and not done
  std::atomic<std::size_t> jobs_{0};
  std::atomic<bool> failed_{false};
};

}  // namespace exactvo::datasets::batch
