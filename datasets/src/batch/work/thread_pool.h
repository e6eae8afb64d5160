// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Worker threads that process a reader's chunks while it reads on. What they make does not depend on how many they
/// are: every job writes a file of its own, and these are merged in order (ordered_merge.h). One more thread waits for
/// the disk.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <utility>

#include "batch/work/async_writer.h"

namespace exactvo::datasets::batch {

/// One thread hands out, waits and ends it.
class ThreadPool {
 public:
  /// `workers` threads, the caller's among them. `most_bytes` bounds the sum of what jobs under way say they take; 0
  /// does not.
  ThreadPool(int workers, std::uint64_t most_bytes);
  /// Waits.
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Runs it soon; at once in the caller's thread where enough jobs wait, so that no worker idles and little is held.
  /// Before that it does waiting jobs itself, or waits, while more than `most_bytes` would be under way; a job that
  /// takes more runs alone. It does not wait for the disk. Throws what an earlier job threw, or this one, each time and
  /// after all was put away; no job is run any more then.
  void run(std::function<void()> job, std::uint64_t bytes);
  /// Of a job: has `write`, which holds so many bytes, run soon by the thread that waits for the disk (AsyncWriter).
  void put_away(std::function<void()> write, std::uint64_t bytes) { writer_.run(std::move(write), bytes); }
  /// Until all is done and put away, whatever failed. Throws what a job threw, each time.
  void finish();
  /// As `finish`, and says nothing: for whoever is told of a failure already.
  void rest() noexcept;

 private:
  struct Job {
    std::function<void()> work;
    std::uint64_t bytes = 0;
  };
  void make_room(std::uint64_t bytes, std::unique_lock<std::mutex>& lock);
  void set_to_work();
  void run_next(std::unique_lock<std::mutex>& lock);
  void carry_out(Job job, std::unique_lock<std::mutex>& lock);

  AsyncWriter writer_;  ///< first: jobs use it until the end
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  std::size_t under_way_ = 0;  ///< jobs handed out and not done: waiting or being run, by whomever
  std::uint64_t bytes_ = 0;    ///< of those
  std::exception_ptr failure_;
  std::uint64_t most_bytes_;
  std::size_t most_jobs_;
  tbb::global_control threads_;  ///< as many as asked for, be there fewer processors
  tbb::task_arena arena_;
  tbb::task_group group_;  ///< last: a task for every job that waits, all of the above is theirs
};

}  // namespace exactvo::datasets::batch
