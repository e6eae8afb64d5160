// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// simulate without recorded decisions: a scenario on the certified crowd (formation/crowd_run.h), recorded as .evr,
/// with snapshots, alone or over ranks.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/ranks.h"
#include "support/run.h"
#include "support/simulation_flags.h"

namespace exactvo::tools {

struct CrowdFlags {
  std::uint32_t every = 1;
  std::size_t snapshot_every = 0;
  bool resume = false;
  int threads = 1;
  std::string precision = "float";
  std::vector<CLI::Option*> without_decisions;  ///< what recorded decisions exclude
};

/// After `declare_decisions`.
void declare_crowd_flags(CLI::App& app, CrowdFlags& flags);

/// Throws UsageError where one of the options that recorded decisions exclude was given, with why.
void refuse_crowd_flags(const CrowdFlags& flags);

struct CrowdTask {
  const CrowdFlags& flags;
  const SimulationFlags& simulation;
  std::string file;                      ///< of the scenario
  const datasets::LoadedScenario& read;  ///< with the liveness of the command line
  std::filesystem::path record = {};     ///< FILE.evr; empty: none. Snapshots stand beside it
  formation::Ranks* ranks = nullptr;     ///< that run it together with this process
  bool keeps_snapshot = false;  ///< after the run, until `remove_snapshot`: what follows may be interrupted too
};

/// Runs it. Nothing in ranks other than the first. Throws DataError, UsageError, Interrupted.
std::optional<FinishedRun> run_on_crowd(const CrowdTask& task);

/// For a run that keeps a snapshot beside `record`: a recording there that an interrupted run has left with its
/// snapshot becomes an unfinished one, to go on with. Throws DataError (E_FILE_UNWRITABLE) where another file stands
/// there.
void take_up(const std::filesystem::path& record);
/// The snapshot beside a recording, if there is one.
void remove_snapshot(const std::filesystem::path& record);

/// What was run, before it is.
datasets::RunInfo crowd_info(const CrowdTask& task);

/// The figures and the table of a recording of a crowd, into a folder: figures/, trajectory.csv where it has at most
/// `kMostTableLines`. True of figures where the recording was cut off.
bool draw_crowd_figures(const std::filesystem::path& recording, const std::filesystem::path& folder);
inline constexpr std::size_t kMostTableLines = 1'000'000;
void write_crowd_table(const FinishedRun& run, const std::filesystem::path& recording,
                       const std::filesystem::path& folder);

}  // namespace exactvo::tools
