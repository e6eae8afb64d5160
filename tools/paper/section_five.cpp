// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/section_five.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <utility>

#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "explorer/page.h"
#include "figures/outlines.h"
#include "figures/run_figures.h"
#include "paper/report_data.h"
#include "support/files.h"
#include "support/run.h"
#include "support/terminal.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using formation::Controller;
using formation::Method;

namespace {

constexpr Method kMethods[] = {Method::orca, Method::ivo_edge, Method::ivo_cluster, Method::ivo};
constexpr Controller kControllers[] = {Controller::paper_literal, Controller::paper_signs, Controller::standard};
constexpr int kAvoidanceScenarios = 16;  // A0-A15; A0 has no obstacle: the robots pass each other
constexpr int kFormationScenarios = 4;   // B0-B3
constexpr int kRuns = kAvoidanceScenarios * 4 + kFormationScenarios * 3;
/// The scenario that shows the difference best: two walls, and two robots that must also pass each other.
constexpr const char* kComparison = "A2";

/// The whole of Section V, as it goes.
class Experiments {
 public:
  Experiments(SectionFiveOptions flags, fs::path out)
      : flags_(std::move(flags)), out_(std::move(out)), line_(kRuns, "runs") {}

  void run_all() {
    for (int i = 0; i < kAvoidanceScenarios; ++i) run_avoidance("A" + std::to_string(i));
    for (int i = 0; i < kFormationScenarios; ++i) run_formation("B" + std::to_string(i));
    line_.clear();
  }

  std::string summary() const { return datasets::summary_json(metrics_); }

  void write_page() const { write_text(out_ / kPageName, explorer_page(pages_)); }

  /// All figures in one run of gnuplot.
  void draw_figures() {
    add_sheets();
    draw(scripts_);
  }

 private:
  FinishedRun run_one(const std::string& scenario_name, Method method, Controller controller) {
    const fs::path file = flags_.scenarios / (scenario_name + ".json");
    formation::SimulationOptions options;
    options.method = method;
    options.controller = controller;
    const auto provenance = datasets::make_provenance(flags_.command_line, flags_.seed, {file});
    line_.show(static_cast<double>(metrics_.size()), scenario_name + " " + name(method));
    FinishedRun finished =
        run(datasets::load_scenario(file), options, provenance, {{}, !flags_.no_figures, {}, {}, !flags_.no_figures});
    metrics_.push_back(finished.metrics_json());
    keep_for_page(scenario_name, finished);
    return finished;
  }

  /// A run keeps its own name: two of another --data may have the same.
  void keep_for_page(const std::string& scenario, FinishedRun& finished) {
    if (flags_.no_figures) return;
    const datasets::RunInfo& info = finished.file.info;
    const std::string how = info.controller ? *info.controller : info.method;
    pages_.push_back({page_key(scenario + "-" + how), scenario + ", " + how, "", std::move(finished.packed)});
  }

  void run_avoidance(const std::string& scenario) {
    for (const Method method : kMethods)
      keep_avoidance(scenario, run_one(scenario, method, Controller::standard), method);
  }

  void run_formation(const std::string& scenario) {
    for (const Controller controller : kControllers) {
      FinishedRun finished = run_one(scenario, Method::ivo, controller);
      auto& [before, after] = jitter_[static_cast<std::size_t>(scenario.back() - '0')];
      if (controller == Controller::paper_signs) before = finished.metrics.jitter;
      if (controller == Controller::standard) after = finished.metrics.jitter;
      keep_formation(scenario, std::move(finished), controller);
    }
  }

  /// Fig. 5 has the usual method, Fig. 6 the improved one: the paper's own, which verdicts are on, and the default.
  void keep_avoidance(const std::string& scenario, FinishedRun finished, Method method) {
    if (flags_.no_figures) return;
    if (method == Method::orca) add_figures(scenario, finished, "fig5-orca");
    if (method == Method::ivo_edge) add_figures(scenario, finished, "fig6-ivo-edge");
    if (method == Method::ivo) add_figures(scenario, finished, "fig6-ivo");
    avoidance_[method].push_back(std::move(finished.file));
  }

  void keep_formation(const std::string& scenario, FinishedRun finished, Controller controller) {
    if (flags_.no_figures) return;
    if (controller == Controller::standard) add_figures(scenario, finished, "fig8-formation");
    if (controller == Controller::paper_signs) add_figures(scenario, finished, "fig8-paper-signs");
    formation_.push_back(std::move(finished.file));
  }

