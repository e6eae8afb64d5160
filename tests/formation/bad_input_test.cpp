// SPDX-License-Identifier: GPL-3.0-or-later
// What cannot work: a typed error that names the place, or an outcome that says so. None is silent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/formation/stuck.h"
#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

using test::paper_scene;
using testing::HasSubstr;

/// That reading what `write_scenario` wrote of it is refused with this pointer, and running it too.
void expect_refused(const Scenario& s, const std::string& pointer) {
  ASSERT_FALSE(validate(s).empty());
  EXPECT_EQ(validate(s).front().pointer, pointer);
  EXPECT_THROW(simulate(s), std::logic_error);
  try {
    datasets::parse_scenario(datasets::write_scenario(s), "bad.json", ".");
    FAIL() << "was read";
  } catch (const datasets::DataError& error) {
    EXPECT_EQ(error.file(), "bad.json");
    EXPECT_THAT(std::string(error.place()), HasSubstr(pointer));
    EXPECT_FALSE(error.expected().empty());
  }
}

TEST(BadInput, ADisconnectedTopologyIsRefused) {
  Scenario s = paper_scene("B1");
  s.formation->topology.adjacency = {{0, 1, 0}, {1, 0, 0}, {0, 0, 0}};
  s.formation->topology.pinning = {1, 0, 0};
  expect_refused(s, "/formation/topology");
}

TEST(BadInput, AnUnpinnedTopologyIsRefused) {
  Scenario s = paper_scene("B1");
  s.formation->topology.pinning = {0, 0, 0};
  expect_refused(s, "/formation/topology");
}

TEST(BadInput, CoincidingRobotsAreRefused) {
  for (const char* scene : {"A2", "B1"}) {
    Scenario s = paper_scene(scene);
    s.robots[1].position = s.robots[0].position;
    expect_refused(s, "/robots/1/position");
  }
}

TEST(BadInput, AStartInsideAnObstacleIsRefused) {
  Scenario s = paper_scene("A6");
  s.robots[0].position = {6.5, 3.0};
  expect_refused(s, "/robots/0/position");
  s.robots[0].position = {4.6, 3.0};  // outside, but nearer than its radius
  expect_refused(s, "/robots/0/position");
}

Scenario with_cart(TimedPath motion) {
  Scenario s = paper_scene("A0");
  s.obstacles.clear();
  const Vec2 start = s.robots[0].position;
  s.moving_obstacles = {
      {"cart",
       geometry::Polygon{{start + Vec2{1, -1}, start + Vec2{3, -1}, start + Vec2{3, 1}, start + Vec2{1, 1}}, {}},
       std::move(motion)}};
  return s;
}

TEST(BadInput, AStartInsideAMovingObstacleIsRefused) {
  Scenario s = with_cart({{{0, 0}, {20, 0}}, 1.0});
  EXPECT_TRUE(validate(s).empty());
  s.robots[0].position.x += 2.0;
  expect_refused(s, "/robots/0/position");
  EXPECT_THAT(validate(s).front().found, HasSubstr("overlapping moving obstacle 'cart' by "));
  s.robots[0].position.x -= 1.2;  // outside, but nearer than its radius
  expect_refused(s, "/robots/0/position");
}

TEST(BadInput, AProfileOfAMovingObstacleIsCheckedAsALeadersIs) {
  Scenario s = with_cart({{{0, 0}, {20, 0}}, 1.0, {{1, 2}, {0, 2}}});
  ASSERT_FALSE(validate(s).empty());
  EXPECT_EQ(validate(s).front().pointer, "/moving_obstacles/0/profile/1/0");
  s.moving_obstacles[0].motion.profile = {{0, -2}};
  EXPECT_EQ(validate(s).front().pointer, "/moving_obstacles/0/profile/0/1");
}

std::string warnings_of(const Scenario& s) {
  std::string all;
  for (const std::string& w : warnings_before(s, {})) all += w + "\n";
  return all;
}

