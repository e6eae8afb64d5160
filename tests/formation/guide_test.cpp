// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that follow proven routes: every goal is reached, or proven out of reach.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/datasets/generators.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/routes.h"
#include "guide.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using geometry::Polyline;
using geometry::Vec2;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct GuidedRun {
  Recording recording;
  Metrics metrics;
};

GuidedRun guided(const Scenario& scenario, Method method = Method::ivo) {
  SimulationOptions options;
  options.method = method;
  options.guidance = Guidance::route;
  GuidedRun run;
  run.recording = simulate(scenario, options);
  run.metrics = measure(scenario, run.recording);
  return run;
}

Scenario scene(const std::vector<Polyline>& walls, Vec2 start, Vec2 goal, double radius = 0.5) {
  Scenario s;
  s.name = "scene";
  s.time_limit = 200.0;
  for (const Polyline& wall : walls) s.obstacles.push_back({"wall " + std::to_string(s.obstacles.size() + 1), wall});
  Robot r;
  r.id = "R";
  r.position = start;
  r.radius = radius;
  r.goals = {goal};
  s.robots = {r};
  return s;
}

/// Two walls end to end with a gap between them, and a frame round both sides.
Scenario door(double width, double radius = 0.5) {
  return scene({Polyline{{{0, -6}, {0, -width / 2}}}, Polyline{{{0, width / 2}, {0, 6}}},
                Polyline{{{-6, -6}, {6, -6}, {6, 6}, {-6, 6}, {-6, -6}}}},
               {-4, 3}, {4, 3}, radius);
}

TEST(Guidance, LeadsOutOfASpiral) {
  // Straight for the goal a robot runs into the innermost wall, and follows it round and round.
  const Scenario s =
      scene({Polyline{{{1, -1}, {1, 1}, {-2, 1}, {-2, -3}, {4, -3}, {4, 4}, {-5, 4}, {-5, -6}, {7, -6}, {7, 7}}}},
            {-0.4, -0.4}, {12, 0});
  for (const Method method : {Method::orca, Method::ivo_cluster, Method::ivo}) {
    const GuidedRun run = guided(s, method);
    EXPECT_TRUE(run.metrics.all_arrived) << name(method);
    EXPECT_TRUE(is_safe(run.metrics)) << name(method);
    EXPECT_EQ(run.recording.steps[1].robots[0].mode, Mode::guided);
  }
}

TEST(Guidance, PassesADoorThatLeavesLessThanTheMargin) {
  // The margin of 0.08 m on either side would need 1.16 m.
  for (const double width : {1.3, 1.16, 1.1, 1.01, 1.0001}) {
    const GuidedRun run = guided(door(width));
    EXPECT_TRUE(run.metrics.all_arrived) << width;
    EXPECT_TRUE(is_safe(run.metrics)) << width;
  }
}

TEST(Guidance, KeepsTheMarginWhereThereIsRoom) {
  const GuidedRun run = guided(door(3.0));
  EXPECT_TRUE(run.metrics.all_arrived);
  EXPECT_GT(run.metrics.min_obstacle_clearance.value(), 0.079);
}

TEST(Guidance, AGoalOutOfReachIsProvenSoAndTheRobotStays) {
  for (const double width : {0.5, 0.999, std::nextafter(1.0, 0.0)}) {
    const GuidedRun run = guided(door(width));
    EXPECT_FALSE(run.metrics.all_arrived);
    for (const Step& step : run.recording.steps) EXPECT_EQ(step.robots[0].position, (Vec2{-4, 3}));
    EXPECT_THAT(run.metrics.outcome, AllOf(HasSubstr("R cannot reach its goal: "), HasSubstr("1 gap separates"),
                                           HasSubstr("at wall 1 and wall 2")));
  }
}

TEST(Guidance, WhatFitsToTheLastMicrometreIsNotDriven) {
  const GuidedRun run = guided(door(1.0));
  EXPECT_FALSE(run.metrics.all_arrived);
  EXPECT_THAT(run.metrics.outcome, HasSubstr("too little to drive"));
}

TEST(Guidance, AnEndThatIsNotFreeIsNamed) {
  Scenario s = door(2.0);
  s.robots[0].goals = {{5.8, 3}};
  EXPECT_THAT(guided(s).metrics.outcome, HasSubstr("the goal is nearer than its radius to wall 3"));
}

TEST(Guidance, EveryGoalOnTheWayHasARouteOfItsOwn) {
  Scenario s = door(2.0);
  s.robots[0].goals = {{4, 3}, {-4, -3}, {4, -3}};
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived);
  EXPECT_EQ(run.recording.outlooks.size(), 3u);
}

