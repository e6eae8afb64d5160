// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/scribe.h"

#include <utility>

namespace exactvo::datasets::batch {

Scribe::Scribe() : thread_([this] { work_on(); }) {}

Scribe::~Scribe() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Scribe::rethrow() const {
  if (failure_) std::rethrow_exception(failure_);
}

void Scribe::run(std::function<void()> job, std::uint64_t bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    rethrow();
    if (bytes_ + bytes <= kMostBytesWaiting) {
      bytes_ += bytes;
      jobs_.push_back({std::move(job), bytes});
      changed_.notify_all();
      return;
    }
  }
  job();
}

void Scribe::finish() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty(); });
  rethrow();
}

void Scribe::work_on() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    run_next(lock);
    changed_.notify_all();
  }
}

/// It stays in the queue until it is done, so that `finish` waits for it; what follows a failure is dropped.
void Scribe::run_next(std::unique_lock<std::mutex>& lock) {
  Job job = std::move(jobs_.front());
  if (!failure_) {
    lock.unlock();
    std::exception_ptr failure;
    try {
      job.work();
    } catch (...) {
      failure = std::current_exception();
    }
    job.work = nullptr;  // frees what it holds
    lock.lock();
    failure_ = failure;
  }
  bytes_ -= job.bytes;
  jobs_.pop_front();
}

}  // namespace exactvo::datasets::batch
