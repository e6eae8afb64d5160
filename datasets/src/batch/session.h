// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One process's part in a batch: what run_batch does alone and run_batch_over_ranks in company.

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "batch/merge/ordered_merge.h"
#include "batch/merge/summary.h"
#include "batch/plan/journal.h"
#include "batch/work/process.h"
#include "batch/work/thread_pool.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// Canonical: what changes the results and nothing else.
std::string to_json(const BatchConfiguration& configuration);

Identity identity_of(const BatchConfiguration& configuration, std::vector<Input> inputs);

/// `part` of `whole`; of nothing, all.
double share_of(std::uint64_t part, std::uint64_t whole);

/// What was processed.
struct Counts {
  std::uint64_t obstacles = 0;
  std::uint64_t vertices = 0;
  std::uint64_t nanoseconds_of_jobs = 0;
};

class Session {
 public:
  /// `run` and `configuration` must outlive it.
  Session(const BatchConfiguration& configuration, const BatchRun& run, Identity identity, BatchWatch watch);

  const Journal& journal() const { return journal_; }
  const Identity& identity() const { return identity_; }

  /// Says which inputs are this process's, for progress.
  void plan(std::vector<std::size_t> inputs);
  /// Has parts merged while others are made, unless another process does so. REQUIRES: all inputs are this
  /// process's, in order.
  void merge_ahead();
  /// Reads an input and sets the pool to make what is missing of it. Throws Stopped.
  void process(std::size_t input);
  /// Until all that was processed is there.
  void wait();
  /// As `wait`, and says nothing of what failed.
  void rest() noexcept { pool_.rest(); }
  /// What was processed so far, here and by what `count` added.
  Counts counted() const;
  /// What another process processed for this one.
  void count(const Counts& more);
  /// Says how many processes do the work instead of this one.
  void joined_by(int processes) { processes_ = processes; }
  /// Puts everything together if all is there and no other process has.
  BatchResult finish();

 private:
  bool look(const std::string& doing, double share);
  WorkContext context();
  void tell_merge_of(std::size_t input);
  void look_before_a_part();
  std::unique_ptr<Outputs> merged(BatchResult& result, bool is_alone);
  BatchSummary put_together(BatchResult& result, bool is_alone);
  Times times() const;

  const BatchConfiguration& configuration_;
  const BatchRun& run_;
  Identity identity_;
  std::string provenance_;  ///< JSON
  BatchWatch watch_;
  Journal journal_;
  Counters counters_;
  std::optional<OrderedMerge> merge_;
  ThreadPool pool_;  ///< after what its jobs write to: its destructor waits for them
  int processes_ = 1;
  BatchProgress progress_;
  std::uint64_t bytes_planned_ = 0;
  std::uint64_t bytes_done_ = 0;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace exactvo::datasets::batch
