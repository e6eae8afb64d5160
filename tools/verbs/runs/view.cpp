// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo view: runs as a page for a browser.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/input_files.h"
#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/recording_file.h"
#include "explorer/packed_run.h"
#include "explorer/page.h"
#include "explorer/scenes.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

struct Flags {
  std::vector<std::string> runs;
  SimulationFlags simulation;
  std::string out;
  std::size_t states = PackedRunLimits{}.states;
  std::size_t decision_numbers = PackedRunLimits{}.decision_numbers;
};

/// Those that the run itself wrote, else measured again.
std::string metrics_beside(const fs::path& recording, const datasets::RecordingFile& file) {
  if (recording.filename() == "recording.jsonl") {
    std::ifstream in(recording.parent_path() / "metrics.json");
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (!text.empty()) return text;
  }
  return datasets::metrics_json(file.info, formation::measure(file.scenario, file.recording));
}

std::string title_of(const datasets::RecordingFile& file) {
  const datasets::RunInfo& info = file.info;
  return info.scenario + ", " + info.method + (info.controller ? ", " + *info.controller : "") +
         (info.guidance ? ", " + *info.guidance : "");
}

PageRun recorded(const Flags& flags, const fs::path& path) {
  const datasets::RecordingFile file = datasets::read_recording(path);
  return {page_key(title_of(file)), title_of(file), "",
          packed_run(file, metrics_beside(path, file), {flags.states, flags.decision_numbers})};
}

/// With every half-plane.
PageRun simulated(const Flags& flags, const std::string& path) {
  formation::SimulationOptions options = simulation_options(flags.simulation);
  options.record_all = true;
  const ReadScenario read = read_scenario(path);
  note_unused(flags.simulation, read.scenario);
  const auto provenance = datasets::make_provenance(command_line(), flags.simulation.seed, read.files);
  ProgressLine line(read.scenario.time_limit, "s simulated");
  RunOutput output;
  output.figures = false;
  output.page = true;
  output.page_limits = {flags.states, flags.decision_numbers};
  output.progress = [&](double time) { line.show(time, read.scenario.name); };
  FinishedRun finished = run(read.scenario, options, provenance, output);
  return {page_key(title_of(finished.file)), title_of(finished.file), "", std::move(finished.packed)};
}

/// Runs of one name get a number behind it.
void tell_apart(std::vector<PageRun>& runs) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string key = runs[k].key;
    std::size_t number = 1;
    const auto is_taken = [&](const PageRun& other) { return other.key == runs[k].key; };
    while (std::any_of(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(k), is_taken))
      runs[k].key = fmt::format("{}-{}", key, ++number);
    if (number > 1) runs[k].title += fmt::format(" ({})", number);
  }
}

std::vector<PageRun> runs_for(const Flags& flags) {
  const TerminateOnSignal terminate_on_signal;
  if (flags.runs.empty()) return guided_scenes();
  bool any_simulated = false;
  std::vector<PageRun> runs;
  for (const std::string& path : flags.runs) {
    const auto recording = recording_at(path);
    any_simulated = any_simulated || !recording;
    runs.push_back(recording ? recorded(flags, *recording) : simulated(flags, path));
  }
  if (!any_simulated) note_recorded(flags.simulation);
  tell_apart(runs);
  return runs;
}

/// Before any work: the page must not replace what it is made from.
void check_out(const Flags& flags) {
  const fs::path out(flags.out);
  if (out.extension() != ".html" && out.extension() != ".htm")
    throw UsageError("--out", flags.out, "a name that ends in .html");
  std::error_code unknown;
  if (fs::is_directory(out, unknown)) throw UsageError("--out", flags.out, "a file, not a folder");
  for (const std::string& path : flags.runs) {
    const fs::path file = recording_at(path).value_or(path);
    if (fs::equivalent(file, out, unknown)) throw UsageError("--out", flags.out, "another file than the run's own");
  }
}

ExitCode view(const Flags& flags) {
  check_out(flags);
  const std::string page = explorer_page(runs_for(flags), flags.runs.empty());
  if (interrupted()) throw Interrupted();
  datasets::write_file_atomically(flags.out, page);
  message(
      fmt::format("wrote {} ({:.1f} MB): open it in a browser", flags.out, 1e-6 * static_cast<double>(page.size())));
  return ExitCode::success;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("runs", flags->runs,
                 "Folders of runs, recordings (.jsonl), or scenarios, which are run with every half-plane; none: three "
                 "scenes to start from");
  declare_out(app, flags->out, "The page: one file, FILE.html, that needs no network")->required();
  app.add_option("--most-states", flags->states,
                 "Positions in the page per run, robots times rows; beyond, rows are left out")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 26));
  app.add_option(
         "--most-numbers", flags->decision_numbers,
         "Numbers of decisions in the page per run, about 14 a robot and row and 6 a half-plane; beyond, decisions "
         "are left out")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 28));
  declare_simulation_flags(app, flags->simulation);
  return [flags] { return view(*flags); };
}

}  // namespace

Verb view_verb() {
  return {"view", "Make a page to explore runs in a browser: the world, velocity space, the proofs",
          "  exactvo view --out start.html\n"
          "  exactvo simulate datasets/data/paper/A7.json --record-all --out out/A7\n"
          "  exactvo view out/A7 --out a7.html\n"
          "  exactvo view datasets/data/paper/A1.json --method orca --out a1.html\n",
          declare};
}

}  // namespace exactvo::tools
