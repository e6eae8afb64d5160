// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo paper: Section V of the paper from one command: every scenario, every method, a table and the figures.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "figures/paths_figure.h"
#include "support/data_folder.h"
#include "support/files.h"
#include "support/outcome.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/terminal.h"
#include "verb.h"

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

struct Flags {
  std::string out;
  std::string data;
  std::uint64_t seed = 0;
  bool json = false;
  bool no_figures = false;
};

/// The whole of Section V, as it goes.
class Experiments {
 public:
  Experiments(const Flags& flags, fs::path scenarios, const fs::path& out)
      : flags_(flags), scenarios_(std::move(scenarios)), out_(out), line_(kRuns, "runs") {}

  void run_all() {
    print(avoidance_head());
    for (int i = 0; i < kAvoidanceScenarios; ++i) run_avoidance("A" + std::to_string(i));
    print(formation_head());
    for (int i = 0; i < kFormationScenarios; ++i) run_formation("B" + std::to_string(i));
    line_.clear();
    print_footnotes();
  }

  std::string summary() const { return datasets::summary_json(metrics_); }

  /// All figures in one run of gnuplot.
  void draw_figures() {
    add_sheets();
    draw(scripts_);
  }

 private:
  void print(const std::string& text) {
    line_.clear();
    if (!flags_.json) tools::print(text);
  }

  static std::string avoidance_head() {
    std::string text = fmt::format("Section V.A: last arrival [s], X where a robot never arrives\n{:<5}", "");
    for (const Method m : kMethods) text += fmt::format("{:>13}", name(m));
    return text + "   least clearance of ivo [m]: obstacles, robots\n";
  }

  static std::string formation_head() {
    return fmt::format(
        "\nSection V.B: three robots and a virtual leader, method ivo\n"
        "{:<5}{:<15}{:>18}{:>23}{:>12}{:>12}{:>11}\n",
        "", "controller", "position error [m]", "velocity error [m/s]", "obstacles", "robots", "jitter");
  }

  void print_footnotes() {
    print(
        "\n!  touched an obstacle or another robot on the way. Errors are those at the end, clearances the least "
        "[m].\n");
  }

  FinishedRun run_one(const std::string& scenario_name, Method method, Controller controller) {
    const fs::path file = scenarios_ / (scenario_name + ".json");
    formation::SimulationOptions options;
    options.method = method;
    options.controller = controller;
    const auto provenance = datasets::make_provenance(command_line(), flags_.seed, {file});
    line_.show(static_cast<double>(metrics_.size()), scenario_name + " " + name(method));
    FinishedRun finished = run(datasets::load_scenario(file), options, provenance);
    metrics_.push_back(finished.metrics_json());
    finished.file.recording.outcome = outcome_words(finished);  // what a panel's title says
    return finished;
  }

  static std::string number_or_dash(const std::optional<double>& value, const char* format) {
    return value ? fmt::format(fmt::runtime(format), *value) : "-";
  }

  static std::string arrival_cell(const formation::Metrics& m) {
    const std::string text = m.all_arrived ? number_or_dash(m.last_arrival_time, "{:.1f}") : "X";
    return fmt::format("{:>12}{}", text, touched(m) ? '!' : ' ');
  }

  void run_avoidance(const std::string& scenario) {
    std::string row = fmt::format("{:<5}", scenario);
    std::string clearances;
    for (const Method method : kMethods) {
      FinishedRun finished = run_one(scenario, method, Controller::standard);
      row += arrival_cell(finished.metrics);
      clearances = fmt::format("   {}, {}", number_or_dash(finished.metrics.min_obstacle_clearance, "{:.3f}"),
                               number_or_dash(finished.metrics.min_robot_clearance, "{:.3f}"));
      keep_avoidance(std::move(finished), method);
    }
    print(row + clearances + "\n");
  }

  void run_formation(const std::string& scenario) {
    for (const Controller controller : kControllers) {
      FinishedRun finished = run_one(scenario, Method::ivo, controller);
      const formation::Metrics& m = finished.metrics;
      const bool diverged = finished.file.recording.diverged;
      print(fmt::format(
          "{:<5}{:<15}{:>18}{:>23}{:>12}{:>12}{:>11.0f}{} {}\n", scenario, name(controller),
          number_or_dash(m.formation_position_error, "{:.2g}"), number_or_dash(m.formation_velocity_error, "{:.2g}"),
          number_or_dash(m.min_obstacle_clearance, "{:.3f}"), number_or_dash(m.min_robot_clearance, "{:.3f}"), m.jitter,
          touched(m) ? '!' : ' ', diverged ? "diverged" : ""));
      keep_formation(std::move(finished), controller);
    }
  }

