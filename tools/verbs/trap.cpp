// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo trap: for every robot and enclosure, whether a stall is possible and where, before anything moves.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "exactvo/formation/trap.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "verb.h"

namespace exactvo::tools {

namespace {

using formation::Equilibrium;
using formation::TrapFinding;

struct Flags {
  std::string scenario;
  SimulationFlags simulation;
  bool json = false;
};

/// JSON has no word for infinity: null, as for what does not apply.
std::string number(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : "null";
}
std::string number(const std::optional<double>& x) {
  return x ? number(*x) : "null";
}
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string json_of(const Equilibrium& e, double max_speed) {
  return fmt::format(
      "{{ \"position\": [{}, {}], \"radius_of_curvature\": {}, \"distance\": {}, \"stable\": {}, \"rate\": {} }}",
      e.position.x, e.position.y, number(e.radius_of_curvature), number(e.distance), e.stable,
      number(e.rate_at(max_speed)));
}

std::string list_of_obstacles(const formation::Scenario& scenario, const TrapFinding& f, const char* between) {
  std::string text;
  for (std::size_t k : f.enclosure.obstacles) text += (text.empty() ? "" : between) + quoted(scenario.obstacles[k].id);
  return text;
}

std::string json_of(const formation::Scenario& scenario, const TrapFinding& f) {
  const formation::Robot& robot = scenario.robots[f.robot];
  std::string equilibria;
  for (const Equilibrium& e : f.equilibria)
    equilibria += (equilibria.empty() ? "" : ", ") + json_of(e, robot.max_speed);
  return fmt::format(
      "  {{ \"robot\": {}, \"goal\": [{}, {}], \"obstacles\": [{}], \"grade\": \"{}\", \"shape\": {},\n"
      "    \"stall_possible\": {}, \"margin\": {}, \"start_clear\": {}, \"goal_clear\": {}, \"slide_time\": {},\n"
      "    \"equilibria\": [{}] }}",
      quoted(robot.id), f.goal.x, f.goal.y, list_of_obstacles(scenario, f, ", "), name(f.enclosure.grade),
      quoted(geometry::to_string(f.enclosure.shape)), f.stall_possible, number(f.margin), f.start_clear, f.goal_clear,
      number(f.slide_time), equilibria);
}

std::string json_of(const formation::Scenario& scenario, const std::vector<TrapFinding>& findings) {
  std::string text = "[";
  for (std::size_t k = 0; k < findings.size(); ++k) text += (k ? ",\n" : "\n") + json_of(scenario, findings[k]);
  return text + (findings.empty() ? "]\n" : "\n]\n");
}

std::string curvature_words(double radius) {
  return std::isfinite(radius) ? fmt::format("radius of curvature {:.4g} m", radius) : "flat or hollow";
}

/// The edges of an obstacle have one name: theirs is told.
std::string place_words(const TrapFinding& f) {
  const auto* edge = std::get_if<geometry::Segment>(&f.enclosure.shape);
  if (!edge) return "";
  return fmt::format(", edge ({:.4g}, {:.4g})-({:.4g}, {:.4g})", edge->a.x, edge->a.y, edge->b.x, edge->b.y);
}

std::string words_of(const formation::Scenario& scenario, const TrapFinding& f) {
  std::string text =
      fmt::format("{} round {}{}: {} ({})", scenario.robots[f.robot].id, list_of_obstacles(scenario, f, " and "),
                  place_words(f), f.stall_possible ? "a stall is possible" : "no stall", name(f.enclosure.grade));
  if (f.margin && std::isfinite(*f.margin)) text += fmt::format(", margin {:.3g}", *f.margin);
  if (!f.start_clear) text += "; the start is not clear of it";
  if (!f.goal_clear) text += "; the goal is not clear of it";
  if (f.slide_time) text += fmt::format("; slides {:.3g} s", *f.slide_time);
  for (const Equilibrium& e : f.equilibria)
    text += fmt::format("\n    {} at ({:.4g}, {:.4g}): {}, goal {:.4g} m away", e.stable ? "rests" : "may balance",
                        e.position.x, e.position.y, curvature_words(e.radius_of_curvature), e.distance);
  return text + "\n";
}

ExitCode trap(const Flags& flags) {
  const formation::Scenario scenario = read_scenario(flags.scenario);
  const std::vector<TrapFinding> findings = formation::trap_test(scenario, simulation_options(flags.simulation));
  std::string text;
  if (flags.json) {
    text = json_of(scenario, findings);
  } else {
    for (const TrapFinding& f : findings) text += words_of(scenario, f);
    if (findings.empty()) text = "no obstacles: nothing to stall at\n";
  }
  std::fwrite(text.data(), 1, text.size(), stdout);
  return ExitCode::success;
}

Action declare(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("scenario", flags->scenario, "JSON file, or - for stdin")->required();
  declare_simulation_flags(app, flags->simulation);
  app.add_flag("--json", flags->json, "Print the findings as JSON; infinity and what does not apply are null");
  return [flags] { return trap(*flags); };
}

}  // namespace

Verb trap_verb() {
  return {"trap", "Say where a robot may stall, before it moves",
          "  exactvo trap datasets/data/paper/A4.json\n"
          "  exactvo trap datasets/data/paper/A11.json --method ivo-edge --json\n",
          declare};
}

}  // namespace exactvo::tools