TEST(BadInput, AnObstacleFasterThanARobotIsReportedBeforeTheRun) {
  EXPECT_EQ(warnings_of(paper_scene("B1")), "");
  Scenario s = paper_scene("B1");
  s.robots[1].max_speed = 4.0;  // the leader goes at 4.24 m/s
  EXPECT_THAT(warnings_of(s), HasSubstr("the leader moves at up to 4.24264 m/s, faster than R2 can (max_speed 4 m/s)"));
  s.speed_bound = SpeedBoundKind::box;  // at 45 degrees each component is 3 m/s
  EXPECT_EQ(warnings_of(s), "");
  s.robots[1].max_speed = 2.0;
  EXPECT_THAT(warnings_of(s), HasSubstr("faster than R2 can"));
  s = paper_scene("B1");
  s.formation->leader.profile = {{0, 1}, {3, 7}, {4, 1}};
  EXPECT_THAT(warnings_of(s), HasSubstr("the leader moves at up to 7 m/s, faster than R1 can"));
  EXPECT_THAT(warnings_of(with_cart({{{0, 0}, {20, 0}}, 9.0})),
              HasSubstr("moving obstacle 'cart' moves at up to 9 m/s, faster than R1"));
  EXPECT_EQ(warnings_of(with_cart({{{0, 0}}, 9.0})), "") << "it has nowhere to go";
  s = datasets::load_scenario(EXACTVO_SOURCE_DIR "/datasets/data/robots/B0_huskies.json");
  s.formation->leader.speed = 2.0;
  EXPECT_THAT(warnings_of(s), HasSubstr("faster than R1 can (max_wheel_speed 1 m/s)"));
}

TEST(BadInput, SpeedsAfterTheEndOfThePathOrTheRunDoNotCount) {
  // 20 m at 2 m/s take 10 s; what the profile says of later never happens.
  const TimedPath late{{{0, 0}, {20, 0}}, 0.0, {{0, 2}, {11, 2}, {12, 9}}};
  EXPECT_EQ(warnings_of(with_cart(late)), "");
  Scenario s = paper_scene("B1");
  s.formation->leader = {late};
  EXPECT_EQ(warnings_of(s), "");
  s.formation->leader.profile[1].time = s.formation->leader.profile[2].time = 9.0;  // the last 2 m at 9 m/s
  EXPECT_THAT(warnings_of(s), HasSubstr("the leader moves at up to "));
  s = with_cart({{{0, 0}, {200, 0}}, 0.0, {{0, 2}, {50, 2}, {51, 9}}});
  s.time_limit = 45.0;
  EXPECT_EQ(warnings_of(s), "");
  s.time_limit = 55.0;
  EXPECT_THAT(warnings_of(s), HasSubstr("moving obstacle 'cart' moves at up to 9 m/s"));
}

TEST(BadInput, ABoxCountsEachLegAtItsOwnSpeed) {
  Scenario s = paper_scene("B1");
  s.speed_bound = SpeedBoundKind::box;
  const double most = s.robots[0].max_speed;
  s.formation->leader.path = {{0, 0}, {20, 20}, {40, 20}};
  // Fast along the diagonal, where each component is 1.3 / sqrt(2) of the bound, and slow along the axis.
  s.formation->leader.profile = speed_of_legs(s.formation->leader.path, {1.3 * most, 0.9 * most});
  EXPECT_EQ(warnings_of(s), "");
  s.formation->leader.profile = speed_of_legs(s.formation->leader.path, {0.9 * most, 1.3 * most});
  EXPECT_THAT(warnings_of(s), HasSubstr("the leader moves at up to "));
}

TEST(BadInput, AStartAtExactlyTheSpeedLimitIsNoWarning) {
  Scenario s = paper_scene("A0");
  for (int k = 0; k < 500; ++k) {
    s.robots[0].velocity = s.robots[0].max_speed * Vec2{std::cos(0.1 * k), std::sin(0.1 * k)};
    EXPECT_EQ(warnings_of(s), "") << k;
  }
}

TEST(BadInput, AMovingObstacleThatStopsOnItsWayComesToRestThere) {
  // From 4 s on it stands 4 m from where it began, and its path goes on.
  Scenario s = with_cart({{{0, 0}, {20, 0}}, 0.0, {{0, 1}, {4, 1}, {4, 0}}});
  s.robots[0].goals = {s.robots[0].position + Vec2{6.0, 0.0}};
  EXPECT_THAT(warnings_of(s), HasSubstr("lies where moving obstacle 'cart' comes to rest after 4 s"));
  s.robots[0].goals = {s.robots[0].position + Vec2{12.0, 0.0}};
  EXPECT_EQ(warnings_of(s), "");
}

TEST(BadInput, AStartBeyondTheSpeedLimitIsReportedBeforeTheRun) {
  Scenario s = paper_scene("A0");
  s.robots[0].velocity = {s.robots[0].max_speed + 1.0, 0.0};
  EXPECT_THAT(warnings_of(s), HasSubstr("beyond its max_speed"));
}

