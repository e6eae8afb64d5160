// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/binder.h"

#include <system_error>

#include "batch/input_record.h"

namespace exactvo::datasets::batch {
namespace {

/// Bound by a worker that brings one: its own and one of those that wait, so that they grow fewer; not more, or a
/// reader that works along would leave the others without work.
constexpr int kBoundAtOnce = 2;

PartView view_at(PartKey key, const std::string& bytes, const Ledger& ledger) {
  return view_of_part(bytes, ledger.part(key.first, key.second));
}

}  // namespace

Binder::Binder(const Ledger& ledger, const BatchConfiguration& configuration, const std::string& provenance)
    : ledger_(ledger) {
  ledger.start_final(false);
  outputs_ = std::make_unique<Outputs>(ledger.final_folder(), configuration, provenance);
}

Binder::~Binder() {
  if (!outputs_) return;
  outputs_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(ledger_.final_folder(), ignored);
}

/// Not where its input is through or has ended before it.
bool Binder::counts(PartKey key) const {
  const auto closed = chunks_of_.find(key.first);
  return !is_spoiled_ && key >= next_ && (closed == chunks_of_.end() || key.second < closed->second);
}

void Binder::put(PartKey key, Bytes bytes) {
  if (!counts(key)) return;
  const std::uint64_t size = bytes ? bytes->size() : 0;
  if (waiting_.emplace(key, std::move(bytes)).second) bytes_ += size;
}

bool Binder::take(PartKey key, Bytes bytes) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool holds = key == next_ || bytes_ + bytes->size() <= kMostBytesWaiting;
  if (holds) put(key, std::move(bytes));
  if (is_binding_) return holds;
  for (int bound = 0; bound < kBoundAtOnce && turn_over(); ++bound) bind_next(lock);
  return holds;
}

void Binder::found(PartKey key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  put(key, nullptr);
}

void Binder::close(std::size_t input, std::uint64_t chunks) {
  const std::lock_guard<std::mutex> lock(mutex_);
  chunks_of_[input] = chunks;
  const auto end = waiting_.lower_bound({input + 1, 0});
  for (auto at = waiting_.lower_bound({input, chunks}); at != end; at = waiting_.erase(at)) {
    bytes_ -= at->second ? at->second->size() : 0;
  }
}

/// Goes past inputs that are through. Whether the next part waits.
bool Binder::turn_over() {
  for (auto closed = chunks_of_.find(next_.first); closed != chunks_of_.end() && next_.second >= closed->second;
       closed = chunks_of_.find(next_.first)) {
    is_spoiled_ = is_spoiled_ || next_.second > closed->second;
    chunks_of_.erase(closed);
    next_ = {next_.first + 1, 0};
  }
  return !is_spoiled_ && waiting_.count(next_) > 0;
}

void Binder::bind_next(std::unique_lock<std::mutex>& lock) {
  const auto next = waiting_.find(next_);
  const PartKey key = next->first;
  Bytes bytes = std::move(next->second);
  waiting_.erase(next);
  bytes_ -= bytes ? bytes->size() : 0;
  ++next_.second;
  is_binding_ = true;
  lock.unlock();
  try {
    if (!bytes) bytes = std::make_shared<const std::string>(read_part_bytes(ledger_, key.first, key.second));
    outputs_->add(view_at(key, *bytes, ledger_));
  } catch (...) {
    lock.lock();
    is_binding_ = false;
    is_spoiled_ = true;
    throw;
  }
  bytes.reset();
  lock.lock();
  is_binding_ = false;
}

std::unique_ptr<Outputs> Binder::finish(std::size_t inputs) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (turn_over()) bind_next(lock);
  std::error_code error;
  const bool is_whole =
      !is_spoiled_ && next_ == PartKey{inputs, 0} && std::filesystem::is_directory(ledger_.final_folder(), error);
  return is_whole ? std::move(outputs_) : nullptr;
}

}  // namespace exactvo::datasets::batch
