// SPDX-License-Identifier: GPL-3.0-or-later
// Goals that are too near to each other for all who have them, or in another robot's way.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "audited.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/stuck.h"
#include "liveness_scenes.h"
#include "steering/last_places.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using test_scenes::kTurn;
using test_scenes::robot;

/// They pushed each other off it, by nineteen plans, until the time limit: the first one drove 278 m.
TEST(TakenGoals, OneOfTwoRobotsWithOneGoalStaysWhereItIsOnceTheOtherIsThere) {
  Scenario s;
  s.robots = {robot("R1", {-5, 0}, {5, 0}), robot("R2", {-5, 3}, {5, 0})};
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  EXPECT_EQ(m.plans->groups, 0u);
  EXPECT_EQ(m.robots[0].arrived + m.robots[1].arrived, 1);
  for (const RobotMetrics& r : m.robots) EXPECT_LT(r.path_length, 15.0) << r.id;
  EXPECT_LT(run.steps.back().time, 10.0) << "no robot goes on";
  EXPECT_NE(m.outcome.find("R1 stays: R2 was first at the goal that both have"), std::string::npos) << m.outcome;
}

/// A robot that is far away when its rival arrives comes and stays beside it; the first one is not pushed off. The run
/// ended at once before, with R2 stopped where it was.
TEST(TakenGoals, ARobotWhoseGoalIsTakenComesBesideItAndStays) {
  for (const double apart : {0.0, 0.5}) {
    Scenario s;
    s.robots = {robot("R1", {3, 0}, {0, 0}), robot("R2", {20, 0}, {apart, 0})};
    const Recording run = simulate(s);
    const Metrics m = measure(s, run);
    EXPECT_TRUE(m.robots[0].arrived);
    const double gap = norm(run.steps.back().robots[0].position - run.steps.back().robots[1].position) - 1.0;
    EXPECT_LT(gap, 0.5) << apart;
    EXPECT_TRUE(audits_clean(s, run));
  }
}

/// The rival arrives while they go by a joint plan, which they drive to its end. The run ended there before, and the
/// audit refuted what it said of robots that stayed.
TEST(TakenGoals, ARobotThatGoesByPlanToATakenGoalDrivesOn) {
  Scenario s;
  s.robots = {robot("R1", {-5, 0}, {0, 0}), robot("R2", {5, 0}, {0, 0})};
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  EXPECT_EQ(m.robots[0].arrived + m.robots[1].arrived, 1);
  EXPECT_NE(m.outcome.find(" stays: "), std::string::npos) << m.outcome;
  EXPECT_TRUE(audits_clean(s, run));
}

/// R1 rests where R2 only passes: it makes way, and comes back.
TEST(TakenGoals, ARobotThatRestsOnTheGoalOfAnotherOnItsWayMakesWay) {
  Scenario s;
  s.robots = {robot("R1", {-5, 0}, {0, 0}), robot("R2", {5, 0}, {0, 5})};
  s.robots[1].goals = {{0, 0}, {0, 5}};
  const Recording run = simulate(s);
  EXPECT_EQ(measure(s, run).outcome, "all robots arrived");
  EXPECT_TRUE(audits_clean(s, run));
}

/// Six goals on a line, each too near to its neighbours: the first robot there keeps its own, and the others make room.
/// R4 stood 0.37 m from its goal for a minute, behind one that stayed as R4 was said to rest there.
TEST(TakenGoals, ARobotThatStaysBesideATakenGoalMakesRoomInIt) {
  for (const Liveness liveness : {Liveness::bias, Liveness::plan}) {
    Scenario s;
    s.time_limit = 60.0;
    for (int i = 0; i < 6; ++i)
      s.robots.push_back(
          robot("R" + std::to_string(i + 1), 6.0 * geometry::rotated({1.0, 0.0}, kTurn * i / 6.3), {0.6 * i, 0.0}));
    SimulationOptions options;
    options.liveness = liveness;
    const Recording run = simulate(s, options);
    const Metrics m = measure(s, run);
    const auto arrived = std::count_if(m.robots.begin(), m.robots.end(), [](const auto& r) { return r.arrived; });
    EXPECT_GE(arrived, liveness == Liveness::plan ? 2 : 1) << name(liveness) << ": " << m.outcome;
    for (const StuckReport& r : explain_stuck(s, run))
      EXPECT_EQ(r.text.find("out of reach"), std::string::npos) << r.text;
  }
}