TEST(BadInput, AGoalWhereAMovingObstacleComesToRestIsReportedBeforeTheRun) {
  Scenario s = with_cart({{{0, 0}, {20, 0}}, 1.0});
  const Vec2 start = s.robots[0].position;
  s.robots[0].goals = {start + Vec2{22.0, 0.0}};
  EXPECT_THAT(warnings_of(s), HasSubstr("lies where moving obstacle 'cart' comes to rest after 20 s"));
  s.robots[0].goals = {start + Vec2{2.0, 0.0}};
  EXPECT_EQ(warnings_of(s), "") << "it leaves";
  s.moving_obstacles[0].motion.speed = 0.0;
  EXPECT_THAT(warnings_of(s), HasSubstr("comes to rest: from then on it cannot be reached"));
}

TEST(BadInput, AStartInTheHullOfAMovingObstacleIsReportedBeforeTheRun) {
  Scenario s = with_cart({{{0, 0}, {20, 0}}, 1.0});
  const Vec2 start = s.robots[0].position;
  s.moving_obstacles[0].shape =
      geometry::Polyline{{start + Vec2{-2, -2}, start + Vec2{2, -2}, start + Vec2{2, 2}, start + Vec2{-2, 2}}};
  EXPECT_TRUE(validate(s).empty());
  EXPECT_THAT(warnings_of(s), HasSubstr("starts inside the convex hull of moving obstacle 'cart'"));
}

TEST(BadInput, GainsOfZeroOrBelowAreRefused) {
  double Gains::*const gains[] = {&Gains::k1, &Gains::k2, &Gains::k3, &Gains::kappa};
  const char* const names[] = {"k1", "k2", "k3", "kappa"};
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double value : {0.0, -0.25}) {
      Scenario s = paper_scene("B1");
      s.formation->gains.*gains[i] = value;
      expect_refused(s, std::string("/formation/gains/") + names[i]);
    }
  }
}

TEST(BadInput, AStepBeyondTheHorizonsLimitIsRefused) {
  Scenario s = paper_scene("A2");
  s.time_step = 0.2;  // horizons.least is 0.3 s
  expect_refused(s, "/time_step");
}

TEST(BadInput, AStepBeyondTheIntegratorsLimitIsReportedBeforeTheRun) {
  Scenario s = paper_scene("B0");
  s.time_step = 0.06;
  SimulationOptions euler;
  euler.integrator = Integrator::euler;
  const Metrics m = test::run(s, euler).metrics;
  ASSERT_FALSE(m.warnings.empty());
  EXPECT_THAT(m.warnings.front(), HasSubstr("beyond explicit Euler's limit"));
  EXPECT_THAT(m.outcome, HasSubstr("diverged"));
}

TEST(BadInput, AGoalInsideAnObstacleIsReportedBeforeAndAfterTheRun) {
  Scenario s = paper_scene("A6");
  s.robots[0].goals = {{6.5, 3.0}};
  s.time_limit = 30.0;
  const Metrics m = test::run(s, {}).metrics;
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_THAT(m.warnings[0],
              testing::EndsWith("lies inside obstacle '" + s.obstacles[0].id + "': it cannot be reached"));
  EXPECT_THAT(m.outcome, HasSubstr("did not arrive"));
  ASSERT_EQ(m.stuck.size(), 1u);
  EXPECT_GT(m.min_obstacle_clearance.value(), 0.0);
}

TEST(BadInput, AGoalNearerToAWallThanTheRadiusIsReported) {
  Scenario s = paper_scene("A6");
  s.robots[0].goals = {{8.3, 3.0}};
  s.time_limit = 10.0;
  const Recording r = simulate(s);
  ASSERT_EQ(r.warnings.size(), 1u);
  EXPECT_THAT(r.warnings[0], HasSubstr("too near to obstacle"));
  s.robots[0].goals = {{8.55, 3.0}};
  EXPECT_TRUE(simulate(s).warnings.empty());
}

TEST(BadInput, TwoGoalsInOnePlaceAreReported) {
  Scenario s = paper_scene("A0");
  s.robots[1].goals = s.robots[0].goals;
  s.time_limit = 1.0;
  const Recording r = simulate(s);
  ASSERT_EQ(r.warnings.size(), 1u);
  EXPECT_THAT(r.warnings[0], testing::ContainsRegex(
                                 "too near to each other for both robots: [0-9.]+ m, and their radii take [0-9.]+ m"));
}

