// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo view: runs as a page for a browser.
#include "verbs/runs/view.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/datasets/trajectory_file.h"
#include "figures/figure.h"
#include "support/files.h"
#include "support/run.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/runs/simulate_crowd.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

// --- The runs of a page ---

/// A wall and why ORCA stops before it, four robots on a circle, a formation through a gap: run at once, with every
/// half-plane, and two sentences each.
std::vector<MadeRun> guided_scenes(const PackedRunLimits& limits) {
  std::vector<MadeRun> runs;
  for (const auto& scene : nlohmann::ordered_json::parse(embedded_templates().at("scenes"))) {
    formation::SimulationOptions options;
    parse(scene.at("method").get<std::string>(), options.method);
    options.record_all = true;
    const std::string key = scene.at("key");
    const formation::Scenario scenario = datasets::parse_scenario(scene.at("scenario").dump(), key, ".");
    FinishedRun finished = run(scenario, options, datasets::make_provenance({}, 0), for_page(limits));
    runs.push_back(
        {{key, scene.at("title").get<std::string>(), scene.at("words").get<std::string>(), std::move(finished.packed)},
         options});
  }
  return runs;
}

/// Those that the run itself wrote; empty where it did not.
std::string metrics_beside(const fs::path& recording) {
  if (recording.filename() != "recording.jsonl" && recording.filename() != "recording.evr") return "";
  std::ifstream in(recording.parent_path() / "metrics.json");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// What a recorded run was made with.
formation::SimulationOptions options_of(const datasets::RecordingFile& file) {
  const datasets::RunInfo& info = file.info;
  formation::SimulationOptions options;
  parse(info.method, options.method);
  if (info.controller) parse(*info.controller, options.controller);
  if (info.integrator) parse(*info.integrator, options.integrator);
  options.guidance = formation::Guidance::none;
  if (info.guidance) parse(*info.guidance, *options.guidance);
  options.liveness = formation::Liveness::off;
  if (info.liveness) parse(*info.liveness, *options.liveness);
  options.controller_options = file.recording.controller_options;
  return options;
}

/// Row by row: what stays in memory is what the page keeps of them.
MadeRun recorded(const PageFlags& flags, const fs::path& path) {
  RunPacker packer(flags.limits);
  std::string metrics = metrics_beside(path);
  formation::Scenario scenario;  // the evaluator refers to it
  std::optional<formation::Evaluator> evaluator;
  const auto take = [&](const datasets::RecordingFile& so_far, formation::Step row, const formation::LyapunovRow*) {
    packer.add(row);
    if (!metrics.empty()) return;
    if (!evaluator) evaluator.emplace(scenario = so_far.scenario, so_far.recording);
    evaluator->add(std::make_shared<const formation::Step>(std::move(row)));
  };
  const datasets::RecordingFile file = datasets::read_recording(path, take);
  if (evaluator) metrics = datasets::metrics_json(file.info, evaluator->finish(file.recording).metrics);
  const std::string title = title_of(file);
  return {{page_key(title), title, "", packer.finish(file, metrics)}, options_of(file)};
}

/// Nothing computes with it: it has neither goals nor decisions.
MadeRun recorded_crowd(const PageFlags& flags, const fs::path& path, const std::string& metrics) {
  const PackedCrowd crowd = packed_crowd(path, flags.limits, metrics);
  if (crowd.is_cut_off) message("warning: " + path.string() + ": the recording was cut off after its last whole row");
  const std::string title = crowd.scenario + ", decisions none";
  return {{page_key(title), title, "", crowd.packed}, std::nullopt};
}

/// Recorded for the page alone.
MadeRun simulated_crowd(const PageFlags& flags, const std::string& path, datasets::LoadedScenario read) {
  read.scenario.liveness = simulation_options(flags.simulation).liveness.value_or(read.scenario.liveness);
  const StagedFolder folder(fs::temp_directory_path() / "exactvo-view");
  const fs::path recording = folder.path() / "recording.evr";
  const CrowdFlags crowd;
  const std::optional<FinishedRun> run = run_on_crowd({crowd, flags.simulation, path, read, recording});
  return recorded_crowd(flags, recording, run->metrics_json());
}

/// With every half-plane, or without decisions.
MadeRun simulated(const PageFlags& flags, const std::string& path) {
  formation::SimulationOptions options = simulation_options(flags.simulation);
  options.record_all = true;
  const datasets::LoadedScenario read = read_scenario(path);
  const Way way = way_of(flags.decisions, flags.simulation, path, read.scenario, "", false);
  if (!way.words.empty()) message(way.words);
  note_unused(flags.simulation, read.scenario);
  if (way.is_crowd) return simulated_crowd(flags, path, read);
  note_liveness(flags.simulation, read.scenario, options);
  const auto provenance = datasets::make_provenance(command_line(), flags.simulation.seed, read.files);
  ProgressLine line(read.scenario.time_limit, "s simulated");
  RunOutput output = for_page(flags.limits);
  output.progress = [&](double time) { line.show(time, read.scenario.name); };
  FinishedRun finished = run(read.scenario, options, provenance, output);
  return {{page_key(title_of(finished.file)), title_of(finished.file), "", std::move(finished.packed)}, options};
}

// --- The verb ---

struct ViewFlags {
  PageFlags page;
  std::string out;
};

ExitCode view(const ViewFlags& flags) {
  std::vector<fs::path> inputs;
  for (const std::string& path : flags.page.runs) inputs.push_back(recording_at(path).value_or(path));
  check_page_name("--out", flags.out, inputs);
  std::vector<PageRun> runs;
  for (MadeRun& made : page_runs(flags.page)) runs.push_back(std::move(made.shown));
  const std::string page = explorer_page(runs, flags.page.runs.empty());
  if (interrupted()) throw Interrupted();
  publish_page(flags.out, page);
  return ExitCode::success;
}

void declare_view(CLI::App& app, ViewFlags& flags) {
  declare_page_flags(app, flags.page, CLI::detail::expected_max_vector_size,
                     "Folders of runs, recordings (.jsonl, of crowds .evr), or scenarios, which are run with every "
                     "half-plane; none: three scenes to start from");
  declare_out(app, flags.out, "The page: one file, FILE.html, that needs no network")->required();
}

}  // namespace

