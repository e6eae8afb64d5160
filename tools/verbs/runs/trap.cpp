// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo trap: for every robot and enclosure, and every two that overlap, whether a stall is possible and where.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/trap.h"
#include "support/json_layout.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "verb.h"

namespace exactvo::tools {

namespace {

using formation::Equilibrium;
using formation::TrapFinding;
using formation::TrapPlace;

struct TrapFlags {
  std::string scenario;
  SimulationFlags simulation;
  bool json = false;
};

OrderedJson json_of(const Equilibrium& e, double max_speed) {
  return {{"position", json_point(e.position)},
          {"radius_of_curvature", e.radius_of_curvature},
          {"distance", e.distance},
          {"stable", e.stable},
          {"reachable", e.reachable},
          {"rate", e.rate_at(max_speed)}};
}

OrderedJson json_of(const formation::Scenario& scenario, const TrapPlace& place) {
  OrderedJson ids = OrderedJson::array();
  for (const std::size_t k : place.enclosure.obstacles) ids.push_back(scenario.obstacles[k].id);
  return {{"enclosure", place.number},
          {"obstacles", ids},
          {"grade", name(place.enclosure.grade)},
          {"shape", geometry::to_string(place.enclosure.shape)}};
}

OrderedJson json_of(const formation::Scenario& scenario, const TrapFinding& f) {
  const formation::Robot& robot = scenario.robots[f.robot];
  OrderedJson json{{"robot", robot.id}, {"goal", json_point(f.goal)}};
  json.update(json_of(scenario, f.place));
  json["overlapping"] = f.overlapping ? json_of(scenario, *f.overlapping) : OrderedJson();
  json["stall_possible"] = f.stall_possible;
  json["margin"] = json_or_null(f.margin);
  json["start_clear"] = f.start_clear;
  json["goal_clear"] = f.goal_clear;
  json["slide_time"] = json_or_null(f.slide_time);
  json["equilibria"] = OrderedJson::array();
  for (const Equilibrium& e : f.equilibria) json["equilibria"].push_back(json_of(e, robot.max_speed));
  return json;
}

std::string curvature_words(double radius) {
  return std::isfinite(radius) ? fmt::format("radius of curvature {:.4g} m", radius) : "flat or concave";
}

std::string ends_of(const geometry::Segment& s) {
  return fmt::format("({:.4g}, {:.4g})-({:.4g}, {:.4g})", s.a.x, s.a.y, s.b.x, s.b.y);
}

/// Where the enclosure is, in the words in which a run's report names it.
std::string place_words(const formation::Scenario& scenario, const TrapPlace& place, bool is_edge) {
  const std::string of = " of " + names_of_obstacles(scenario, place.enclosure.obstacles);
  if (is_edge) return "edge " + ends_of(*place.facade) + of;
  const std::string number = fmt::format("enclosure {}", place.number);
  if (place.facade) return number + ", facade " + ends_of(*place.facade) + of;
  return number + of;
}

std::string subject_words(const formation::Scenario& scenario, const TrapFinding& f, bool is_edge) {
  if (!f.overlapping) return place_words(scenario, f.place, is_edge);
  const std::string first = names_of_obstacles(scenario, f.place.enclosure.obstacles);
  const std::string second = names_of_obstacles(scenario, f.overlapping->enclosure.obstacles);
  if (first == second)
    return fmt::format("between enclosures {} and {} of {}", f.place.number, f.overlapping->number, first);
  return fmt::format("between enclosure {} of {} and enclosure {} of {}", f.place.number, first, f.overlapping->number,
                     second);
}

std::string rest_words(const TrapFinding& f, const Equilibrium& e) {
  const std::string at = fmt::format("at ({:.4g}, {:.4g})", e.position.x, e.position.y);
  const std::string reach = e.reachable ? "" : "; obstacles shut the robot off from there";
  if (f.overlapping)
    return fmt::format("rests {} in their concave vertex, goal {:.4g} m away{}", at, e.distance, reach);
  return fmt::format("{} {}: {}, goal {:.4g} m away{}", e.stable ? "rests" : "unstable equilibrium, no stall,", at,
                     curvature_words(e.radius_of_curvature), e.distance, reach);
}

/// A stall may be one for robots in other places alone; where the goal is in the enclosure, it is not about rests.
std::string verdict_words(const TrapFinding& f) {
  if (!f.stall_possible) return "no stall";
  const auto rests_here = [](const Equilibrium& e) { return e.stable && e.reachable; };
  const bool has_rests = std::any_of(f.equilibria.begin(), f.equilibria.end(), [](const auto& e) { return e.stable; });
  const bool is_shut_off =
      f.goal_clear && has_rests && std::none_of(f.equilibria.begin(), f.equilibria.end(), rests_here);
  return is_shut_off ? "a stall is possible, but not for a robot that starts here" : "a stall is possible";
}

std::string words_of(const formation::Scenario& scenario, const TrapFinding& f, bool is_edge) {
  const std::string grade = f.overlapping ? "overlapping, heuristic" : name(f.place.enclosure.grade);
  std::string text = fmt::format("{}, {}: {} ({})", scenario.robots[f.robot].id, subject_words(scenario, f, is_edge),
                                 verdict_words(f), grade);
  if (f.margin && std::isfinite(*f.margin)) text += fmt::format(", relative margin {:.3g}", *f.margin);
  if (!f.start_clear) text += "; the start is not clear of it";
  if (!f.start_clear && !f.overlapping && f.place.enclosure.grade != geometry::EnclosureGrade::tight)
    text += " (while the robot is inside, its pieces stand for it; they are not judged)";
  if (!f.goal_clear) text += "; the goal is not clear of it";
  if (f.slide_time) text += fmt::format("; slides along it for {:.3g} s", *f.slide_time);
  for (const Equilibrium& e : f.equilibria) text += "\n    " + rest_words(f, e);
  return text + "\n";
}

std::vector<TrapFinding> tested(const formation::Scenario& scenario, const formation::SimulationOptions& options) {
  const TerminateOnSignal terminate_on_signal;
  return formation::trap_test(scenario, options);
}

ExitCode trap(const TrapFlags& flags) {
  const formation::Scenario scenario = read_scenario(flags.scenario).scenario;
  formation::SimulationOptions options = simulation_options(flags.simulation);
  if (options.guidance.value_or(formation::Guidance::none) != formation::Guidance::none)
    message("note: --guidance has no effect: routes lead round traps, which are judged without them");
  options.guidance = formation::Guidance::none;
  const std::vector<TrapFinding> findings = tested(scenario, options);
  std::string text;
  if (flags.json) {
    OrderedJson list = OrderedJson::array();
    for (const TrapFinding& f : findings) list.push_back(json_of(scenario, f));
    text = laid_out(list);
  } else {
    const bool edges = takes_edges(options.method);
    for (const TrapFinding& f : findings) text += words_of(scenario, f, edges);
    if (findings.empty()) text = "no obstacles: nothing to stall at\n";
  }
  print(text);
  return ExitCode::success;
}

void declare_trap(CLI::App& app, TrapFlags& flags) {
  app.add_option("scenario", flags.scenario, "JSON file, or - for stdin")->required();
  declare_simulation_flags(app, flags.simulation);
  app.add_flag("--json", flags.json, "Print the findings as JSON; infinite and inapplicable values are null");
}

}  // namespace

Verb trap_verb() {
  return {"trap", "Find where a robot may stall, before any run",
          "  exactvo trap datasets/data/paper/A4.json\n"
          "  exactvo trap datasets/data/paper/A11.json --method ivo-edge --json\n",
          with_flags(declare_trap, trap)};
}

}  // namespace exactvo::tools