/// Neither too near nor with the margin between them: the second robot pressed against the first for ever, and nothing
/// had been said.
TEST(BadInput, GoalsNearerThanTheMarginAreReported) {
  Scenario s;
  for (const double x : {-5.0, 5.0}) {
    Robot& robot = s.robots.emplace_back();
    robot.id = x < 0.0 ? "W" : "E";
    robot.position = {x, 0.0};
    robot.goals = {{0.0, x < 0.0 ? 0.0 : 0.84}};
  }
  EXPECT_THAT(warnings_before(s),
              testing::ElementsAre("goal of E, (0, 0.84), and goal of W, (0, 0), are 0.84 m apart, and "
                                   "radii and margin take 1.04 m: the second to come finds no room"));
  // From 0.86 m on both find room where they stand aside, within 0.09 m of their goals.
  for (const double apart : {0.861, 0.95, 1.05}) {
    s.robots[1].goals = {{0.0, apart}};
    EXPECT_TRUE(warnings_before(s).empty()) << apart;
  }
  s.robots[1].goals = {{0.0, 0.7}};
  EXPECT_THAT(warnings_before(s), testing::ElementsAre(HasSubstr("too near to each other")));
}

TEST(BadInput, AGoalOnTheWayInWhichAnotherRobotIsToRestIsReported) {
  Scenario s;
  for (const double x : {-5.0, 5.0}) {
    Robot& robot = s.robots.emplace_back();
    robot.id = x < 0.0 ? "W" : "E";
    robot.position = {x, 0.0};
    robot.goals = {{0.0, 0.0}};
  }
  s.robots[1].goals = {{0.0, 0.3}, {0.0, 5.0}};
  EXPECT_TRUE(warnings_before(s).empty()) << "the robot that rests there makes way and comes back, by a plan";
  s.liveness = Liveness::bias;
  EXPECT_THAT(warnings_before(s),
              testing::ElementsAre("goal 1 of E, (0, 0.3), cannot be reached while W is at its last goal"));
  s.robots[1].goals[0] = {0.0, 0.45};
  EXPECT_TRUE(warnings_before(s).empty());
}

TEST(BadInput, AmongManyRobotsWithOneGoalTheFirstPairsAreNamed) {
  Scenario s;
  for (int k = 0; k < 50; ++k) {
    Robot& robot = s.robots.emplace_back();
    robot.id = "R" + std::to_string(k);
    robot.position = {2.0 * k, 0.0};
    robot.goals = {{0.0, 9.0}};
  }
  s.time_limit = 0.1;
  const std::vector<std::string> warnings = warnings_before(s);
  ASSERT_EQ(warnings.size(), 11u);
  EXPECT_EQ(warnings.back(), "1215 more pairs of goals too near to each other");
}

/// A closed room round the goal.
Scenario closed_room() {
  Scenario s;
  s.name = "closed-room";
  Robot r;
  r.id = "R1";
  r.goals = {{10.0, 0.0}};
  s.robots = {r};
  s.obstacles = {{"room", geometry::Polyline{{{7, -3}, {13, -3}, {13, 3}, {7, 3}, {7, -3}}}}};
  s.time_limit = 60.0;
  return s;
}

TEST(BadInput, AGoalInAClosedRoomEndsWithTheFullCircleStated) {
  SimulationOptions options;
  options.guidance = Guidance::none;
  options.liveness = Liveness::off;
  const test::FinishedRun r = test::run(closed_room(), options);
  EXPECT_FALSE(r.metrics.all_arrived);
  EXPECT_THAT(r.recording.outcome, HasSubstr("the robot did not arrive"));
  EXPECT_THAT(r.recording.outcome, HasSubstr("R1 completed a full circuit"));
  EXPECT_GT(r.metrics.min_obstacle_clearance.value(), 0.0);
}

TEST(BadInput, ASlotInsideAnObstacleIsReported) {
  Scenario s = paper_scene("B1");
  s.obstacles = {{"block", geometry::Polygon{{{22, 22}, {28, 22}, {28, 28}, {22, 28}}, {}}}};
  const Recording r = simulate(s);
  ASSERT_EQ(r.warnings.size(), 3u);
  EXPECT_THAT(r.warnings[0], HasSubstr("slot of R1"));
}

TEST(Outcomes, CountRobotsInWordsThatAgree) {
  Scenario s = paper_scene("A0");
  EXPECT_EQ(simulate(s).outcome, "all robots arrived");
  s.time_limit = 1.0;
  EXPECT_EQ(simulate(s).outcome, "none of 2 robots arrived within the time limit");
  s.robots[1].goals = {s.robots[1].position};
  EXPECT_EQ(simulate(s).outcome, "1 of 2 robots did not arrive within the time limit");
  s.robots.pop_back();
  EXPECT_EQ(simulate(s).outcome, "the robot did not arrive within the time limit");
  s.robots[0].goals = {s.robots[0].position};
  EXPECT_EQ(simulate(s).outcome, "the robot arrived");
}

}  // namespace
}  // namespace exactvo::formation
