// SPDX-License-Identifier: GPL-3.0-or-later
// Own steering and own half-planes: six robots are drawn to a place that none may enter, and circle it.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"

using namespace exactvo;
using geometry::Vec2;

int main() {
  constexpr double kForbidden = 2.0, kRing = 1.5, kStep = 0.1;  // m, m, s
  formation::Scenario scenario;
  scenario.name = "ring";
  scenario.time_step = kStep;
  scenario.time_limit = 20.0;
  for (int k = 0; k < 6; ++k) {
    const double angle = 1.0471975511965976 * k;
    formation::Robot robot;
    robot.id = "R" + std::to_string(k + 1);
    robot.radius = 0.3;
    robot.max_speed = 1.0;
    robot.position = {4.0 * std::cos(angle), 4.0 * std::sin(angle)};
    robot.goals = {-1.0 * robot.position};
    scenario.robots.push_back(robot);
  }

  formation::SimulationOptions options;
  options.steering = [](const formation::RobotSlice& robots, std::vector<Vec2>& preferred) {
    for (std::size_t i = robots.first; i < robots.last; ++i) {
      const Vec2 at = robots.positions[i];
      const double away = geometry::norm(at);
      preferred[i] = (1.4 / away) * Vec2{-at.y, at.x} + ((kRing - away) / away) * at;
    }
  };
  // Within a step no nearer to the middle than allowed: n.v >= (forbidden - distance) / step, n away from the middle.
  options.half_planes = [](const formation::RobotSlice& robots, const std::vector<Vec2>&,
                           std::vector<formation::OwnHalfPlane>& out) {
    for (std::size_t i = robots.first; i < robots.last; ++i) {
      const Vec2 at = robots.positions[i];
      out.push_back({i, {geometry::normalized(at), (kForbidden - geometry::norm(at)) / kStep}, true});
    }
  };

  const formation::Recording run = simulate(scenario, options);
  double nearest = 1e9;
  std::size_t held = 0;
  for (const formation::Step& row : run.steps)
    for (const formation::RobotStep& robot : row.robots) {
      nearest = std::min(nearest, geometry::norm(robot.position));
      held += robot.own_stage == formation::OwnStage::held;
    }
  const formation::Metrics metrics = measure(scenario, run);
  std::printf("%zu decisions hold it, no robot came nearer than %.3f m, %zu collisions\n", held, nearest,
              metrics.collisions.size());
  return held > 500 && nearest >= kForbidden - 1e-9 && metrics.collisions.empty() ? 0 : 1;
}
