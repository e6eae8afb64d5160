// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One run from a scenario to files: what `simulate` does once and `paper` many times.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/simulation.h"
#include "figures/figure.h"
#include "figures/gnuplot.h"
#include "support/run_recorder.h"

namespace exactvo::tools {

struct FinishedRun {
  datasets::RecordingFile file;  ///< of the rows those that figures show (run_recorder.h)
  formation::Metrics metrics;
  std::string packed = {};  ///< for a page (explorer/page.h), where one was asked for
  std::string metrics_json() const;
};

/// What makes a page and nothing else.
RunOutput for_page(const PackedRunLimits& limits);

/// Runs the scenario and measures it, and writes recording.jsonl, trajectory.csv, metrics.json and, of a formation,
/// lyapunov.csv as it goes: memory does not grow with the run. Throws Interrupted where the user stopped it.
FinishedRun run(const formation::Scenario& scenario, formation::SimulationOptions options,
                const datasets::Provenance& provenance, const RunOutput& output = {});

/// "method ivo, controller default".
std::string method_words(const datasets::RunInfo& run);
/// The same behind the name of the scenario: "A2, method ivo, controller default".
std::string in_words(const datasets::RunInfo& run);

/// The run whose metrics.json stands in the folder, if any; its integrator and provenance are not read.
std::optional<datasets::RunInfo> run_in(const std::filesystem::path& folder);

/// Throws datasets::DataError (E_OTHER_RUN) if the folder holds an earlier run of another scenario, or run otherwise.
void check_same_run(const std::filesystem::path& folder, const datasets::RunInfo& run);

/// Throws datasets::DataError (E_FORMAT_UNKNOWN) where the path is figures/ or a file beside a recording, such as
/// trajectory.csv: what is meant is the folder of the run, which is named.
void refuse_part_of_run(const std::filesystem::path& path);

/// The recording that a path means: `recording.jsonl` or `recording.evr` of a folder, or the file itself if its name
/// ends in .jsonl or .evr. Throws as refuse_part_of_run.
std::optional<std::filesystem::path> recording_at(const std::filesystem::path& path);

/// The figures' data and scripts in `folder`, which is created. Returns the scripts, for `draw`.
std::vector<std::filesystem::path> write_figures(const std::vector<Figure>& figures,
                                                 const std::filesystem::path& folder);

/// The figures of a run, drawn into `folder`, which is created.
void draw_figures_of(const datasets::RecordingFile& run, const std::filesystem::path& folder);

/// A scenario from a file or a pipe, which is read once, or from stdin where `path` is "-". Its notes are printed.
datasets::LoadedScenario read_scenario(const std::string& path);

}  // namespace exactvo::tools
