// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of scenarios on a crowd: goals too near to each other, and moving obstacles that park on routes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/simulation.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using geometry::Vec2;
using testing::HasSubstr;

Robot robot(std::string id, Vec2 position, std::vector<Vec2> goals, double radius = 0.3) {
  Robot r;
  r.id = std::move(id);
  r.position = position;
  r.goals = std::move(goals);
  r.radius = radius;
  r.max_speed = 1.0;
  return r;
}

Scenario scenario_of(std::vector<Robot> robots) {
  Scenario s;
  s.name = "ends";
  s.robots = std::move(robots);
  s.time_limit = 120.0;
  return s;
}

/// Positions at the end of a run.
struct LastRow final : RunSink {
  std::vector<Vec2> places;
  void add_state(const RunState& now) override { places = now.positions; }
};

TEST(CrowdEnds, RobotsStandAsideForGoalsThatAreALittleTooNear) {
  const Scenario s = scenario_of({robot("a", {-5.0, 0.0}, {{0.0, 0.0}}), robot("b", {5.0, 0.0}, {{0.5, 0.0}})});
  LastRow last;
  const RunReport r = run_crowd(s, {}, &last);
  EXPECT_EQ(r.arrived, 2U);
  EXPECT_TRUE(r.goal_taken.empty());
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT(norm(last.places[i] - s.robots[i].goals.back()), 2.0 * s.arrival_tolerance);
}

TEST(CrowdEnds, TheSecondRobotStaysBesideAndDoesNotMoveTheFirst) {
  const Scenario s = scenario_of({robot("a", {-2.0, 0.0}, {{0.0, 0.0}}), robot("b", {9.0, 0.1}, {{0.0, 0.0}})});
  LastRow last;
  const RunReport r = run_crowd(s, {}, &last);
  EXPECT_EQ(r.arrived, 1U);
  ASSERT_EQ(r.goal_taken.size(), 1U);
  EXPECT_EQ(r.goal_taken[0].robot, 1U);
  EXPECT_THAT(r.goal_taken[0].why, HasSubstr("a was first at the goal that both have"));
  EXPECT_LT(norm(last.places[0]), 1e-3);
  EXPECT_LT(norm(last.places[1]), 1.0);
  EXPECT_LT(r.time, 30.0);
}

TEST(CrowdEnds, AGoalOnTheWayThatIsTakenIsPassedBesideIt) {
  const Scenario s =
      scenario_of({robot("a", {0.0, 0.0}, {{0.0, 0.0}}), robot("b", {5.0, 0.0}, {{0.0, 0.0}, {0.0, 5.0}})});
  const RunReport r = run_crowd(s, {});
  EXPECT_EQ(r.arrived, 2U);
  EXPECT_LT(r.time, 30.0);
}

TEST(CrowdEnds, WithLivenessOffRobotsPush) {
  Scenario s = scenario_of({robot("a", {-2.0, 0.0}, {{0.0, 0.0}}), robot("b", {9.0, 0.1}, {{0.0, 0.0}})});
  s.liveness = Liveness::off;
  const RunReport r = run_crowd(s, {});
  EXPECT_TRUE(r.goal_taken.empty());
  EXPECT_EQ(r.arrived, 1U) << "a robot that is pushed off its goal is not there";
}

/// Ten robots with goals among fewer places, some with a goal on the way.
Scenario random_scenario(std::uint64_t seed) {
  test::SeededRandom random(seed);
  std::vector<Vec2> goals;
  for (int count = random.integer(1, 8); count > 0; --count) goals.push_back(random.in_box(8.0));
  const auto goal = [&] {
    return goals[static_cast<std::size_t>(random.integer(1, static_cast<int>(goals.size()))) - 1];
  };
  std::vector<Robot> robots;
  while (robots.size() < 10) {
    const Vec2 place = random.in_box(8.0);
    Robot r = robot("r" + std::to_string(robots.size()), place, {goal()}, 0.1 * random.integer(2, 4));
    if (random.integer(1, 4) == 1) r.goals.push_back(goal());
    const bool is_free = std::none_of(robots.begin(), robots.end(), [&](const Robot& o) {
      return norm(o.position - place) <= o.radius + r.radius + 0.05;
    });
    if (is_free) robots.push_back(std::move(r));
  }
  return scenario_of(std::move(robots));
}

/// Every robot arrives, or its goal is taken, and by a robot whose goal leaves no room for both; and runs end.
TEST(CrowdEnds, RandomCrowdsWithTooFewGoalsComeToAnEnd) {
  std::size_t taken = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Scenario s = random_scenario(seed);
    const RunReport r = run_crowd(s, {});
    EXPECT_EQ(r.arrived + r.goal_taken.size(), s.robots.size()) << "seed " << seed;
    EXPECT_LT(r.time, s.time_limit) << "seed " << seed;
    taken += r.goal_taken.size();
    for (const RobotNotThere& t : r.goal_taken) {
      const Robot& other = s.robots[t.robot];
      const std::string before = ": ";  // "stays: r3 was first at ..."
      const std::size_t from = t.why.find(before) + before.size();
      const std::string first = t.why.substr(from, t.why.find(' ', from) - from);
      const auto taker = std::find_if(s.robots.begin(), s.robots.end(), [&](const Robot& o) { return o.id == first; });
      ASSERT_NE(taker, s.robots.end()) << t.why;
      EXPECT_LT(norm(taker->goals.back() - other.goals.back()), taker->radius + other.radius) << seed << ": " << t.why;
    }
  }
  EXPECT_GT(taken, 100U);
}

