// SPDX-License-Identifier: GPL-3.0-or-later
// A hundred robots in a grid through a field of fifty polygons.
#include <gtest/gtest.h>

#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

TEST(Hundred, ArriveSafelyFasterThanRealTime) {
  const Scenario s = datasets::load_scenario(std::string(EXACTVO_SOURCE_DIR) + "/datasets/data/formation/hundred.json");
  ASSERT_EQ(s.robots.size(), 100u);
  ASSERT_EQ(s.obstacles.size(), 50u);
  const test::FinishedRun r = test::run(s, {});
  const Metrics& m = r.metrics;
  std::printf(
      "hundred robots: error %.3g m, clearances %.4f / %.4f m, %zu relaxed, %zu uncertified, %.1f s wall for %.0f s\n",
      *m.formation_position_error, *m.min_obstacle_clearance, *m.min_robot_clearance, m.relaxed_steps,
      m.uncertified_half_planes, m.wall_time, s.time_limit);
  EXPECT_TRUE(m.all_arrived);
  EXPECT_LT(m.formation_position_error.value(), 1e-6);
  EXPECT_TRUE(is_safe(m));
  EXPECT_LT(m.wall_time, s.time_limit);
}

}  // namespace
}  // namespace exactvo::formation
