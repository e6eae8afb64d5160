// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/run.h"

#include <iostream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "figures/gnuplot.h"
#include "figures/lyapunov_figure.h"
#include "figures/run_figures.h"
#include "support/files.h"
#include "support/terminal.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using formation::Scenario;
using formation::SimulationOptions;

namespace {

datasets::RunInfo run_info(const Scenario& scenario, const SimulationOptions& options,
                           const datasets::Provenance& provenance) {
  datasets::RunInfo info{scenario.name, name(options.method), std::nullopt, std::nullopt, provenance};
  if (scenario.formation) {
    info.controller = name(options.controller);
    info.integrator = name(options.integrator);
  }
  return info;
}

std::vector<std::vector<geometry::ConvexShape>> enclosures(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<std::vector<geometry::ConvexShape>> all;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) all.push_back(enclosures_for(scenario, options, i));
  return all;
}

datasets::LoadedScenario load(const std::string& path) {
  if (path != "-") return datasets::load_scenario_with_notes(path);
  const std::string text{std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
  return datasets::parse_scenario_with_notes(text, "-", fs::current_path());
}

}  // namespace

std::string FinishedRun::metrics_json() const {
  return datasets::metrics_json(file.info, metrics);
}

FinishedRun run(const Scenario& scenario, SimulationOptions options, const datasets::Provenance& provenance,
                const std::function<void(double)>& progress) {
  options.progress = [&](double time) {
    if (progress) progress(time);
    return !interrupted();
  };
  formation::Recording recording = simulate(scenario, options);
  if (interrupted()) throw Interrupted();
  FinishedRun finished;
  finished.metrics = measure(scenario, recording);
  finished.file = {
      run_info(scenario, options, provenance), scenario, enclosures(scenario, options), std::move(recording), {}, {}};
  const formation::Recording& kept = finished.file.recording;
  if (scenario.formation) finished.file.lyapunov = lyapunov_along(scenario, kept);
  finished.file.stuck = explain_stuck(scenario, kept);
  return finished;
}

void write_results(const FinishedRun& run, const fs::path& folder) {
  write_recording(folder / "recording.jsonl", run.file);
  write_trajectory_csv(folder / "trajectory.csv", run.file);
  if (!run.file.lyapunov.empty()) write_text(folder / "lyapunov.csv", lyapunov_csv(run.file.lyapunov));
  write_text(folder / "metrics.json", run.metrics_json());
}

std::vector<fs::path> write_figures(const FinishedRun& run, const fs::path& folder) {
  make_folder(folder);
  std::vector<fs::path> scripts;
  for (const Figure& figure : run_figures(run.file)) scripts.push_back(write_sources(figure, folder));
  return scripts;
}

void draw(const std::vector<fs::path>& scripts) {
  const RenderResult result = render(scripts);
  switch (result.outcome) {
    case Rendering::done:
      return;
    case Rendering::no_gnuplot:
      message("gnuplot is not installed (Debian: gnuplot-nox): the figures' data and scripts are written, no pictures");
      return;
    case Rendering::failed:
      // Ctrl-C reaches gnuplot too.
      if (interrupted()) throw Interrupted();
      throw std::runtime_error("gnuplot failed: " + result.message);
  }
}

Scenario read_scenario(const std::string& path) {
  datasets::LoadedScenario loaded = load(path);
  for (const std::string& note : loaded.notes) message(note);
  return std::move(loaded.scenario);
}

std::vector<fs::path> input_files(const std::string& path) {
  if (path == "-") return {};
  return datasets::files_of_scenario(path);
}

}  // namespace exactvo::tools
