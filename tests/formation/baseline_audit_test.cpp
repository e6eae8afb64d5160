// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of the baseline are proven whole too: where robots pass each other in contact, and along walls whose edges are
// nearly collinear.
#include <gtest/gtest.h>

#include <string>

#include "audited.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {
namespace {

SimulationOptions baseline() {
  SimulationOptions options;
  options.method = Method::orca;
  options.guidance = Guidance::none;
  options.liveness = Liveness::off;
  return options;
}

Robot robot(const std::string& id, Vec2 position, Vec2 goal) {
  Robot r;
  r.id = id;
  r.position = position;
  r.goals = {goal};
  return r;
}

/// Where a robot is in the next row is rounded: in exact contact that may be an overlap.
TEST(BaselineAudit, ProvesThatRobotsPassWithoutOverlapFarFromZero) {
  for (const double margin : {0.0, 0.04})
    for (int k = 0; k < 24; ++k) {
      Scenario s;
      s.time_limit = 6.0;
      s.margins.robot = margin;
      const double x = 1000.0 + 0.1 * k, y = -1000.0 - 0.07 * k;
      s.robots = {robot("A", {x, y}, {x + 9.0, y}), robot("B", {x + 9.0, y + 0.3 + 0.02 * k}, {x, y + 0.1}),
                  robot("C", {x + 4.0, y - 5.0}, {x + 4.5, y + 5.0})};
      for (const Method method : {Method::orca, Method::ivo}) {
        SimulationOptions options = baseline();
        options.method = method;
        EXPECT_TRUE(audits_clean(s, simulate(s, options))) << name(method) << " " << margin << " " << k;
      }
    }
}

/// Each of two edges leaves the half-plane to the other.
TEST(BaselineAudit, FindsAHalfPlaneForEveryEdgeOfAWallInReach) {
  for (const double beside : {0.51, 0.56, 0.6, 0.64})
    for (const double step : {1e-9, 1e-6, 1e-3}) {
      Scenario s;
      s.time_limit = 8.0;
      s.robots = {robot("A", {beside, 3.0}, {beside - 0.3, -6.0})};
      s.obstacles = {{"wall", geometry::Polyline{{{0.0, 0.0}, {0.0, step}, {0.0, 4.0}}}}};
      EXPECT_TRUE(audits_clean(s, simulate(s, baseline()))) << beside << " " << step;
    }
}

}  // namespace
}  // namespace exactvo::formation
