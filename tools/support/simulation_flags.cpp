// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/simulation_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <optional>

#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/stability.h"
#include "support/escape.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace {

std::string help(const char* what, const std::vector<std::string>& names) {
  return fmt::format("{}: {}", what, fmt::join(names, ", "));
}

std::vector<std::string> switch_names() {
  std::vector<std::string> names;
  for (const formation::ControllerSwitch& s : formation::controller_switches()) names.emplace_back(s.name);
  return names;
}

constexpr const char* kBound = "acceleration_bound";

double bound_of(const std::string& option, const std::string& text) {
  std::size_t read = 0;
  double bound = -1.0;
  try {
    bound = std::stod(text, &read);
  } catch (const std::exception&) {
    read = 0;
  }
  if (read == 0 || read != text.size() || !(bound >= 0.0) || !std::isfinite(bound))
    throw UsageError("--controller-option", option, "a number of m/s^2, at least 0");
  return bound;
}

/// "smoothing=on", "horizon_clamp=off", "acceleration_bound=8".
void apply_switch(const std::string& option, formation::ControllerOptions& options) {
  const std::size_t equals = std::min(option.find('='), option.size());
  const std::string name = option.substr(0, equals), value = option.substr(std::min(equals + 1, option.size()));
  if (name == kBound) {
    options.acceleration_bound = bound_of(option, value);
    return;
  }
  for (const formation::ControllerSwitch& s : formation::controller_switches()) {
    if (name != s.name) continue;
    if (value != "on" && value != "off")
      throw UsageError("--controller-option", option, name + "=on or " + name + "=off");
    options.*s.on = value == "on";
    return;
  }
  throw UsageError("--controller-option", option,
                   fmt::format("one of {}{}", fmt::join(switch_names(), " "), suggestion(name, switch_names())));
}

/// Nothing where the command line does not speak of them: then the scenario does.
std::optional<formation::ControllerOptions> controller_options_of(const SimulationFlags& flags,
                                                                  formation::Controller controller) {
  if (flags.ablation.empty() && flags.switches.empty()) return std::nullopt;
  formation::ControllerOptions options = formation::controller_options_of(controller);
  if (!flags.ablation.empty()) {
    const auto named = formation::controller_options_named(flags.ablation);
    const std::vector<std::string> names = formation::controller_option_set_names();
    if (!named)
      throw UsageError("--ablation", flags.ablation,
                       fmt::format("one of {}{}", fmt::join(names, ", "), suggestion(flags.ablation, names)));
    options = *named;
  }
  for (const std::string& option : flags.switches) apply_switch(option, options);
  return options;
}

/// Throws where the scenario, or the command line, cannot do without decisions.
void require_crowd(const std::string& file, const formation::Scenario& scenario, const std::string& needed,
                   const std::string& asked_by) {
  if (!needed.empty())
    throw conflict(needed, asked_by, "without recorded decisions the method is orca, and a recording has places alone");
  for (const formation::ScenarioProblem& p : crowd_problems(scenario))
    throw datasets::DataError(datasets::DataCode::scenario, file, p.pointer, p.found,
                              p.expected + ", with " + asked_by);
}

}  // namespace

