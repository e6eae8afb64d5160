// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/merge/ordered_merge.h"

#include <system_error>
#include <utility>

#include "batch/plan/input_record.h"

namespace exactvo::datasets::batch {
namespace {

/// Merged by a worker that brings one: its own and one of those that wait, so that they grow fewer; not more, or a
/// reader that works along would leave the others without work.
constexpr int kMergedAtOnce = 2;

PartView view_at(PartKey key, const std::string& bytes, const Journal& journal) {
  return view_of_part(bytes, journal.part(key.first, key.second));
}

}  // namespace

OrderedMerge::Folder::Folder(const Journal& of) : path(of.final_folder()) {
  of.start_final(Journal::LockState::claim);
}

OrderedMerge::Folder::~Folder() {
  if (is_given_out) return;
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

OrderedMerge::OrderedMerge(const Journal& journal, FileLock claim, const BatchConfiguration& configuration,
                           const std::string& provenance)
    : journal_(journal),
      claim_(std::move(claim)),
      folder_(journal),
      outputs_(std::make_unique<Outputs>(journal.final_folder(), configuration, provenance)) {}

/// Not where its input is through or has ended before it.
bool OrderedMerge::counts(PartKey key) const {
  const auto closed = chunks_of_.find(key.first);
  return !is_spoiled_ && key >= next_ && (closed == chunks_of_.end() || key.second < closed->second);
}

void OrderedMerge::put(PartKey key, Bytes bytes) {
  if (!counts(key)) return;
  const std::uint64_t size = bytes ? bytes->size() : 0;
  if (waiting_.emplace(key, std::move(bytes)).second) bytes_ += size;
}

bool OrderedMerge::take(PartKey key, Bytes bytes) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool holds = key == next_ || bytes_ + bytes->size() <= kMostBytesWaiting;
  if (holds) put(key, std::move(bytes));
  if (is_merging_) return holds;
  for (int merged = 0; merged < kMergedAtOnce && next_waits(); ++merged) merge_next(lock);
  return holds;
}

void OrderedMerge::found(PartKey key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  put(key, nullptr);
}

void OrderedMerge::close(std::size_t input, std::uint64_t chunks) {
  const std::lock_guard<std::mutex> lock(mutex_);
  chunks_of_[input] = chunks;
  const auto end = waiting_.lower_bound({input + 1, 0});
  for (auto at = waiting_.lower_bound({input, chunks}); at != end; at = waiting_.erase(at)) {
    bytes_ -= at->second ? at->second->size() : 0;
  }
}

void OrderedMerge::pass_ended_inputs() {
  for (auto ended = chunks_of_.find(next_.first); ended != chunks_of_.end() && next_.second >= ended->second;
       ended = chunks_of_.find(next_.first)) {
    is_spoiled_ = is_spoiled_ || next_.second > ended->second;
    chunks_of_.erase(ended);
    next_ = {next_.first + 1, 0};
  }
}

bool OrderedMerge::next_waits() {
  pass_ended_inputs();
  return !is_spoiled_ && waiting_.count(next_) > 0;
}

void OrderedMerge::merge_next(std::unique_lock<std::mutex>& lock) {
  const auto next = waiting_.find(next_);
  const PartKey key = next->first;
  Bytes bytes = std::move(next->second);
  waiting_.erase(next);
  bytes_ -= bytes ? bytes->size() : 0;
  ++next_.second;
  is_merging_ = true;
  lock.unlock();
  try {
    if (!bytes) bytes = std::make_shared<const std::string>(read_part_bytes(journal_, key.first, key.second));
    outputs_->add(view_at(key, *bytes, journal_));
  } catch (...) {
    lock.lock();
    is_merging_ = false;
    is_spoiled_ = true;
    throw;
  }
  bytes.reset();
  lock.lock();
  is_merging_ = false;
}

std::unique_ptr<Outputs> OrderedMerge::finish(std::size_t inputs, const std::function<void()>& before_each) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (next_waits()) {
    before_each();
    merge_next(lock);
  }
  std::error_code error;
  folder_.is_given_out =
      !is_spoiled_ && next_ == PartKey{inputs, 0} && std::filesystem::is_directory(folder_.path, error);
  return folder_.is_given_out ? std::move(outputs_) : nullptr;
}

}  // namespace exactvo::datasets::batch