  /// `scenario` is the name of its file: the one within it may be anything, a way out of the folder too.
  void add_figures(const std::string& scenario, const FinishedRun& finished, const std::string& folder) {
    const fs::path target = out_ / "figures" / folder / scenario;
    const std::vector<fs::path> scripts = write_figures(run_figures(finished.file), target);
    scripts_.insert(scripts_.end(), scripts.begin(), scripts.end());
  }

  static std::string panel_title(const datasets::RecordingFile& run) {
    const std::string& outcome = run.recording.outcome;
    const bool collided = !run.collisions.empty();
    // A panel is narrow, and all runs have the same limit.
    if (!run.scenario.formation)
      return run.info.scenario + ": " + (collided ? "collision; " : "") +
             outcome.substr(0, outcome.find(" within the time limit"));
    return run.info.scenario + ", " + *run.info.controller + (run.recording.diverged ? ": diverged" : "") +
           (collided ? ", collision" : "");
  }

  void add_sheets() {
    for (const Method method : kMethods) {
      std::vector<PathsPanel> panels;
      for (const auto& run : avoidance_[method]) panels.push_back({panel_title(run), &run});
      add_sheet(std::string("all-") + name(method), std::string("Section V.A, method ") + name(method), panels, 4);
    }
    std::vector<PathsPanel> panels;
    for (const auto& run : formation_) panels.push_back({panel_title(run), &run});
    add_sheet("all-formation", "Section V.B, method ivo: one column per controller", panels, 3);
    add_comparison();
    add_jitter();
  }

  /// J of the corrected signs and of the default, side by side.
  void add_jitter() {
    DataFile data;
    const int index = data.begin("jitter J [m/s^2]", "place, paper-signs, default, scenario");
    for (std::size_t i = 0; i < jitter_.size(); ++i)
      data.labelled_row({static_cast<double>(i), jitter_[i].first, jitter_[i].second}, "B" + std::to_string(i));
    PlotCommand plot;
    const char* style = "using ($1{}0.2):{}:(0.35) with boxes fs solid 0.8 noborder lc rgb '{}'";
    plot.data(index, fmt::format(fmt::runtime(style), '-', 2, series_colour(1)), "paper-signs");
    plot.data(index, fmt::format(fmt::runtime(style), '+', 3, series_colour(0)), "default");
    plot.data(index, "using 1:(NaN):xticlabels(4) with points");
    plot.data(index, "using ($1-0.2):2:(sprintf('%.0f', $2)) with labels offset 0,0.6 font ',10'");
    plot.data(index, "using ($1+0.2):3:(sprintf('%.0f', $3)) with labels offset 0,0.6 font ',10'");
    const std::string body =
        filled("jitter", {{"title", markup("Jitter {/:Italic J} = Σ |{/:Italic a}_{k+1} − {/:Italic a}_k| of two "
                                           "controllers; B0 has no obstacle")},
                          {"plot", plot.text()}});
    const Figure figure{"jitter",
                        data.text(),
                        "Jitter of two controllers: the sum of the changes of acceleration from step to step.",
                        {860, 460},
                        body};
    scripts_.push_back(write_sources(figure, out_ / "figures"));
  }

  void add_comparison() {
    std::vector<PathsPanel> panels;
    for (const Method method : {Method::orca, Method::ivo}) {
      for (const auto& run : avoidance_[method]) {
        if (run.info.scenario == kComparison) panels.push_back({std::string("method ") + name(method), &run});
      }
    }
    add_sheet("two-walls", "Two robots and two walls", panels, 2);
  }

  void add_sheet(const std::string& stem, const std::string& title, const std::vector<PathsPanel>& panels,
                 int columns) {
    if (panels.empty()) return;  // scenarios of another --data have other names
    scripts_.push_back(write_sources(paths_sheet(stem, title, panels, columns), out_ / "figures"));
  }

  SectionFiveOptions flags_;
  fs::path out_;
  ProgressLine line_;
  std::vector<std::string> metrics_;
  std::vector<PageRun> pages_;  ///< every run
  std::map<Method, std::vector<datasets::RecordingFile>> avoidance_;
  std::vector<datasets::RecordingFile> formation_;
  std::vector<fs::path> scripts_;
  std::array<std::pair<double, double>, kFormationScenarios> jitter_{};  ///< paper-signs, default; m/s^2
};

}  // namespace

std::string run_section_five(const SectionFiveOptions& options, const fs::path& out) {
  Experiments experiments(options, out);
  experiments.run_all();
  const std::string summary = experiments.summary();
  write_text(out / "summary.json", summary);
  if (!options.no_figures) {
    experiments.write_page();
    experiments.draw_figures();
  }
  return summary;
}

}  // namespace exactvo::tools
