// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The end of a batch: parts that nobody merged while others were made, one at a time; the summary; all in its place.

#include <functional>
#include <memory>
#include <string>

#include "batch/merge/outputs.h"
#include "batch/merge/summary.h"
#include "batch/plan/journal.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// JSON; the same in every output and at any time.
std::string provenance_of(const Identity& identity, const BatchRun& run);

/// Whether every input has its facts.
bool all_there(const Journal& journal, std::size_t inputs);

/// Merges all parts of so many inputs from the disk. What `before_each` part throws, it throws.
std::unique_ptr<Outputs> merge_all(const Journal& journal, std::size_t inputs, const BatchConfiguration& configuration,
                                   const std::string& provenance, const std::function<void()>& before_each);

/// Finishes `outputs`, which hold all parts, writes what is missing beside them, and moves everything to its place.
BatchSummary publish(Outputs& outputs, const Journal& journal, const Identity& identity,
                     const BatchConfiguration& configuration, const std::string& provenance, Times times);

}  // namespace exactvo::datasets::batch
