// SPDX-License-Identifier: GPL-3.0-or-later
// A leader along a polyline with any speed profile.
#include "motion/leader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/speed_profile.h"
#include "paper_scenes.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using detail::leader_arrival;
using detail::leader_at;
using detail::LeaderState;

const std::vector<Vec2> kCorner{{0, 0}, {6, 0}, {6, 4}};  // 10 m

TEST(SpeedProfile, ATrapezoidCoversThePathAndRestsAtItsEnd) {
  TimedPath leader{kCorner, 0.0, trapezoid(kCorner, 2.0, 1.0)};
  // 2 s up (2 m), 3 s at 2 m/s (6 m), 2 s down (2 m).
  EXPECT_NEAR(leader_arrival(leader), 7.0, 1e-5);
  EXPECT_EQ(leader_at(leader, 0.0).velocity, (Vec2{0, 0}));
  EXPECT_NEAR(leader_at(leader, 1.0).position.x, 0.5, 1e-12);
  EXPECT_NEAR(leader_at(leader, 1.0).velocity.x, 1.0, 1e-12);
  EXPECT_NEAR(leader_at(leader, 5.0).position.y, 2.0, 1e-12);
  EXPECT_NEAR(leader_at(leader, 6.0).velocity.y, 1.0, 1e-12);
  EXPECT_EQ(leader_at(leader, 7.0).position, kCorner.back());
  EXPECT_EQ(leader_at(leader, 7.0).velocity, (Vec2{0, 0}));
}

TEST(SpeedProfile, AShortPathMakesATriangle) {
  const std::vector<Vec2> path{{0, 0}, {1, 0}};
  const TimedPath leader{path, 0.0, trapezoid(path, 5.0, 1.0)};
  EXPECT_NEAR(leader_arrival(leader), 2.0, 1e-5);
  EXPECT_NEAR(leader_at(leader, 1.0).velocity.x, 1.0, 1e-12);
  EXPECT_NEAR(leader_at(leader, 1.0).position.x, 0.5, 1e-12);
}

TEST(SpeedProfile, EachLegAtASpeedOfItsOwn) {
  const TimedPath leader{kCorner, 0.0, speed_of_legs(kCorner, {3.0, 0.5})};
  EXPECT_NEAR(leader_at(leader, 1.0).position.x, 3.0, 1e-12);
  EXPECT_NEAR(leader_at(leader, 1.999).velocity.x, 3.0, 1e-12);
  EXPECT_NEAR(leader_at(leader, 4.0).position.y, 1.0, 1e-12);
  EXPECT_NEAR(leader_at(leader, 4.0).velocity.y, 0.5, 1e-12);
  EXPECT_NEAR(leader_arrival(leader), 10.0, 1e-9);
}

TEST(SpeedProfile, VelocityIsTheDerivativeOfPosition) {
  const TimedPath leader{{{0, 0}, {100, 0}}, 0.0, {{1, 0.5}, {2, 3}, {2, 1}, {4, 1}, {5, 0}, {6, 0}, {8, 2}}};
  constexpr double kStep = 1e-4;
  for (double t = 0.05; t < 12.0; t += 0.1) {
    const LeaderState now = leader_at(leader, t), next = leader_at(leader, t + kStep);
    EXPECT_NEAR((next.position.x - now.position.x) / kStep, 0.5 * (now.velocity.x + next.velocity.x), 1e-6) << t;
  }
}

/// A velocity holds from its own time on, though the place of the corner before it is rounded.
TEST(SpeedProfile, VelocitiesThatChangeTogetherWithTheWayBeginAtTheirTimes) {
  test::SeededRandom random(test::seed_of_run(7));
  std::vector<TimedVelocity> velocities;
  for (int k = 0; k < 500; ++k)
    velocities.push_back({k * 0.1, random.integer(0, 3) == 0 ? Vec2{} : random.uniform(0.1, 2.0) * random.direction()});
  const TimedPath motion = path_of({3, -2}, velocities, 60.0);
  for (const TimedVelocity& v : velocities)
    EXPECT_LT(norm(leader_at(motion, v.time).velocity - v.velocity), 1e-9) << v.time;
}

TEST(SpeedProfile, ALeaderThatStopsShortNeverArrives) {
  EXPECT_TRUE(std::isinf(leader_arrival({{{0, 0}, {9, 0}}, 0.0, {{0, 1}, {2, 0}}})));
  EXPECT_TRUE(std::isinf(leader_arrival({{{0, 0}, {9, 0}}, 0.0, {{0, 0}}})));
}

TEST(SpeedProfile, TheFormationFollowsEveryProfile) {
  Scenario s = test::paper_scene("B3");
  std::vector<Vec2>& path = s.formation->leader.path;
  path = {{0, 0}, {10, 8}, {25, 25}};
  s.time_limit = 40.0;
  for (const auto& profile : {trapezoid(path, 4.0, 1.5), speed_of_legs(path, {2.0, 3.5}),
                              std::vector<SpeedKnot>{{0, 1}, {4, 3}, {6, 0}, {8, 0}, {10, 4}}}) {
    s.formation->leader.profile = profile;
    ASSERT_TRUE(validate(s).empty());
    const Metrics m = test::run(s, {}).metrics;
    EXPECT_TRUE(m.leader_arrival_time.has_value());
    EXPECT_LT(m.formation_position_error.value(), 1e-9);
    EXPECT_GT(m.min_obstacle_clearance.value(), 0.0);
    EXPECT_GT(m.min_robot_clearance.value(), 0.0);
  }
}

TEST(SpeedProfile, ATimeThatFallsIsRefused) {
  Scenario s = test::paper_scene("B0");
  s.formation->leader.profile = {{0, 1}, {3, 1}, {2, 1}};
  ASSERT_FALSE(validate(s).empty());
  EXPECT_EQ(validate(s).front().pointer, "/formation/leader/profile/2/0");
}

}  // namespace
}  // namespace exactvo::formation
