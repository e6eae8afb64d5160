// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/async_writer.h"

#include <utility>

namespace exactvo::datasets::batch {

AsyncWriter::AsyncWriter() : thread_([this] { work_on(); }) {}

AsyncWriter::~AsyncWriter() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void AsyncWriter::rethrow() const {
  if (failure_) std::rethrow_exception(failure_);
}

void AsyncWriter::run(std::function<void()> job, std::uint64_t bytes) {
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

void AsyncWriter::finish() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty(); });
  rethrow();
}

void AsyncWriter::work_on() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    run_next(lock);
    changed_.notify_all();
  }
}

/// It stays in the queue until it is done, so that `finish` waits for it; what follows a failure is dropped.
void AsyncWriter::run_next(std::unique_lock<std::mutex>& lock) {
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
