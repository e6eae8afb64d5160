// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The runs of a page, from what the command line of `view` and `serve` names: recordings, recordings of crowds, and
/// scenarios, which are run with every half-plane, or without decisions (support/simulation_flags.h).

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "explorer/packed_run.h"
#include "explorer/page.h"
#include "support/simulation_flags.h"

namespace exactvo::tools {

struct PageFlags {
  std::vector<std::string> runs;  ///< none: the scenes to start from
  SimulationFlags simulation;
  DecisionFlags decisions;
  PackedRunLimits limits;
};

/// Declares the names of runs, at most `most`, --most-states, --most-numbers and how scenarios are run.
void declare_page_flags(CLI::App& app, PageFlags& flags, int most, const std::string& what_runs_are);

/// Throws UsageError unless `out` is a name for a page: of a file, and none of the inputs.
void check_page_name(const std::string& option, const std::string& out,
                     const std::vector<std::filesystem::path>& inputs);

/// Writes it, whole or not at all, and says so.
void publish_page(const std::string& out, const std::string& page);

/// In the order of the names, each with a key of its own. Throws DataError, UsageError, Interrupted.
std::vector<MadeRun> page_runs(const PageFlags& flags);

}  // namespace exactvo::tools
