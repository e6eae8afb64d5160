// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that are in each other's way: they turn to the right, and no half-plane between them is relaxed.
#include <gtest/gtest.h>

#include <cmath>

#include "decision.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

constexpr double kTurn = 6.283185307179586;

Robot robot(const std::string& id, Vec2 from, Vec2 to) {
  Robot r;
  r.id = id;
  r.position = from;
  r.max_speed = 1.5;
  r.goals = {to};
  return r;
}

/// Every robot crosses a circle to the opposite place, exactly symmetric; starts are three diameters apart.
Scenario circle(int count) {
  Scenario s;
  s.name = "circle";
  s.time_limit = 120.0;
  const double radius = std::max(4.0, 3.0 * count / kTurn);
  for (int i = 0; i < count; ++i) {
    const Vec2 p = radius * geometry::rotated({1.0, 0.0}, kTurn * i / count);
    s.robots.push_back(robot("R" + std::to_string(i + 1), p, -p));
  }
  return s;
}

std::size_t relaxed(const Recording& run) {
  std::size_t count = 0;
  for (const Step& row : run.steps)
    for (const RobotStep& r : row.robots)
      count += r.status == lp::Status::relaxed || r.status == lp::Status::infeasible;
  return count;
}

TEST(Liveness, CirclesOfTwoToTwentyAllArrive) {
  for (const int count : {2, 3, 4, 5, 6, 8, 12, 20}) {
    for (const Method method : {Method::orca, Method::ivo}) {
      SimulationOptions options;
      options.method = method;
      const Scenario s = circle(count);
      const Recording run = simulate(s, options);
      const Metrics m = measure(s, run);
      EXPECT_TRUE(m.all_arrived) << count << " " << name(method) << ": " << m.outcome;
      EXPECT_TRUE(m.collisions.empty()) << count << " " << name(method);
      EXPECT_EQ(relaxed(run), 0u) << count << " " << name(method);
      EXPECT_EQ(m.uncertified_half_planes, 0u);
    }
  }
}

TEST(Liveness, OffIsThePapersWayInWhichFourWaitForEver) {
  SimulationOptions off;
  off.liveness = Liveness::off;
  EXPECT_FALSE(measure(circle(4), simulate(circle(4), off)).all_arrived);
  Scenario s = circle(4);
  EXPECT_EQ(liveness_of(s, {}), Liveness::bias);
  EXPECT_EQ(liveness_of(s, off), Liveness::off);
  s.liveness = Liveness::off;
  EXPECT_EQ(liveness_of(s, {}), Liveness::off);
}

TEST(Liveness, ALoneRobotGoesStraight) {
  Scenario s;
  s.robots = {robot("R1", {0, 0}, {10, 0})};
  for (const Step& row : simulate(s).steps) EXPECT_EQ(row.robots[0].position.y, 0.0);
}

/// Rule R0: in a crowd too dense for its half-planes nothing is relaxed and nobody overlaps.
TEST(Liveness, NothingBetweenRobotsIsRelaxedInACrowd) {
  test::SeededRandom random(test::seed_of_run(17));
  for (int k = 0; k < 3; ++k) {
    Scenario s;
    s.name = "box";
    s.time_limit = 20.0;
    s.obstacles = {{"box", geometry::Polyline{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}, {-5, -5}}}}};
    for (int i = 0; i < 36; ++i) {  // 28 % of the box
      const Vec2 place{-3.75 + 1.5 * (i % 6), -3.75 + 1.5 * (i / 6)};
      s.robots.push_back(robot("R" + std::to_string(i + 1), place + random.in_box(0.2), random.in_box(4.0)));
    }
    const Recording run = simulate(s);
    const Metrics m = measure(s, run);
    EXPECT_EQ(relaxed(run), 0u) << k;
    EXPECT_TRUE(m.collisions.empty()) << k << ": " << m.outcome;
    EXPECT_EQ(m.uncertified_half_planes, 0u) << k;
    SimulationOptions off;
    off.liveness = Liveness::off;
    EXPECT_GT(relaxed(simulate(s, off)), 0u) << "the crowd is no test";
  }
}

/// What a pair falls back to is satisfied at rest, opposite bit for bit, and proven.
TEST(Liveness, APairThatFallsBackMayRest) {
  test::SeededRandom random(test::seed_of_run(18));
  for (int k = 0; k < 2000; ++k) {
    Scenario s;
    s.robots = {robot("a", {}, {9, 9}), robot("b", {}, {-9, 9})};
    s.robots[0].radius = random.uniform(0.1, 1.0);
    s.robots[1].radius = random.uniform(0.1, 1.0);
    const double gap = std::ldexp(random.uniform(0.5, 1.0), random.integer(-40, 2));
    s.robots[1].position =
        (s.robots[0].radius + s.robots[1].radius + gap) * geometry::rotated({1.0, 0.0}, random.uniform(0.0, kTurn));
    const SimulationOptions options;
    detail::Scene scene(s, options);
    std::vector<detail::Anchor> anchors{{s.robots[0].position, random.in_box(2.0)},
                                        {s.robots[1].position, random.in_box(2.0)}};
    std::vector<std::vector<detail::Constraint>> constraints;
    detail::robot_constraints(s, options, anchors, scene, constraints);
    detail::fall_back(s, anchors, scene, 0, 1, constraints);
    for (int i = 0; i < 2; ++i) {
      ASSERT_EQ(constraints[i].size(), 1u);
      EXPECT_LE(constraints[i][0].half_plane.offset, 0.0) << gap;
      EXPECT_EQ(constraints[i][0].proof, vo::Proof::pair) << gap;
    }
    EXPECT_EQ(constraints[0][0].half_plane.normal, -constraints[1][0].half_plane.normal);
  }
}

}  // namespace
}  // namespace exactvo::formation
