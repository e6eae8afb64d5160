// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/thread_pool.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "exactvo/geometry/seen_by_tsan.h"

namespace exactvo::datasets::batch {
namespace {

/// Chunks that wait for each of the others when the reader takes one itself: enough that none runs dry meanwhile,
/// however uneven they are; few enough to hold.
constexpr std::size_t kJobsAWorker = 8;

}  // namespace

ThreadPool::ThreadPool(int workers, std::uint64_t most_bytes)
    : most_bytes_(most_bytes > 0 ? most_bytes : std::numeric_limits<std::uint64_t>::max()),
      most_jobs_(kJobsAWorker * static_cast<std::size_t>(std::max(workers, 1) - 1)),
      threads_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(std::max(workers, 1))),
      arena_(std::max(workers, 1)) {}

ThreadPool::~ThreadPool() {
  rest();
}

void ThreadPool::run(std::function<void()> job, std::uint64_t bytes) {
  std::unique_lock<std::mutex> lock(mutex_);
  make_room(bytes, lock);
  const bool now = failure_ || under_way_ >= most_jobs_;
  ++under_way_;
  bytes_ += bytes;
  if (now) {
    carry_out({std::move(job), bytes}, lock);
  } else {
    waiting_.push_back({std::move(job), bytes});
  }
  const bool failed = failure_ != nullptr;
  lock.unlock();
  if (failed) return finish();
  if (!now) set_to_work();
}

/// Works itself as long as a job waits: the others may be fewer than asked for, or none.
void ThreadPool::make_room(std::uint64_t bytes, std::unique_lock<std::mutex>& lock) {
  const auto has_room = [&] { return failure_ || under_way_ == 0 || bytes_ + bytes <= most_bytes_; };
  while (!has_room() && !waiting_.empty()) run_next(lock);
  changed_.wait(lock, has_room);
}

void ThreadPool::set_to_work() {
  arena_.execute([this] {
    geometry::gives_tasks();
    group_.run([this] {
      const geometry::TaskAtWork seen;
      std::unique_lock<std::mutex> lock(mutex_);
      run_next(lock);
    });
    geometry::gives_tasks();  // the task's copy of `this` as well
  });
}

/// The caller may have been quicker than the task that was to do it.
void ThreadPool::run_next(std::unique_lock<std::mutex>& lock) {
  if (waiting_.empty()) return;
  Job job = std::move(waiting_.front());
  waiting_.pop_front();
  carry_out(std::move(job), lock);
}

/// What follows a failure is dropped.
void ThreadPool::carry_out(Job job, std::unique_lock<std::mutex>& lock) {
  const bool drops = failure_ != nullptr;
  lock.unlock();
  std::exception_ptr failure;
  try {
    if (!drops) job.work();
  } catch (...) {
    failure = std::current_exception();
  }
  job.work = nullptr;  // frees what it holds
  lock.lock();
  if (!failure_) failure_ = failure;
  bytes_ -= job.bytes;
  --under_way_;
  changed_.notify_all();
}

void ThreadPool::finish() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!waiting_.empty()) run_next(lock);
  lock.unlock();
  arena_.execute([this] { group_.wait(); });
  lock.lock();
  std::exception_ptr failure = failure_;
  lock.unlock();
  // Whatever failed, nothing is being written any more when it is told.
  try {
    writer_.finish();
  } catch (...) {
    if (!failure) failure = std::current_exception();
  }
  if (failure) std::rethrow_exception(failure);
}

void ThreadPool::rest() noexcept {
  try {
    finish();
  } catch (...) {
    // Said already, or nobody is left to hear it.
  }
}

}  // namespace exactvo::datasets::batch
