// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The end of a batch: what was bound and what is left, in order of inputs and chunks; memory holds one part at a time.

#include <memory>
#include <string>

#include "batch/ledger.h"
#include "batch/outputs.h"
#include "batch/summary.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// JSON; the same in every output and at any time.
std::string provenance_of(const Identity& identity, const BatchRun& run);

/// Whether every input has its facts.
bool all_there(const Ledger& ledger, std::size_t inputs);

/// Binds all parts from the disk, in `ledger.final_folder()`, started before.
std::unique_ptr<Outputs> bind_all(const Ledger& ledger, const Identity& identity,
                                  const BatchConfiguration& configuration, const BatchRun& run);

/// Finishes `outputs`, which hold all parts, writes what is missing beside them, and publishes everything.
BatchSummary finish_outputs(std::unique_ptr<Outputs> outputs, const Ledger& ledger, const Identity& identity,
                            const BatchConfiguration& configuration, const BatchRun& run, Times times);

}  // namespace exactvo::datasets::batch
