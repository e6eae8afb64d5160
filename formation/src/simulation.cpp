// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/simulation.h"

#include <chrono>
#include <string>

#include "exactvo/geometry/require.h"
#include "forewarnings.h"
#include "goals.h"
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

}  // namespace

Recording simulate(const Scenario& scenario, const SimulationOptions& options) {
  const std::vector<ScenarioProblem> problems = validate(scenario);
  EXACTVO_REQUIRE(problems.empty(),
                  problems.front().pointer + ": " + problems.front().found + ", expected " + problems.front().expected);
  const Clock::time_point start = Clock::now();
  Recording recording = scenario.formation ? run_formation(scenario, options) : run_kinematic(scenario, options);
  const std::vector<std::string> warnings = detail::forewarnings(scenario, recording.offsets);
  recording.warnings.insert(recording.warnings.end(), warnings.begin(), warnings.end());
  recording.all_half_planes = options.record_all;
  recording.wall_time = seconds_since(start);
  return recording;
}

std::vector<geometry::ConvexShape> enclosures_for(const Scenario& scenario, const SimulationOptions& options,
                                                  std::size_t robot) {
  EXACTVO_REQUIRE(robot < scenario.robots.size(), std::to_string(robot));
  const Robot& r = scenario.robots[robot];
  const ObstacleLibrary library(scenario);
  const Vec2 goal = first_goal(scenario, options, robot);
  const StaticField field(library, scenario, options, r.radius, r.position, goal, HorizonRule::clamped);
  std::vector<geometry::ConvexShape> shapes;
  for (const geometry::Enclosure& e : field.enclosures()) shapes.push_back(e.shape);
  return shapes;
}

}  // namespace exactvo::formation
