// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/run.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/metrics_file.h"
#include "figures/gnuplot.h"
#include "figures/run_figures.h"
#include "support/files.h"
#include "support/terminal.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

/// With decisions, or without.
std::optional<fs::path> recording_in(const fs::path& folder) {
  std::error_code unknown;
  for (const char* name : {"recording.jsonl", "recording.evr"})
    if (fs::is_regular_file(folder / name, unknown)) return folder / name;
  return std::nullopt;
}

bool has_recording(const fs::path& folder) {
  return recording_in(folder).has_value();
}

/// The folder of the run that this is a part of: a file that simulate wrote beside the recording, figures/ or a file of
/// it. Files of other names may stand there too, a scenario for instance.
std::optional<fs::path> run_around(const fs::path& path) {
  std::error_code unknown;
  fs::path part = path.has_filename() ? path : path.parent_path();
  if (fs::is_directory(part, unknown) ? part.filename() != "figures" || has_recording(part)
                                      : !fs::is_regular_file(part, unknown))
    return std::nullopt;
  if (part.parent_path().filename() == "figures") part = part.parent_path();
  static const std::set<std::string> kParts{"figures", "trajectory.csv", "metrics.json", "lyapunov.csv",
                                            "explorer.html"};
  if (kParts.count(part.filename().string()) == 0) return std::nullopt;
  const fs::path folder = part.has_parent_path() ? part.parent_path() : fs::path(".");
  return has_recording(folder) ? std::optional(folder) : std::nullopt;
}

}  // namespace

std::string FinishedRun::metrics_json() const {
  return datasets::metrics_json(file.info, metrics);
}

RunOutput for_page(const PackedRunLimits& limits) {
  RunOutput output;
  output.figures = false;
  output.page = true;
  output.page_limits = limits;
  return output;
}

FinishedRun run(const formation::Scenario& scenario, formation::SimulationOptions options,
                const datasets::Provenance& provenance, const RunOutput& output) {
  options.progress = [&](double time) {
    if (output.progress) output.progress(time);
    return !interrupted();
  };
  datasets::RecordingFile about;
  about.info = datasets::run_info(scenario, options, provenance);
  about.scenario = scenario;
  RunRecorder recorder(std::move(about), output);
  formation::Recording recording = simulate(scenario, options, recorder);
  if (interrupted()) throw Interrupted();
  FinishedRun finished;
  finished.metrics = recorder.finish(std::move(recording), finished.file);
  if (output.page) finished.packed = recorder.packed(finished.file, finished.metrics_json());
  if (!output.folder.empty()) write_text(output.folder / "metrics.json", finished.metrics_json());
  return finished;
}

std::string in_words(const datasets::RunInfo& run) {
  return run.scenario + ", " + method_words(run);
}

std::string method_words(const datasets::RunInfo& run) {
  return "method " + run.method + (run.controller ? ", controller " + *run.controller : "") +
         (run.guidance ? ", guidance " + *run.guidance : "") + (run.liveness ? ", liveness " + *run.liveness : "") +
         (run.decisions == "none" ? ", decisions none" : "");
}

std::optional<datasets::RunInfo> run_in(const fs::path& folder) {
  std::ifstream file(folder / "metrics.json");
  const auto metrics = nlohmann::json::parse(file, nullptr, false);
  if (!metrics.is_object()) return std::nullopt;
  const auto text = [&](const char* key) -> std::optional<std::string> {
    const auto found = metrics.find(key);
    if (found == metrics.end() || !found->is_string()) return std::nullopt;
    return found->get<std::string>();
  };
  const auto decisions = metrics.find("decisions");
  const bool is_none =
      decisions != metrics.end() && decisions->is_object() && decisions->value("recorded", "") == "none";
  return datasets::RunInfo{text("scenario").value_or(""),
                           text("method").value_or(""),
                           text("controller"),
                           {},
                           {},
                           text("guidance"),
                           text("liveness"),
                           is_none ? "none" : "binding"};
}

void check_same_run(const fs::path& folder, const datasets::RunInfo& run) {
  const std::optional<datasets::RunInfo> earlier = run_in(folder);
  const auto name = [](const datasets::RunInfo& r) {
    return std::tuple(r.scenario, r.method, r.controller, r.guidance, r.liveness, r.decisions == "none");
  };
  if (!earlier || name(*earlier) == name(run)) return;
  throw datasets::DataError(datasets::DataCode::other_run, folder.string(), "",
                            "an earlier run of " + in_words(*earlier),
                            "an earlier run of " + in_words(run) + ", another folder, or --force to replace it");
}

void refuse_part_of_run(const fs::path& path) {
  if (const std::optional<fs::path> folder = run_around(path))
    throw datasets::DataError(datasets::DataCode::format_unknown, path.string(), "",
                              fs::is_directory(path) ? "a folder within a run" : "a file of a run, not its recording",
                              "the folder of the run: " + folder->string());
}

std::optional<fs::path> recording_at(const fs::path& path) {
  refuse_part_of_run(path);
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return recording_in(path).value_or(path / "recording.jsonl");
  return path.extension() == ".jsonl" || path.extension() == ".evr" ? std::optional(path) : std::nullopt;
}

std::vector<fs::path> write_figures(const std::vector<Figure>& figures, const fs::path& folder) {
  make_folder(folder);
  std::vector<fs::path> scripts;
  for (const Figure& figure : figures) scripts.push_back(write_sources(figure, folder));
  return scripts;
}

void draw_figures_of(const datasets::RecordingFile& run, const fs::path& folder) {
  draw(write_figures(run_figures(run), folder), run.info.scenario);
}

datasets::LoadedScenario read_scenario(const std::string& path) {
  if (path != "-" && (has_recording(path) || run_around(path)))
    throw datasets::DataError(datasets::DataCode::format_unknown, path, "",
                              fs::is_directory(path) ? "the folder of a run" : "a file of a run",
                              "a scenario in JSON; draw, explain, view, serve and audit take runs");
  datasets::LoadedScenario loaded =
      path != "-" ? datasets::load_scenario_with_notes(path)
                  : datasets::parse_scenario_with_notes(datasets::read_file_or_input("-"), "-", fs::current_path());
  for (const std::string& note : loaded.notes) message(note);
  return loaded;
}

}  // namespace exactvo::tools
