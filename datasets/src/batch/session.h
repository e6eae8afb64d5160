// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One process's part in a batch, an ordered pipeline over one journal (docs/adr/0014-batch-pipeline.md):
///
///     claim    which inputs are this process's: all of them, every n-th (a shard), a share by size (a rank)
///     read     one at a time, in order: input -> chunks of obstacles; what the journal has is not read again
///     work     any number at a time: chunk -> part (text, rows), which goes to the journal
///     finish   one at a time, in order: part -> outputs, if this process merges; the end of an input -> its facts
///
/// At the end one process puts the outputs in their place. Whatever a kill leaves, the journal says what is missing.

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "batch/merge/outputs.h"
#include "batch/merge/summary.h"
#include "batch/plan/journal.h"
#include "batch/work/process.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

class Session {
 public:
  /// `run` and `configuration` must outlive it.
  Session(const BatchConfiguration& configuration, const BatchRun& run, std::vector<Input> inputs, BatchWatch watch);

  const Journal& journal() const { return journal_; }
  const Identity& identity() const { return identity_; }

  // --- Progress, for the watch ---

  /// Which inputs are to be done.
  void plan(const std::vector<std::size_t>& inputs);
  /// Asks the watch whether to go on, with so much of the input under way read.
  bool look(const std::string& doing, double input_bytes = 0.0);

  // --- Work ---

  /// Has parts merged as soon as all before them are, unless another process does so. REQUIRES: all inputs are this
  /// process's, in order.
  void merge_ahead();
  /// Makes what is missing of the inputs. All of it is on disk then, whatever is thrown: DataError for what is wrong
  /// with the output, and where an input changed since it was listed (E_OTHER_RUN; its parts are then gone); Stopped.
  void process(const std::vector<std::size_t>& inputs);
  /// What was made since this was asked before, to be counted elsewhere.
  Counts take_counts();
  /// What another process made for this one.
  void count(const Counts& more);
  /// This process does its share of the work, as one of `ranks`.
  void be_rank(int rank, int ranks) {
    progress_.rank = rank;
    progress_.ranks = ranks;
  }
  /// Puts everything together if all is there and no other process has.
  BatchResult finish();

 private:
  Counts counted() const;
  void read(std::size_t input, const GivePiece& give);
  void work_on(Piece& piece);
  void finish_piece(Piece& piece);
  void merge(const Piece& piece);
  void finish_input(const Piece& last);
  BatchSummary put_together(BatchResult& result);
  BatchSummary publish();
  Times times() const;

  const BatchConfiguration& configuration_;
  const BatchRun& run_;
  Identity identity_;
  std::string provenance_;  ///< JSON
  BatchWatch watch_;
  Journal journal_;
  Allowance memory_;  ///< of chunks that are processed
  mutable std::mutex counting_;
  Counts counts_;
  std::unique_ptr<Outputs> outputs_;        ///< where parts are merged while others are made
  std::atomic<bool> is_merging_{false};     ///< the same, for any thread
  std::optional<std::size_t> last_merged_;  ///< an input
  BatchProgress progress_;
  std::uint64_t bytes_done_ = 0;  ///< of inputs
  std::chrono::steady_clock::time_point start_;
};

}  // namespace exactvo::datasets::batch
