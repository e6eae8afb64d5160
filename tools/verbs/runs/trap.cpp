// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo trap: for every robot and enclosure, and every two that overlap, whether a stall is possible and where.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/trap.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/unsigned_zero.h"
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

/// JSON has no word for infinity: null, as for what does not apply.
std::string number(double x) {
  return std::isfinite(x) ? fmt::format("{}", unsigned_zero(x)) : "null";
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
      number(e.position.x), number(e.position.y), number(e.radius_of_curvature), number(e.distance), e.stable,
      number(e.rate_at(max_speed)));
}

std::string ids_of(const formation::Scenario& scenario, const TrapPlace& place, const char* between) {
  std::string text;
  for (std::size_t k : place.enclosure.obstacles)
    text += (text.empty() ? "" : between) + quoted(scenario.obstacles[k].id);
  return text;
}

std::string json_of(const formation::Scenario& scenario, const TrapPlace& place) {
  return fmt::format("\"enclosure\": {}, \"obstacles\": [{}], \"grade\": \"{}\", \"shape\": {}", place.number,
                     ids_of(scenario, place, ", "), name(place.enclosure.grade),
                     quoted(geometry::to_string(place.enclosure.shape)));
}

std::string json_of(const formation::Scenario& scenario, const TrapFinding& f) {
  const formation::Robot& robot = scenario.robots[f.robot];
  std::string equilibria;
  for (const Equilibrium& e : f.equilibria)
    equilibria += (equilibria.empty() ? "" : ", ") + json_of(e, robot.max_speed);
  const std::string other = f.overlapping ? "{ " + json_of(scenario, *f.overlapping) + " }" : "null";
  return fmt::format(
      "  {{ \"robot\": {}, \"goal\": [{}, {}], {},\n"
      "    \"overlapping\": {},\n"
      "    \"stall_possible\": {}, \"margin\": {}, \"start_clear\": {}, \"goal_clear\": {}, \"slide_time\": {},\n"
      "    \"equilibria\": [{}] }}",
      quoted(robot.id), f.goal.x, f.goal.y, json_of(scenario, f.place), other, f.stall_possible, number(f.margin),
      f.start_clear, f.goal_clear, number(f.slide_time), equilibria);
}

std::string json_of(const formation::Scenario& scenario, const std::vector<TrapFinding>& findings) {
  std::string text = "[";
  for (std::size_t k = 0; k < findings.size(); ++k) text += (k ? ",\n" : "\n") + json_of(scenario, findings[k]);
  return text + (findings.empty() ? "]\n" : "\n]\n");
}

std::string curvature_words(double radius) {
  return std::isfinite(radius) ? fmt::format("radius of curvature {:.4g} m", radius) : "flat or concave";
}

std::string ends_of(const geometry::Segment& s) {
  return fmt::format("({:.4g}, {:.4g})-({:.4g}, {:.4g})", s.a.x, s.a.y, s.b.x, s.b.y);
}

std::string owners_of(const formation::Scenario& scenario, const TrapPlace& place) {
  std::vector<std::string> ids;
  for (std::size_t k : place.enclosure.obstacles) ids.push_back(scenario.obstacles[k].id);
  return (ids.size() > 1 ? "obstacles " : "obstacle ") + formation::abridged(ids);
}

/// Where the enclosure is, in the words in which a run's report names it.
std::string place_words(const formation::Scenario& scenario, const TrapPlace& place, bool orca) {
  const std::string of = " of " + owners_of(scenario, place);
  if (orca) return "edge " + ends_of(*place.facade) + of;
  const std::string number = fmt::format("enclosure {}", place.number);
  if (place.facade) return number + ", facade " + ends_of(*place.facade) + of;
  return number + of;
}

std::string subject_words(const formation::Scenario& scenario, const TrapFinding& f, bool orca) {
  if (!f.overlapping) return place_words(scenario, f.place, orca);
  const std::string first = owners_of(scenario, f.place), second = owners_of(scenario, *f.overlapping);
  if (first == second)
    return fmt::format("between enclosures {} and {} of {}", f.place.number, f.overlapping->number, first);
  return fmt::format("between enclosure {} of {} and enclosure {} of {}", f.place.number, first, f.overlapping->number,
                     second);
}

std::string rest_words(const TrapFinding& f, const Equilibrium& e) {
  const std::string at = fmt::format("at ({:.4g}, {:.4g})", e.position.x, e.position.y);
  if (f.overlapping) return fmt::format("rests {} in their concave vertex, goal {:.4g} m away", at, e.distance);
  return fmt::format("{} {}: {}, goal {:.4g} m away", e.stable ? "rests" : "unstable equilibrium, no stall,", at,
                     curvature_words(e.radius_of_curvature), e.distance);
}

std::string words_of(const formation::Scenario& scenario, const TrapFinding& f, bool orca) {
  const std::string grade = f.overlapping ? "overlapping, heuristic" : name(f.place.enclosure.grade);
  std::string text = fmt::format("{}, {}: {} ({})", scenario.robots[f.robot].id, subject_words(scenario, f, orca),
                                 f.stall_possible ? "a stall is possible" : "no stall", grade);
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
    text = json_of(scenario, findings);
  } else {
    const bool orca = flags.simulation.method == formation::name(formation::Method::orca);
    for (const TrapFinding& f : findings) text += words_of(scenario, f, orca);
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