void declare_simulation_flags(CLI::App& app, SimulationFlags& flags) {
  CLI::Option* method =
      app.add_option("--method,-m", flags.method,
                     help("Avoidance method (with --decisions none always orca)", formation::method_names()))
          ->capture_default_str();
  flags.method_option = method;
  flags.of_goals = {
      app.add_option("--guidance,-g", flags.guidance,
                     help("Guidance of robots with goals, overriding the scenario", formation::guidance_names()))};
  app.add_option("--liveness", flags.liveness,
                 help("Prevention of deadlocks, overriding the scenario (in formations plan or off)",
                      formation::liveness_names()));
  flags.of_formations = {
      app.add_option("--controller,-c", flags.controller, help("Formation controller", formation::controller_names()))
          ->capture_default_str(),
      app.add_option("--integrator", flags.integrator, help("Formation integrator", formation::integrator_names()))
          ->capture_default_str(),
      app.add_option("--ablation", flags.ablation,
                     help("Instead of the controller, a named set of controller options",
                          formation::controller_option_set_names())),
      app.add_option("--controller-option", flags.switches,
                     fmt::format("Switch a controller option: NAME=on or NAME=off, repeatable: {}; "
                                 "acceleration_bound=8 (m/s^2)",
                                 fmt::join(switch_names(), ", ")))};
  flags.of_runs = flags.of_formations;
  flags.of_runs.insert(flags.of_runs.end(), flags.of_goals.begin(), flags.of_goals.end());
  flags.of_runs.insert(flags.of_runs.end(), {method, declare_seed(app, flags.seed)});
}

CLI::Option* declare_seed(CLI::App& app, std::uint64_t& seed, const std::string& help) {
  // The parser would let -1 and 2^64 pass as 2^64 - 1.
  const auto fits = [](const std::string& text) {
    errno = 0;
    std::strtoull(text.c_str(), nullptr, 0);
    const bool is_seed = text.rfind('-', 0) != 0 && errno != ERANGE;
    return is_seed ? std::string() : "found '" + text + "', expected a whole number from 0 to 18446744073709551615";
  };
  return app.add_option("--seed", seed, help)->capture_default_str()->check(CLI::Validator(fits, "", ""));
}

CLI::Option* declare_out(CLI::App& app, std::string& out, const std::string& help) {
  const auto is_name = [](const std::string& text) {
    if (text.empty()) return std::string("found '', expected a name");
    return has_control_characters(text) ? "found '" + shown(text) + "', expected a name without control characters"
                                        : std::string();
  };
  return app.add_option("--out,-o", out, help)->check(CLI::Validator(is_name, "", ""));
}

namespace {

void note(const std::vector<const CLI::Option*>& options, const std::string& why) {
  for (const CLI::Option* option : options)
    if (option->count() > 0) message("note: --" + option->get_lnames().front() + " has no effect: " + why);
}

}  // namespace

void note_unused(const SimulationFlags& flags, const formation::Scenario& scenario) {
  for (const formation::ScenarioProblem& p : option_problems(scenario, simulation_options(flags)))
    throw UsageError("--" + p.pointer, p.found, p.expected);
  for (const std::string& option : flags.switches)
    if (scenario.formation && !tracks_choices(scenario) && option == "brake_point=on")
      throw UsageError("--controller-option", option + ", with robots on wheels",
                       "brake_point=off, or none: they drive at what they choose and have no brake point ahead");
  scenario.formation ? note(flags.of_goals, "robots of a formation have no goals")
                     : note(flags.of_formations, "the scenario has no formation");
  if (scenario.formation && flags.liveness == "bias")
    message("note: --liveness bias is off in formations, whose robots do not turn to the right");
}

void note_liveness(const SimulationFlags& flags, const formation::Scenario& scenario,
                   const formation::SimulationOptions& options) {
  if (options.liveness.value_or(scenario.liveness) != formation::Liveness::plan) return;
  const formation::Liveness used = liveness_of(scenario, options);
  const bool is_asked_for = !flags.liveness.empty();
  if (scenario.formation && is_asked_for && used != formation::Liveness::plan)
    message(
        "note: --liveness plan is off here: joint plans of a formation need method ivo or ivo-cluster, no moving "
        "obstacles, no robots on wheels, and a controller whose brake points follow the choices");
  // ivo-edge never has guidance: there it is reported only where plans are asked for.
  const bool may_have_guidance = options.method != formation::Method::ivo_edge;
  if (!scenario.formation && used == formation::Liveness::bias && (is_asked_for || may_have_guidance))
    message(std::string("note: liveness is bias, not plan: ") +
            (braking_time_of(scenario) > 0.0 || scenario.separate ? "joint plans rely on robots that can stand at once"
                                                                  : "among obstacles joint plans need guidance") +
            ", so that robots only turn to the right for each other");
}