void check_page_name(const std::string& option, const std::string& out, const std::vector<fs::path>& inputs) {
  const fs::path page(out);
  if (page.extension() != ".html" && page.extension() != ".htm")
    throw UsageError(option, out, "a name that ends in .html");
  std::error_code unknown;
  if (fs::is_directory(page, unknown)) throw UsageError(option, out, "a file, not a folder");
  for (const fs::path& input : inputs)
    if (fs::equivalent(input, page, unknown)) throw UsageError(option, out, "another file than what is read");
}

void publish_page(const std::string& out, const std::string& page) {
  make_folder(fs::absolute(out).parent_path());
  datasets::write_file_atomically(out, page);
  message(fmt::format("wrote {} ({:.1f} MB): open it in a browser", out, 1e-6 * static_cast<double>(page.size())));
}

void declare_page_flags(CLI::App& app, PageFlags& flags, int most, const std::string& what_runs_are) {
  app.add_option("runs", flags.runs, what_runs_are)->expected(0, most);
  app.add_option("--most-states", flags.limits.states,
                 "Positions in the page per run, robots times rows; beyond, rows are left out")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 26));
  app.add_option(
         "--most-numbers", flags.limits.decision_numbers,
         "Numbers of decisions in the page per run, about 14 a robot and row and 6 a half-plane; beyond, decisions "
         "are left out")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 28));
  declare_simulation_flags(app, flags.simulation);
  declare_decisions(app, flags.decisions);
}

std::vector<MadeRun> page_runs(const PageFlags& flags) {
  const TerminateOnSignal terminate_on_signal;
  if (flags.runs.empty()) return guided_scenes(flags.limits);
  bool any_simulated = false;
  std::vector<MadeRun> runs;
  for (const std::string& path : flags.runs) {
    if (const auto recording = recording_at(path)) {
      const bool is_crowd = datasets::is_crowd_recording(*recording);
      runs.push_back(is_crowd ? recorded_crowd(flags, *recording, metrics_beside(*recording))
                              : recorded(flags, *recording));
    } else {
      if (const std::string format = datasets::recognised_trajectory_format(path); !format.empty())
        throw datasets::DataError(
            datasets::DataCode::format_unknown, path, "", "trajectories (" + format + ")",
            "a run or a scenario; 'exactvo check FILE --radius R --page FILE.html' shows trajectories");
      any_simulated = true;
      runs.push_back(simulated(flags, path));
    }
  }
  if (!any_simulated) note_recorded(flags.simulation);
  std::set<std::string> taken;
  for (MadeRun& run : runs) {
    make_key_distinct(run.shown, taken);
    taken.insert(run.shown.key);
  }
  return runs;
}

Verb view_verb() {
  return {"view", "Make a page to explore runs in a browser: the world, velocity space, the proofs",
          "  exactvo view --out start.html\n"
          "  exactvo simulate datasets/data/paper/A7.json --decisions all --out out/A7\n"
          "  exactvo view out/A7 --out a7.html\n"
          "  exactvo view datasets/data/paper/A1.json --method orca --out a1.html\n",
          with_flags(declare_view, view)};
}

}  // namespace exactvo::tools