/// R1 has no way to its goal and stays where that of R2 is: it makes way by plan.
TEST(TakenGoals, ARobotWithoutAWayToItsGoalMakesWayForOthers) {
  Scenario s;
  s.time_limit = 20.0;
  s.obstacles.push_back({"pen", geometry::Polyline{{{5, -1}, {7, -1}, {7, 1}, {5, 1}, {5, -1}}}});
  s.robots = {robot("R1", {-4, 0}, {6, 0}), robot("R2", {-8, 0}, {-4.2, 0})};
  const Recording run = simulate(s);
  const Metrics m = measure(s, run);
  EXPECT_FALSE(m.robots[0].arrived);
  EXPECT_TRUE(m.robots[1].arrived) << m.outcome;
  EXPECT_TRUE(audits_clean(s, run));
}

/// In a corridor that R1 fills, R2 comes no nearer than beside R1, which stays beside R0. R2 was not seen to be, since
/// it was looked for within the reach of small robots.
TEST(TakenGoals, ASmallRobotStaysBesideALargeOneThatStays) {
  Scenario s;
  s.time_limit = 60.0;
  for (const double y : {-2.7, 2.7}) test_scenes::add_wall(s, {{-4, y}, {30, y}});
  s.robots = {robot("R0", {1, 0}, {0, 0}), robot("R1", {6, 0}, {0, 0}), robot("R2", {14, 0}, {0, 0})};
  s.robots[1].radius = 2.5;
  s.robots[2].radius = 0.3;
  SimulationOptions options;
  options.liveness = Liveness::bias;
  const Recording run = simulate(s, options);
  const Metrics m = measure(s, run);
  EXPECT_NE(m.outcome.find("R2 stays: R0 was first at the goal that both have"), std::string::npos) << m.outcome;
  EXPECT_LT(run.steps.back().time, s.time_limit / 2);
  EXPECT_TRUE(audits_clean(s, run));
}

/// With radii of 0.5 m, a margin of 0.04 m and a tolerance of 0.1 m. Below 0.86 m one stays; from there on both stand
/// aside. Between 0.8 and 0.98 m most pairs pressed against each other until time ran out.
TEST(TakenGoals, GoalsNearerThanRadiiAndMarginAreBothReachedOrOneStays) {
  test::SeededRandom random(2207);
  for (const double apart : {0.79, 0.8, 0.83, 0.855, 0.861, 0.88, 0.92, 0.96, 1.0, 1.03, 1.05}) {
    for (int k = 0; k < 6; ++k) {
      Scenario s;
      s.time_limit = 60.0;
      for (const double x : {0.0, apart}) {
        const Vec2 from =
            random.uniform(6.0, 9.0) * geometry::rotated({1.0, 0.0}, random.uniform(0.0, 3.0) + (x > 0.0 ? 3.2 : 0.0));
        s.robots.push_back(robot(x > 0.0 ? "R2" : "R1", from, {x, 0}));
      }
      const Recording run = simulate(s);
      EXPECT_LT(run.steps.back().time, s.time_limit / 2) << apart;
      const Metrics m = measure(s, run);
      EXPECT_EQ(m.robots[0].arrived + m.robots[1].arrived, apart < 0.86 ? 1 : 2) << apart << " " << m.outcome;
      EXPECT_TRUE(audits_clean(s, run));
    }
  }
}

TEST(TakenGoals, LastPlacesAreWithinReachOfGoals) {
  test::SeededRandom random(2208);
  for (int k = 0; k < 50; ++k) {
    Scenario s;
    for (int i = 0; i < 12; ++i) s.robots.push_back(robot("R" + std::to_string(i), {}, random.in_box(2.0)));
    s.robots[1].goals = s.robots[0].goals;
    const std::vector<Vec2> places = detail::last_places(s, detail::room_at_ends(s));
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_LE(norm(places[i] - s.robots[i].goals.back()), 0.9 * s.arrival_tolerance + 1e-12);
  }
}

