// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/crew.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace exactvo::datasets::batch {
namespace {

/// Chunks that wait for each of the others when the reader takes one itself: enough that none runs dry meanwhile,
/// however uneven they are; few enough to hold.
constexpr std::size_t kJobsAWorker = 8;

}  // namespace

Crew::Crew(int workers, std::uint64_t most_bytes)
    : threads_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(std::max(workers, 1))),
      arena_(std::max(workers, 1)),
      most_bytes_(most_bytes),
      most_jobs_(kJobsAWorker * static_cast<std::size_t>(std::max(workers, 1) - 1)) {}

Crew::~Crew() {
  try {
    finish();
  } catch (const std::exception&) {
    // Said already, or nobody is left to hear it.
  }
}

void Crew::run(std::function<void()> job, std::uint64_t bytes) {
  if (failed_ || (most_bytes_ > 0 && jobs_ > 0 && bytes_ + bytes > most_bytes_)) finish();
  if (jobs_ >= most_jobs_) return job();
  ++jobs_;
  bytes_ += bytes;
  arena_.execute([&] {
    group_.run([this, bytes, work = std::move(job)] {
      try {
        work();
      } catch (...) {
        failed_ = true;
        throw;
      }
      bytes_ -= bytes;
      --jobs_;
    });
  });
}

void Crew::finish() {
  arena_.execute([this] { group_.wait(); });
  scribe_.finish();
}

}  // namespace exactvo::datasets::batch