  /// Fig. 5 has the usual method, Fig. 6 the improved one.
  void keep_avoidance(FinishedRun finished, Method method) {
    if (flags_.no_figures) return;
    if (method == Method::orca) add_figures(finished, "fig5-orca");
    if (method == Method::ivo) add_figures(finished, "fig6-ivo");
    avoidance_[static_cast<std::size_t>(method)].push_back(std::move(finished.file));
  }

  void keep_formation(FinishedRun finished, Controller controller) {
    if (flags_.no_figures) return;
    if (controller == Controller::standard) add_figures(finished, "fig8-formation");
    formation_.push_back(std::move(finished.file));
  }

  void add_figures(const FinishedRun& finished, const std::string& folder) {
    const fs::path target = out_ / "figures" / folder / finished.file.info.scenario;
    const std::vector<fs::path> scripts = write_figures(finished, target);
    scripts_.insert(scripts_.end(), scripts.begin(), scripts.end());
  }

  static std::string panel_title(const datasets::RecordingFile& run) {
    const std::string& outcome = run.recording.outcome;
    // A panel is narrow, and all runs have the same limit.
    if (!run.scenario.formation)
      return run.info.scenario + ": " + outcome.substr(0, outcome.find(" within the time limit"));
    return run.info.scenario + ", " + *run.info.controller + (run.recording.diverged ? ": diverged" : "") +
           (outcome.rfind("COLLISION", 0) == 0 ? ", collision" : "");
  }

  void add_sheets() {
    for (const Method method : kMethods) {
      std::vector<Panel> panels;
      for (const auto& run : avoidance_[static_cast<std::size_t>(method)]) panels.push_back({panel_title(run), &run});
      add_sheet(std::string("all-") + name(method), std::string("Section V.A, method ") + name(method), panels, 4);
    }
    std::vector<Panel> panels;
    for (const auto& run : formation_) panels.push_back({panel_title(run), &run});
    add_sheet("all-formation", "Section V.B, method ivo: a column a controller", panels, 3);
    add_comparison();
  }

  void add_comparison() {
    std::vector<Panel> panels;
    for (const Method method : {Method::orca, Method::ivo}) {
      for (const auto& run : avoidance_[static_cast<std::size_t>(method)]) {
        if (run.info.scenario == kComparison) panels.push_back({std::string("method ") + name(method), &run});
      }
    }
    add_sheet("two-walls", "Two robots and two walls", panels, 2);
  }

  void add_sheet(const std::string& stem, const std::string& title, const std::vector<Panel>& panels, int columns) {
    scripts_.push_back(write_sources(paths_sheet(stem, title, panels, columns), out_ / "figures"));
  }

  const Flags& flags_;
  fs::path scenarios_;
  fs::path out_;
  ProgressLine line_;
  std::vector<std::string> metrics_;
  std::vector<datasets::RecordingFile> avoidance_[4];  ///< by method
  std::vector<datasets::RecordingFile> formation_;
  std::vector<fs::path> scripts_;
};

ExitCode paper(const Flags& flags) {
  check_output_folder(flags.out);
  StagedFolder folder(flags.out);
  Experiments experiments(flags, data_folder(flags.data, "paper"), folder.path());
  experiments.run_all();
  const std::string summary = experiments.summary();
  write_text(folder.path() / "summary.json", summary);
  if (!flags.no_figures) experiments.draw_figures();
  if (interrupted()) throw Interrupted();
  if (flags.json) tools::print(summary);
  folder.publish("summary.json");
  message("wrote " + flags.out + "/summary.json" + (flags.no_figures ? "" : " and " + flags.out + "/figures/"));
  return ExitCode::success;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  declare_out(app, flags->out, "Folder for summary.json and figures/; whole or not at all")->required();
  app.add_option("--data", flags->data, "Folder that holds paper/A1.json and so on; the program's own by default");
  declare_seed(app, flags->seed);
  app.add_flag("--json", flags->json, "Print summary.json instead of the tables");
  app.add_flag("--no-figures", flags->no_figures, "Leave the figures out");
  return [flags] { return paper(*flags); };
}

}  // namespace

Verb paper_verb() {
  return {"paper", "Run the paper's experiments (Section V) and draw its figures", "  exactvo paper --out out/paper\n",
          declare};
}

}  // namespace exactvo::tools
