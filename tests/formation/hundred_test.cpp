// SPDX-License-Identifier: GPL-3.0-or-later
// A hundred robots in a grid through a field of fifty polygons.
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/formation/patterns.h"
#include "paper_scenes.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

constexpr double kSpacing = 3.0;  // m

bool fits(Vec2 centre, double radius, const std::vector<geometry::Disc>& placed) {
  for (const geometry::Disc& d : placed)
    if (norm(d.center - centre) < d.radius + radius + 3.0) return false;
  return true;
}

Scenario hundred_robots() {
  Scenario s;
  s.name = "hundred";
  const std::vector<Vec2> offsets = pattern_offsets(Pattern::grid, 100, kSpacing);
  s.formation.emplace();
  s.formation->offsets = offsets;
  s.formation->topology = neighbour_topology(offsets, 1.1 * kSpacing);
  s.formation->leader = {{{0, 0}, {140, 0}}, 1.5};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    Robot r;
    r.id = "R" + std::to_string(i + 1);
    r.position = offsets[i];
    r.max_speed = 4.0;
    r.radius = 0.4;
    s.robots.push_back(r);
  }
  test::SeededRandom random(5);
  std::vector<geometry::Disc> placed;
  while (placed.size() < 50) {
    const Vec2 centre{random.uniform(20.0, 120.0), random.uniform(-18.0, 18.0)};
    const double radius = random.uniform(0.5, 1.2);
    if (!fits(centre, radius, placed)) continue;
    placed.push_back({centre, radius});
    geometry::Polygon polygon;
    const int corners = random.integer(3, 6);
    for (int k = 0; k < corners; ++k)
      polygon.outer.push_back(centre + geometry::rotated({radius, 0.0}, 6.283185307179586 * k / corners));
    s.obstacles.push_back({"O" + std::to_string(placed.size()), polygon});
  }
  s.time_step = 0.05;
  s.time_limit = 135.0;
  s.neighbour_distance = 4.0;
  s.margins.robot = 0.2;
  s.horizons.robots = 0.6;
  return s;
}

TEST(Hundred, ArriveSafelyFasterThanRealTime) {
  const Scenario s = hundred_robots();
  ASSERT_TRUE(validate(s).empty());
  const test::FinishedRun r = test::run(s, {});
  const Metrics& m = r.metrics;
  RecordProperty("wall_time_s", std::to_string(m.wall_time));
  std::printf(
      "hundred robots: error %.3g m, clearances %.4f / %.4f m, %zu relaxed, %zu uncertified, %.1f s wall for %.0f s\n",
      *m.formation_position_error, *m.min_obstacle_clearance, *m.min_robot_clearance, m.relaxed_steps,
      m.uncertified_half_planes, m.wall_time, s.time_limit);
  EXPECT_LT(m.formation_position_error.value(), 1e-6);
  EXPECT_GT(m.min_obstacle_clearance.value(), 0.0);
  EXPECT_GT(m.min_robot_clearance.value(), 0.0);
  EXPECT_EQ(m.uncertified_half_planes, 0u);
  EXPECT_LT(m.wall_time, s.time_limit);
}

}  // namespace
}  // namespace exactvo::formation