TEST(Guidance, WhoWasPushedOutOfSightPlansAgain) {
  Scenario s = door(3.0);
  s.obstacles.push_back({"shelf", Polyline{{{-6, -3}, {-2, -3}}}});
  detail::Guide guide(s, 0.08);
  detail::CourseAnswer answer = guide.course(0.5, {-4, 3}, {4, 3});
  ASSERT_TRUE(answer.course) << answer.why_not;
  detail::Course course = *answer.course;
  const std::vector<Vec2> before = course.points;
  const auto is_clear = [&](Vec2 from, Vec2 to) {
    for (const SceneObstacle& o : s.obstacles)
      if (geometry::swept_distance(o.shape, {from, to}) < 0.5) return false;
    return true;
  };
  // In sight of the route it is kept, and the robot heads for what it sees.
  for (const Vec2 here : {Vec2{-4, 3}, Vec2{-3, 0}, Vec2{-1, 0.5}}) {
    EXPECT_TRUE(is_clear(here, guide.heading(course, 0.5, here)));
    EXPECT_EQ(course.points, before);
  }
  // Behind the shelf nothing of it is.
  const Vec2 behind{-5, -5};
  for (const Vec2 p : before) EXPECT_FALSE(is_clear(behind, p));
  EXPECT_TRUE(is_clear(behind, guide.heading(course, 0.5, behind)));
  EXPECT_EQ(course.points.front(), behind);
  EXPECT_EQ(course.points.back(), (Vec2{4, 3}));
  // In contact there is no route: the last heading stays.
  const std::vector<Vec2> again = course.points;
  guide.heading(course, 0.5, {-5.6, 5});
  EXPECT_EQ(course.points, again);
}

TEST(Guidance, ACourseThatIsPlannedAgainMayLeaveLessMargin) {
  Scenario s = door(3.0);
  s.obstacles.push_back({"shelf", Polyline{{{-6, -3}, {-2, -3}}}});
  detail::Guide guide(s, 0.08);
  detail::Course course = *guide.course(0.5, {-4, 3}, {4, 3}).course;
  EXPECT_NEAR(detail::Guide::margin_of(course, 0.5), 0.08, 1e-12);
  guide.heading(course, 0.5, {-5, -5.48});  // 0.52 m from the frame, out of sight of the course
  EXPECT_NEAR(detail::Guide::margin_of(course, 0.5), 0.02, 1e-5);
}

TEST(Guidance, AGoalOnTheWayThatIsPassedAndANextThatIsOutOfReachAreBothNoted) {
  Scenario s = door(2.0);
  s.robots[0].goals = {{4, 3}, {30, 30}};
  const GuidedRun run = guided(s);
  bool noted = false;
  for (const Step& step : run.recording.steps) {
    const std::string& note = step.robots[0].note;
    noted =
        noted || (note.find("goal 1 passed") != std::string::npos && note.find("out of reach") != std::string::npos);
  }
  EXPECT_TRUE(noted);
  EXPECT_THAT(run.metrics.outcome, HasSubstr("R cannot reach its goal"));
}

TEST(Guidance, WhoMustGiveWayToACartArrives) {
  Scenario s = door(3.0);
  s.moving_obstacles = {
      {"cart", geometry::Polygon{{{2, -1}, {4, -1}, {4, 1}, {2, 1}}, {}}, {{{0, 0}, {-1.5, 0}, {-1.5, -4}}, 1.0}}};
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived);
  EXPECT_TRUE(run.metrics.collisions.empty());
}

/// Starts and goals anywhere: what is not blocked at the start is reached, or there is no route by the library's word.
TEST(Guidance, ReachesWhatHasARouteAndNothingElseInMazes) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(73));
  std::size_t reached = 0, proven = 0;
  for (std::uint64_t item = 0; reached + proven < 12; ++item) {
    Scenario s = scene({}, {}, {}, random.uniform(0.15, 0.3));
    std::vector<geometry::Obstacle> shapes;
    geometry::Box box;
    for (SceneObstacle& o : datasets::generated_item("maze", item, 5)) {
      shapes.push_back(o.shape);
      for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
      s.obstacles.push_back(std::move(o));
    }
    const auto place = [&] {
      return Vec2{random.uniform(box.low.x, box.high.x), random.uniform(box.low.y, box.high.y)};
    };
    const geometry::RoutePlan plan(geometry::RouteMap(shapes), s.robots[0].radius);
    s.robots[0].position = place();
    s.robots[0].goals = {place()};
    if (!validate(s).empty()) continue;
    const GuidedRun run = guided(s);
    const bool reachable = plan.is_reachable(s.robots[0].position, s.robots[0].goals[0]);
    EXPECT_EQ(run.metrics.all_arrived, reachable) << item << ": " << run.metrics.outcome;
    EXPECT_TRUE(is_safe(run.metrics)) << item;
    EXPECT_EQ(run.metrics.outcome.find("cannot reach") == std::string::npos, reachable) << item;
    ++(reachable ? reached : proven);
  }
  EXPECT_GT(reached, 2u);
  EXPECT_GT(proven, 2u);
}

}  // namespace
}  // namespace exactvo::formation