/// Before a car that has parked on its route a robot plans round it, on this engine as on the other.
TEST(CrowdRoutes, ACarThatParksOnARouteIsGoneRound) {
  struct Case {
    double scale;
    bool is_mirrored;
  };
  for (const auto& [scale, is_mirrored] : {Case{1.0, false}, Case{1.0, true}, Case{1000.0, false}, Case{0.01, false}}) {
    const auto at = [&, scale = scale, is_mirrored = is_mirrored](double x, double y) {
      return Vec2{scale * x, scale * (is_mirrored ? -y : y)};
    };
    Scenario s = scenario_of({robot("R1", at(0.0, 0.0), {at(10.0, 0.0)}, 0.3 * scale)});
    s.robots[0].max_speed = scale;
    s.arrival_tolerance *= scale;
    s.neighbour_distance *= scale;
    s.guidance = Guidance::route;
    MovingObstacle car;
    car.id = "car";
    car.shape = geometry::Polygon{{at(4.0, -6.0), at(6.0, -6.0), at(6.0, -2.0), at(4.0, -2.0)}, {}};
    car.motion.path = {at(0.0, 0.0), at(0.0, 4.0)};
    car.motion.speed = scale;
    s.moving_obstacles = {car};
    const RunReport r = run_crowd(s, {});
    EXPECT_EQ(r.arrived, 1U) << scale << is_mirrored;
    EXPECT_LT(r.time, 40.0);
    EXPECT_EQ(r.overlapping, 0U);
  }
}

/// A door that a car closes for good: the robot waits, the run ends and names the car.
TEST(CrowdRoutes, ACarThatParksInTheOnlyDoorIsNamed) {
  Scenario s = scenario_of({robot("R1", {-4.0, 0.0}, {{6.0, 0.0}})});
  s.guidance = Guidance::route;
  s.obstacles = {{"lower", geometry::Polyline{{{1.0, -9.0}, {1.0, -1.0}}}},
                 {"upper", geometry::Polyline{{{1.0, 1.0}, {1.0, 9.0}}}},
                 {"round", geometry::Polyline{{{1.0, 9.0}, {9.0, 9.0}, {9.0, -9.0}, {1.0, -9.0}}}}};
  MovingObstacle car;
  car.id = "car";
  car.shape = geometry::Polygon{{{1.5, -5.0}, {2.5, -5.0}, {2.5, -2.0}, {1.5, -2.0}}, {}};
  car.motion.path = {{0.0, 0.0}, {0.0, 3.4}};
  car.motion.speed = 2.0;
  s.moving_obstacles = {car};
  const RunReport r = run_crowd(s, {});
  EXPECT_EQ(r.arrived, 0U);
  ASSERT_EQ(r.route_cut.size(), 1U);
  EXPECT_EQ(r.route_cut[0].why, "waits: moving obstacle 'car' stands on its route, and none leads round it");
  EXPECT_LT(r.time, 60.0);
  // From every snapshot on the same.
  std::vector<std::string> kept;
  SimulationOptions options;
  options.snapshot_every = 10;
  options.keep_snapshot = [&](const std::string& bytes) { kept.push_back(bytes); };
  run_crowd(s, options);
  ASSERT_GT(kept.size(), 5U);
  for (const std::string& bytes : kept) {
    SimulationOptions again;
    again.resume_from = bytes;
    const RunReport resumed = run_crowd(s, again);
    EXPECT_EQ(resumed.digest, r.digest);
    EXPECT_EQ(resumed.steps, r.steps);
  }
}

/// With liveness off nothing but the pause before a parked car changes any more: the run must not end before it.
TEST(CrowdRoutes, ARunDoesNotStandStillWhileARobotStillLooksForAWayRoundACar) {
  Scenario s = scenario_of({robot("R1", {-20.0, 0.0}, {{6.0, 0.0}})});
  s.guidance = Guidance::route;
  s.liveness = Liveness::off;
  s.obstacles = {{"lower", geometry::Polyline{{{1.0, -9.0}, {1.0, -1.0}}}},
                 {"upper", geometry::Polyline{{{1.0, 1.0}, {1.0, 9.0}}}},
                 {"round", geometry::Polyline{{{1.0, 9.0}, {9.0, 9.0}, {9.0, -9.0}, {1.0, -9.0}}}}};
  MovingObstacle car;
  car.id = "car";
  car.shape = geometry::Polygon{{{1.5, -5.0}, {2.5, -5.0}, {2.5, -2.0}, {1.5, -2.0}}, {}};
  car.motion.path = {{0.0, 0.0}, {0.0, 3.4}};
  car.motion.speed = 2.0;
  s.moving_obstacles = {car};
  const RunReport r = run_crowd(s, {});
  EXPECT_FALSE(r.stands_still) << "the robot stays for good, and with that the run ends by itself";
  EXPECT_EQ(r.route_cut.size(), 1U);
  EXPECT_LT(r.time, 60.0);
}

/// The goal is under a parked car: rule R1 led the robot round the car until time ran out.
TEST(CrowdRoutes, ARobotWaitsBeforeACarThatParksOnItsGoal) {
  Scenario s = scenario_of({robot("R1", {0.0, 0.0}, {{10.0, 0.0}})});
  s.guidance = Guidance::route;
  MovingObstacle car;
  car.id = "car";
  car.shape = geometry::Polygon{{{9.0, -6.0}, {11.0, -6.0}, {11.0, -3.0}, {9.0, -3.0}}, {}};
  car.motion.path = {{0.0, 0.0}, {0.0, 4.5}};
  car.motion.speed = 2.0;
  s.moving_obstacles = {car};
  const RunReport r = run_crowd(s, {});
  EXPECT_EQ(r.arrived, 0U);
  ASSERT_EQ(r.route_cut.size(), 1U);
  EXPECT_LT(r.path_length, 15.0);
  EXPECT_LT(r.time, 60.0);
}

}  // namespace
}  // namespace exactvo::formation