void note_recorded(const SimulationFlags& flags) {
  note(flags.of_runs, "the run is read from its recording");
}

formation::SimulationOptions simulation_options(const SimulationFlags& flags) {
  formation::SimulationOptions options;
  options.method = parse_choice<formation::Method>("--method", flags.method, formation::method_names());
  if (!flags.guidance.empty())
    options.guidance = parse_choice<formation::Guidance>("--guidance", flags.guidance, formation::guidance_names());
  if (!flags.liveness.empty())
    options.liveness = parse_choice<formation::Liveness>("--liveness", flags.liveness, formation::liveness_names());
  if (options.guidance == formation::Guidance::route && options.method == formation::Method::ivo_edge)
    throw UsageError("--guidance", "route with ivo-edge, whose ellipses would close what a route passes",
                     "another method: orca, ivo-cluster or ivo");
  if (options.liveness && !formation::promises_between_robots(options.method))
    throw UsageError("--liveness", flags.liveness + " with " + flags.method + ", which promises nothing between robots",
                     "another method: orca, ivo-edge, ivo-cluster or ivo");
  options.controller =
      parse_choice<formation::Controller>("--controller", flags.controller, formation::controller_names());
  options.integrator =
      parse_choice<formation::Integrator>("--integrator", flags.integrator, formation::integrator_names());
  options.controller_options = controller_options_of(flags, options.controller);
  return options;
}

void declare_decisions(CLI::App& app, DecisionFlags& flags) {
  app.add_option("--decisions", flags.recorded,
                 fmt::format("What is recorded of each decision: binding (the half-planes that bind, and those of what "
                             "could be reached within a time step), all half-planes, or none: places alone, for any "
                             "number of robots with goals, method orca, every motion certified. By default binding, "
                             "and none from {} robots on where nothing needs more",
                             kManyRobots));
}

Way way_of(const DecisionFlags& flags, const SimulationFlags& simulation, const std::string& file,
           const formation::Scenario& scenario, const std::string& needed, bool has_ranks) {
  if (!flags.recorded.empty()) require_known("--decisions", flags.recorded, {"none", "binding", "all"});
  const bool is_other_method = simulation.method_option->count() > 0 && simulation.method != "orca";
  const std::string need = needed.empty() && is_other_method ? "--method " + simulation.method : needed;
  Way way;
  way.records_all = flags.recorded == "all";
  if (flags.recorded == "none" || has_ranks) {
    if (flags.recorded != "none" && !flags.recorded.empty())
      throw UsageError("--decisions", flags.recorded, "none: runs over ranks of MPI record no decisions");
    require_crowd(file, scenario, need, flags.recorded == "none" ? "--decisions none" : "ranks of MPI");
    way.is_crowd = true;
    return way;
  }
  const std::size_t robots = scenario.robots.size();
  if (!flags.recorded.empty() || robots < kManyRobots) return way;
  const std::vector<formation::ScenarioProblem> problems = crowd_problems(scenario);
  way.is_crowd = need.empty() && problems.empty();
  if (way.is_crowd)
    way.words = fmt::format(
        "{} robots: places are recorded, not decisions, and the method is orca; --decisions "
        "binding records decisions, has the other methods and joint plans, and takes far longer",
        robots);
  else if (need.empty())
    way.words = fmt::format("{} robots, and decisions are recorded, since {} is {}: that may take long", robots,
                            problems.front().pointer, problems.front().found);
  else
    way.words = fmt::format(
        "{} robots, and decisions are recorded, since {} asks for it: that may take long; "
        "--decisions none records places alone",
        robots, need);
  return way;
}

}  // namespace exactvo::tools