/// Cells as small as they are would be too many within the arrival tolerance and the margin.
TEST(TakenGoals, RobotsOfMicrometresAreNoMoreWork) {
  Scenario s;
  s.time_limit = 1.0;
  s.robots = {robot("R1", {0, 0}, {1e-4, 0}), robot("R2", {1, 0}, {1.5, 0})};
  for (Robot& r : s.robots) r.radius = 1e-6;
  EXPECT_EQ(detail::last_places(s, detail::room_at_ends(s)), (std::vector<Vec2>{{1e-4, 0}, {1.5, 0}}));
  const Recording run = simulate(s);
  EXPECT_TRUE(audits_clean(s, run));
}

TEST(TakenGoals, LastPlacesOfTwoLeaveRoomForBothWhereThereIsAny) {
  test::SeededRandom random(2209);
  for (int k = 0; k < 200; ++k) {
    Scenario s;
    const Vec2 goal = random.in_box(5.0);
    const double apart = random.uniform(0.7, 1.3);
    s.robots = {robot("R1", {}, goal), robot("R2", {}, goal + apart * random.direction())};
    const std::vector<Vec2> places = detail::last_places(s, detail::room_at_ends(s));
    const bool is_moved = places[0] != s.robots[0].goals[0] || places[1] != s.robots[1].goals[0];
    EXPECT_EQ(is_moved, apart > 0.86 && apart < 1.04) << apart;
    EXPECT_GE(norm(places[1] - places[0]), is_moved ? 1.04 - 1e-6 : 0.0) << apart;
  }
}

/// A goal on the way at which another robot rests: the audit proves that it was reached, so the robot presses for it.
TEST(TakenGoals, AGoalOnTheWayThatIsTakenIsReachedAllTheSame) {
  for (const Liveness liveness : {Liveness::bias, Liveness::plan}) {
    Scenario s;
    s.time_limit = 60.0;
    s.robots = {robot("R1", {-1, 0}, {0, 0}), robot("R2", {5, 0}, {0, 0})};
    s.robots[1].goals.push_back({0, 5});
    SimulationOptions options;
    options.liveness = liveness;
    const Recording run = simulate(s, options);
    EXPECT_LT(norm(run.steps.back().robots[1].position - Vec2{0, 5}), s.arrival_tolerance) << run.outcome;
    EXPECT_TRUE(audits_clean(s, run));
  }
}

/// Where robots go as near as they can to goals out of reach, those that find the place taken stay beside it. They
/// pushed each other off it until time ran out, and some were said to stay for one that had never been at its goal.
TEST(TakenGoals, ARobotWhoseNearestPlaceIsTakenStaysBesideIt) {
  for (const double apart : {0.0, 0.2}) {
    for (const Liveness liveness : {Liveness::bias, Liveness::plan}) {
      Scenario s;
      s.time_limit = 60.0;
      s.unreachable = Unreachable::nearest;
      test_scenes::add_wall(s, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}});
      s.robots = {robot("R1", {-6, 0}, {-0.3, 0}), robot("R2", {-8, 0}, {-0.3, apart}), robot("R3", {7, 0}, {0.4, 0})};
      SimulationOptions options;
      options.liveness = liveness;
      const Recording run = simulate(s, options);
      EXPECT_LT(run.steps.back().time, s.time_limit / 2) << run.outcome;
      const bool first_is_one = run.outcome.find("stays: R1 was first ") != std::string::npos;
      const std::string first = first_is_one ? "R1" : "R2", other = first_is_one ? "R2" : "R1";
      const std::string place = apart == 0.0 ? "at the nearest place that both can reach"
                                             : "where it stays, 0.2 m from where " + other + " was to come";
      EXPECT_NE(run.outcome.find("stays: " + first + " was first " + place), std::string::npos) << run.outcome;
      EXPECT_NE(run.outcome.find("R3 cannot reach its goal"), std::string::npos) << run.outcome;
      EXPECT_EQ(run.outcome.find("R3 stays"), std::string::npos) << run.outcome;
      for (const StuckReport& report : explain_stuck(s, run))
        EXPECT_NE(report.text.find("since its goal is out of reach"), std::string::npos) << report.text;
      EXPECT_TRUE(audits_clean(s, run));
    }
  }
}

}  // namespace
}  // namespace exactvo::formation
