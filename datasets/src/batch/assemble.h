// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The outputs of a batch from its parts, in order of inputs and chunks; memory holds one part at a time.

#include <string>

#include "batch/ledger.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// What goes into summary.json beside the counts: all that differs from run to run.
struct Times {
  double seconds = 0.0;
  double seconds_of_jobs = 0.0;  ///< of all workers together
  std::uint64_t obstacles = 0;   ///< taken apart in this run
  std::uint64_t vertices = 0;
  int workers = 1;
  bool has_rates = true;  ///< not of a shard: what the others took is not known
  std::string written_at;
};

/// Whether every input has its facts.
bool all_there(const Ledger& ledger, std::size_t inputs);

/// Puts everything into `ledger.final_folder()`, started before, and publishes it.
BatchSummary assemble(const Ledger& ledger, const Identity& identity, const BatchConfiguration& configuration,
                      const BatchRun& run, Times times);

/// What a complete output says of itself.
BatchSummary read_summary(const std::filesystem::path& out);

}  // namespace exactvo::datasets::batch
