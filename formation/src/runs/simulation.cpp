// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/simulation.h"

#include <chrono>
#include <utility>

#include "control/consensus.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/stability.h"
#include "exactvo/geometry/require.h"

#include "preflight/preflight.h"
#include "reach/reachability.h"
#include "runs/runs.h"
#include "scene/field_problems.h"
#include "scene/number_text.h"
#include "steering/guide.h"

namespace exactvo::formation {
namespace {

using namespace detail;
using Clock = std::chrono::steady_clock;

std::vector<std::string> warnings_with(const Scenario& scenario, const SimulationOptions& options,
                                       Reachability& reach) {
  std::vector<std::string> warnings;
  const bool tracks = tracks_choices(scenario);
  if (scenario.formation)
    warnings = step_warnings(*scenario.formation, tracks ? std::optional(options.integrator) : std::nullopt,
                             scenario.time_step);
  if (tracks)
    for (std::string& warning : controller_warnings(scenario, controller_options_in_use(scenario, options)))
      warnings.push_back(std::move(warning));
  for (std::string& warning : preflight_warnings(scenario, offsets_in_use(scenario, options), reach))
    warnings.push_back(std::move(warning));
  if (!promises_between_robots(options.method))
    warnings.push_back(std::string("method ") + name(options.method) +
                       " promises nothing between robots: they may overlap, and the metrics count it");
  return warnings;
}

/// All rows: the recording has the rest.
struct RowsKept : RunSink {
  void add_row(Step row) override { rows.push_back(std::move(row)); }

  std::vector<Step> rows;
};

/// Whether the brake points of a formation move at exactly what the filter chooses, as plans need it.
bool follows_choices(const ControllerOptions& options) {
  return options.brake_point && options.absolute_frame && options.filter_last && options.horizon_clamp &&
         options.margins && !(options.acceleration_bound > 0.0);
}

}  // namespace

Guidance guidance_of(const Scenario& scenario, const SimulationOptions& options) {
  if (scenario.formation || options.method == Method::ivo_edge) return Guidance::none;
  return options.guidance.value_or(scenario.guidance);
}

Liveness liveness_of(const Scenario& scenario, const SimulationOptions& options) {
  if (!promises_between_robots(options.method)) return Liveness::off;
  const Liveness wanted = options.liveness.value_or(scenario.liveness);
  if (scenario.formation) {
    const bool has_margins = options.method == Method::ivo || options.method == Method::ivo_cluster;
    const bool can_plan = has_margins && scenario.moving_obstacles.empty() &&
                          follows_choices(controller_options_in_use(scenario, options));
    return wanted == Liveness::plan && can_plan ? Liveness::plan : Liveness::off;
  }
  const bool is_guided = guidance_of(scenario, options) != Guidance::none || scenario.obstacles.empty();
  const bool is_without =
      options.steering || options.half_planes || scenario.separate || braking_time_of(scenario) > 0.0;
  return wanted == Liveness::plan && (!is_guided || is_without) ? Liveness::bias : wanted;
}

std::vector<ScenarioProblem> option_problems(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<ScenarioProblem> problems;
  const bool brakes = braking_time_of(scenario) > 0.0;
  const std::string braking = scenario.acceleration ? "with an acceleration" : "with robots on wheels";
  if (!promises_between_robots(options.method) && (scenario.formation || brakes || scenario.separate))
    problems.push_back({"method",
                        name(options.method) + (scenario.formation ? ", which formations do not have"
                                                : brakes ? ", which cannot promise to brake in time, " + braking
                                                         : ", which promises nothing between robots that part"),
                        "another method: orca, ivo-edge, ivo-cluster or ivo"});
  if (scenario.formation && !tracks_choices(scenario)) {
    if (const std::string option = unfit_for_wheels(controller_options_in_use(scenario, options)); !option.empty())
      problems.push_back({"controller",
                          option + (option == "acceleration_bound" ? "" : " off") + ", with robots on wheels",
                          "a controller whose robots drive at what they choose: default, or another one with "
                          "absolute_frame, filter_last and horizon_clamp and without an acceleration_bound"});
    if (options.integrator != Integrator::exact)
      problems.push_back({"integrator", name(options.integrator) + std::string(", with robots on wheels"),
                          "exact: their reference points drive at what they choose"});
  }
  if (options.threads < 0 || options.threads > 1024)
    problems.push_back({"threads", std::to_string(options.threads), "0 to 1024"});
  if (scenario.formation && options.steering)
    problems.push_back({"steering", "a function, in a formation", "none: its controller says where robots go"});
  if (scenario.formation && options.half_planes)
    problems.push_back({"half_planes", "a function, in a formation", "none: its controller has its own laws"});
  else if (brakes && options.half_planes)
    problems.push_back(
        {"half_planes", "a function, " + braking,
         "none, since braking might not satisfy them: use steering, or a scenario whose velocities jump"});
  return problems;
}

std::string recentring_notice(const Scenario& scenario, const SimulationOptions& options) {
  if (!scenario.formation || scenario.formation->offsets.empty()) return "";
  const Vec2 moved = offsets_in_use(scenario, options).front() - scenario.formation->offsets.front();
  if (!(geometry::norm(moved) > scenario.arrival_tolerance)) return "";
  return "formation: recentre moves every slot by (" + number_text(moved.x, 4) + ", " + number_text(moved.y, 4) +
         "), so that their mean is 0; \"recentre\": false keeps them as they are";
}

std::vector<std::string> warnings_before(const Scenario& scenario, const SimulationOptions& options) {
  Reachability reach(terrain_of(scenario), 0.0, false);
  return warnings_with(scenario, options, reach);
}

Recording simulate(const Scenario& scenario, const SimulationOptions& options) {
  RowsKept rows;
  Recording recording = simulate(scenario, options, rows);
  recording.steps = std::move(rows.rows);
  return recording;
}

Recording simulate(const Scenario& scenario, const SimulationOptions& options, RunSink& sink) {
  const std::vector<ScenarioProblem> problems = validate(scenario);
  EXACTVO_REQUIRE(problems.empty(),
                  problems.front().pointer + ": " + problems.front().found + ", expected " + problems.front().expected);
  const std::vector<ScenarioProblem> unfit = option_problems(scenario, options);
  EXACTVO_REQUIRE(unfit.empty(),
                  unfit.front().pointer + ": " + unfit.front().found + ", expected " + unfit.front().expected);
  const Clock::time_point start = Clock::now();
  Recording recording;
  std::optional<Guide> guide = guide_for(scenario, options);
  recording.warnings =
      guide ? warnings_with(scenario, options, guide->reachability()) : warnings_before(scenario, options);
  recording.all_half_planes = options.record_all;
  scenario.formation ? run_formation(scenario, options, recording, sink)
                     : run_kinematic(scenario, options, guide ? &*guide : nullptr, recording, sink);
  recording.wall_time += std::chrono::duration<double>(Clock::now() - start).count();
  return recording;
}

}  // namespace exactvo::formation
