// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo explain: one robot's velocity space at one moment, drawn and in words.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "exactvo/datasets/input_files.h"
#include "exactvo/formation/stuck.h"
#include "explain/explanation.h"
#include "figures/velocity_space.h"
#include "support/escape.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/figure_file.h"

namespace exactvo::tools {

using formation::Scenario;

namespace {

struct Flags {
  std::string scenario;
  SimulationFlags simulation;
  double time = 0.0;
  std::string robot;
  std::string out;
};

std::vector<std::string> robot_ids(const Scenario& scenario) {
  std::vector<std::string> ids;
  for (const auto& robot : scenario.robots) ids.push_back(robot.id);
  return ids;
}

/// By id, or by number counted from 0 where no robot has that id.
std::size_t find_robot(const Scenario& scenario, const std::string& text) {
  const std::vector<std::string> ids = robot_ids(scenario);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == text || (std::to_string(i) == text && std::find(ids.begin(), ids.end(), text) == ids.end())) return i;
  }
  throw UsageError(
      "--robot", text,
      fmt::format("a number from 0 to {} or one of {}{}", ids.size() - 1, fmt::join(ids, " "), suggestion(text, ids)));
}

/// The last row in which a decision was taken: the final row of a recording has none.
const formation::Step& last_decision(const formation::Recording& recording, double time) {
  if (recording.steps.size() < 2)
    throw UsageError("--time", fmt::format("{}", time), "a time before the end of the run");
  const formation::Step& step = recording.steps[recording.steps.size() - 2];
  const double end = recording.steps.back().time;
  if (time > end + 0.5 * recording.time_step) {
    throw UsageError("--time", fmt::format("{}", time), fmt::format("at most {:.6g} s, when the run ends", end));
  }
  return step;
}

std::string method_words(const Scenario& scenario, const SimulationFlags& flags) {
  return "method " + flags.method + (scenario.formation ? ", controller " + flags.controller : "");
}

struct Explained {
  Decision decision;
  std::vector<std::string> remarks;  ///< of the run so far
};

/// Warnings of the run, and, of a robot that hardly moves, what it rests on.
std::vector<std::string> remarks_on(const Scenario& scenario, const formation::Recording& recording,
                                    std::size_t robot) {
  constexpr double kAtRest = 0.01;  // of its greatest speed
  std::vector<std::string> remarks;
  for (const std::string& warning : recording.warnings) remarks.push_back("Warning: " + warning + ".");
  for (const formation::StuckReport& report : formation::explain_stuck(scenario, recording))
    if (report.robot == robot && report.speed < kAtRest * scenario.robots[robot].max_speed)
      remarks.push_back("Stuck: " + report.text + ".");
  return remarks;
}

Explained decide(const Flags& flags, const Scenario& scenario) {
  formation::SimulationOptions options = simulation_options(flags.simulation);
  options.stop_at = flags.time;
  options.progress = [](double) { return !interrupted(); };
  const std::size_t robot = find_robot(scenario, flags.robot);
  const EndsAtOnce nothing_is_written;
  const formation::Recording recording = formation::simulate(scenario, options);
  if (interrupted()) throw Interrupted();
  const formation::Step& step = last_decision(recording, flags.time);
  return {{scenario, method_words(scenario, flags.simulation), robot, step.time, step.robots.at(robot)},
          remarks_on(scenario, recording, robot)};
}

void check(const Flags& flags) {
  if (!(flags.time >= 0.0)) throw UsageError("--time", fmt::format("{}", flags.time), "a time of at least 0 s");
  check_figure_name("--out", flags.out, datasets::files_read_with(flags.scenario, "scenario"));
}

ExitCode explain(const Flags& flags) {
  check(flags);
  const Scenario scenario = read_scenario(flags.scenario).scenario;
  note_unused(flags.simulation, scenario);
  const Explained explained = decide(flags, scenario);
  print(shown_lines(explanation(explained.decision)));
  for (const std::string& remark : explained.remarks) print(shown(remark) + "\n");
  if (!flags.out.empty()) write_figure(velocity_space_figure(explained.decision), flags.out);
  return ExitCode::success;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("scenario", flags->scenario, "JSON file, or - for stdin")->required();
  app.add_option("--time,-t", flags->time, "Time of the decision, s")->required();
  app.add_option("--robot,-r", flags->robot, "The robot: its id, or its index from 0")->required();
  declare_out(app, flags->out, kFigureFileHelp);
  declare_simulation_flags(app, flags->simulation);
  return [flags] { return explain(*flags); };
}

}  // namespace

Verb explain_verb() {
  return {"explain", "Draw one robot's velocity space at one moment and explain which constraints are binding",
          "  exactvo explain datasets/data/paper/A1.json --method orca --time 10 --robot R1 --out out/stuck.svg\n",
          declare};
}

}  // namespace exactvo::tools
