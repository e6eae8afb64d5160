// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/simulation.h"

#include <chrono>
#include <string>
#include <utility>

#include "consensus.h"
#include "exactvo/formation/stability.h"
#include "exactvo/geometry/require.h"

#include "goals.h"
#include "preflight.h"
#include "remedies.h"
#include "runs.h"
#include "static_field.h"

namespace exactvo::formation {
namespace {

using namespace detail;
using geometry::norm;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<Vec2> offsets_of(const Scenario& scenario, const SimulationOptions& options) {
  if (!scenario.formation) return {};
  return offsets_in_use(*scenario.formation, remedies_in_use(scenario, options));
}

}  // namespace

std::vector<std::string> warnings_before(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<std::string> warnings;
  if (scenario.formation) warnings = step_warnings(*scenario.formation, options.integrator, scenario.time_step);
  for (std::string& warning : preflight_warnings(scenario, offsets_of(scenario, options)))
    warnings.push_back(std::move(warning));
  return warnings;
}

Recording simulate(const Scenario& scenario, const SimulationOptions& options) {
  const std::vector<ScenarioProblem> problems = validate(scenario);
  EXACTVO_REQUIRE(problems.empty(),
                  problems.front().pointer + ": " + problems.front().found + ", expected " + problems.front().expected);
  const Clock::time_point start = Clock::now();
  std::vector<std::string> warnings = warnings_before(scenario, options);
  Recording recording = scenario.formation ? run_formation(scenario, options) : run_kinematic(scenario, options);
  recording.warnings = std::move(warnings);
  recording.all_half_planes = options.record_all;
  recording.wall_time = seconds_since(start);
  return recording;
}

std::vector<geometry::ConvexShape> enclosures_for(const Scenario& scenario, const SimulationOptions& options,
                                                  std::size_t robot) {
  EXACTVO_REQUIRE(robot < scenario.robots.size(), std::to_string(robot));
  const Robot& r = scenario.robots[robot];
  Scene scene(scenario, options);
  const Vec2 goal = first_goal(scenario, options, robot);
  const StaticField field(scene, scenario, options, r.radius, r.position, goal, HorizonRule::clamped);
  std::vector<geometry::ConvexShape> shapes;
  for (const vo::BodyTable::Number body : field.shapes()) shapes.push_back(scene.bodies()[body].shape);
  return shapes;
}

}  // namespace exactvo::formation
