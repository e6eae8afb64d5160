// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// summary.json of a batch, which is written last and says that all is there; and what it says in words.

#include <filesystem>
#include <string>
#include <vector>

#include "batch/plan/input_record.h"
#include "batch/plan/journal.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// What goes into it beside the counts: all that differs from run to run.
struct Times {
  double seconds = 0.0;
  Counts made;  ///< in this run
  int workers = 1;
  bool has_rates = true;  ///< not of a shard: what the others took is not known
  std::string written_at;
};

/// The counts of inputs that ended so; those of their parts are not known here.
BatchSummary summary_of(const Identity& identity, const std::vector<InputFacts>& facts);

std::string to_json(const BatchSummary& summary, const Identity& identity, const std::string& provenance,
                    const std::vector<InputFacts>& facts, const Times& times);

/// What a complete output says of itself.
BatchSummary read_summary(const std::filesystem::path& out);

/// "12 files: 10 done, ...".
std::string words_of(const BatchTally& tally, const char* what);
std::string words_of(const InputFacts& facts);

}  // namespace exactvo::datasets::batch
