// SPDX-License-Identifier: GPL-3.0-or-later
// Robots that follow proven routes: every goal is reached, or proven out of reach.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "audited.h"
#include "exactvo/datasets/generators.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/routes.h"
#include "liveness_scenes.h"
#include "steering/guide.h"
#include "steering/standing.h"
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

TEST(Guidance, DoesNotCreepThroughARowOfNarrowGates) {
  // Twelve gates of 1 m, staggered, for a robot of 0.9 m: at each it came to the very middle, ever more slowly.
  Scenario s = scene({Polyline{{{-2, -4}, {27, -4}, {27, 4}, {-2, 4}, {-2, -4}}}}, {0, 0}, {25, 0}, 0.45);
  for (int k = 0; k < 12; ++k) {
    const double x = 2.0 + 2.0 * k, y = k % 2 == 0 ? 0.6 : -0.6;
    s.obstacles.push_back({"low " + std::to_string(k), Polyline{{{x, -4}, {x, y - 0.5}}}});
    s.obstacles.push_back({"high " + std::to_string(k), Polyline{{{x, y + 0.5}, {x, 4}}}});
  }
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived);
  EXPECT_TRUE(is_safe(run.metrics));
  EXPECT_LT(run.metrics.last_arrival_time.value_or(1e9), 40.0) << "8.6 s at full speed";
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
    EXPECT_THAT(run.metrics.outcome, AllOf(HasSubstr("R cannot reach its goal: obstacles 'wall 1', 'wall 2' "),
                                           HasSubstr("enclose the goal, with a gap of"), Not(HasSubstr("no proof"))));
    EXPECT_THAT(run.metrics.stuck, testing::ElementsAre(HasSubstr("it stays, since its goal is out of reach")));
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
  EXPECT_THAT(guided(s).metrics.outcome, HasSubstr("the goal is nearer than the robot's radius to obstacle 'wall 3'"));
}

TEST(Guidance, AGoalTooNearToAWallIsReachedWithinItsTolerance) {
  Scenario s = door(2.0);
  s.robots[0].goals = {{5.55, 3}};  // a robot of 0.5 m can come within 0.05 m, which counts as arrived
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived) << run.metrics.outcome;
  EXPECT_TRUE(is_safe(run.metrics));
  s.robots[0].goals = {{5.55, 3}, {4, -3}, {4, 3}};  // on the way within its radius
  EXPECT_TRUE(guided(s).metrics.all_arrived);
}

TEST(Guidance, ThatNoPlaceWithinReachIsFreeIsProvenOrReportedAsUnproven) {
  Scenario s = door(2.0);
  for (const double depth : {5.601, 5.7, 6.5}) {  // the tolerance is 0.1 m: free places are at most at 5.5
    s.robots[0].goals = {{depth, 3}};
    EXPECT_THAT(guided(s).metrics.outcome, AllOf(HasSubstr("cannot reach"), Not(HasSubstr("no proof")))) << depth;
    EXPECT_THAT(warnings_before(s), testing::SizeIs(1)) << depth;
  }
  // A corner: what is free within reach is very small.
  s.robots[0].goals = {{5.5 + 0.0701, 5.5 + 0.0701}};
  EXPECT_TRUE(guided(s).metrics.all_arrived);
  s.robots[0].goals = {{5.5 + 0.0707, 5.5 + 0.0707}};
  EXPECT_THAT(guided(s).metrics.outcome, HasSubstr("no place within 0.1 m of it was found"));
}

/// A goal on the way counts within the robot's radius. From within a solid, that is proven too little.
TEST(Guidance, AGoalOnTheWayWithinASolidIsProvenOutOfReach) {
  Scenario s;
  s.robots.resize(1);
  s.robots[0] = {"R", {-5, 0}, {}, 0.8, 1.0, {{0, 0.2}, {5, 0}}};
  s.obstacles.push_back({"box", geometry::Polygon{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {}}});
  const std::string outcome = guided(s).metrics.outcome;
  EXPECT_THAT(outcome, testing::HasSubstr("R cannot reach its goal 1: the goal lies inside obstacle 'box'"));
  EXPECT_THAT(outcome, testing::Not(testing::HasSubstr("no proof")));
}

TEST(Guidance, ARobotThatStartsWithoutRoomMovesAwayAndArrives) {
  // Less than 2e-6 m: too little to plan a route from.
  for (const Method method : {Method::orca, Method::ivo_cluster, Method::ivo}) {
    for (const Vec2 start : {Vec2{-5.5 + 1e-7, 3}, Vec2{-5.5 + 5e-7, 5.5 - 1e-7}, Vec2{-0.5 - 1e-6, 3}}) {
      Scenario s = door(2.0);
      s.robots[0].position = start;
      const GuidedRun run = guided(s, method);
      EXPECT_TRUE(run.metrics.all_arrived) << name(method) << " " << start.x << ": " << run.metrics.outcome;
    }
  }
}

TEST(Guidance, IsWhatTheScenarioSaysUnlessTheOptionsDo) {
  Scenario s = door(2.0);
  SimulationOptions options;
  EXPECT_EQ(guidance_of(s, options), Guidance::route);
  s.guidance = Guidance::none;
  EXPECT_EQ(guidance_of(s, options), Guidance::none);
  options.guidance = Guidance::route;
  EXPECT_EQ(guidance_of(s, options), Guidance::route);
  options.method = Method::ivo_edge;
  EXPECT_EQ(guidance_of(s, options), Guidance::none);
}

TEST(Guidance, EveryGoalOnTheWayHasARouteOfItsOwn) {
  Scenario s = door(2.0);
  s.robots[0].goals = {{4, 3}, {-4, -3}, {4, -3}};
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived);
  EXPECT_EQ(run.recording.goal_bodies.size(), 3u);
}

TEST(Guidance, ARobotPushedOutOfSightOfItsRoutePlansAgain) {
  Scenario s = door(3.0);
  s.obstacles.push_back({"shelf", Polyline{{{-6, -3}, {-2, -3}}}});
  detail::Guide guide(s, 0.08);
  detail::CourseAnswer answer = guide.course(0.5, {-4, 3}, {{4, 3}, 0.1});
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
    const detail::Heading heading = guide.heading(course, 0.5, here);
    EXPECT_TRUE(is_clear(here, heading.place));
    EXPECT_FALSE(heading.is_new);
    EXPECT_EQ(course.points, before);
  }
  // Behind the shelf nothing of it is.
  const Vec2 behind{-5, -5};
  for (const Vec2 p : before) EXPECT_FALSE(is_clear(behind, p));
  const detail::Heading heading = guide.heading(course, 0.5, behind);
  EXPECT_TRUE(is_clear(behind, heading.place));
  EXPECT_TRUE(heading.is_new);
  EXPECT_EQ(course.points.front(), behind);
  EXPECT_EQ(course.points.back(), (Vec2{4, 3}));
  // Without room no route is planned: the robot moves away from the wall first.
  const std::vector<Vec2> again = course.points;
  EXPECT_GT(guide.heading(course, 0.5, {-5.6, 5}).place.x, -5.6);
  EXPECT_EQ(course.points, again);
}

// The way was measured by the last point in sight, and robots that drove away from that were taken for stalled.
TEST(Guidance, TheWayLeftBecomesShorterAlsoWhereTheNextPointIsHidden) {
  const Scenario s = scene({Polyline{{{60, -5}, {60, -0.7}}}}, {0, 0}, {100, 0}, 0.5);
  detail::Guide guide(s, 0.08);
  detail::Course course;
  course.points = {{0, 0}, {100, 0}};
  course.keeps = {0.6, 0.6};
  course.to = {{100, 0}, 0.1};
  double before = 200.0;
  for (const double x : {5.0, 10.0, 20.0, 30.0, 40.0, 50.0}) {
    const Vec2 here{x, -2.0};
    const detail::Heading heading = guide.heading(course, 0.5, here);
    ASSERT_FALSE(heading.is_new);
    ASSERT_EQ(course.next, 0u) << x;
    const double left = guide.way_left(course, here);
    EXPECT_LT(left, before - 4.0) << x;
    EXPECT_GE(left, norm(Vec2{100, 0} - here) * (1.0 - 1e-12)) << x;
    before = left;
  }
}

// On the map brc504d of Moving AI: the 34 m before a corner were halved to pieces of half a metre, and the robot went
// back to the last of them for ever, beside a piece whose end is hidden by micrometres.
TEST(Guidance, HeadsForNothingBehindItOnALongPiece) {
  const auto solid = [](std::vector<Vec2> vertices) { return geometry::Polygon{std::move(vertices), {}}; };
  Scenario s = scene({}, {224.31276594643947, 205.06648740593178}, {231, 170}, 0.23867846012971189);
  s.obstacles = {{"above", solid({{229, 171}, {235, 171}, {235, 180}, {229, 180}})},
                 {"below", solid({{229, 160}, {229, 169}, {228, 169}, {228, 160}})}};
  s.robots[0].max_speed = 1.5;
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.robots[0].arrived) << run.metrics.outcome;
  for (std::size_t k = 1; k < run.recording.steps.size(); ++k) {
    const Vec2 before = run.recording.steps[k - 1].robots[0].position, now = run.recording.steps[k].robots[0].position;
    EXPECT_LE(now.y, before.y) << k;
  }
}

TEST(Guidance, ARobotOnANarrowPieceIsNotSentBackToItsStart) {
  constexpr double kRadius = 0.5, kPlay = 2e-4;
  const Scenario s = scene({Polyline{{{11, -5}, {11, -kRadius - kPlay}}}, Polyline{{{11, kRadius + kPlay}, {11, 5}}}},
                           {0, 0}, {20, 0}, kRadius);
  detail::Guide guide(s, 0.08);
  detail::Course course;
  course.points = {{0, 0}, {10, 0}, {20, 0}};
  course.keeps = {0.58, 0.58, kRadius + 0.5 * kPlay};
  course.to = {{20, 0}, 0.1};
  course.next = 1;
  for (const double aside : {-9e-4, -5e-4, 5e-4, 9e-4}) {
    const Vec2 here{10.4, aside};
    const detail::Heading heading = guide.heading(course, kRadius, here);
    ASSERT_FALSE(heading.is_new);
    ASSERT_EQ(course.next, 1u) << "the end is in sight, and nothing is tried";
    EXPECT_GT(heading.place.x, here.x) << aside;
  }
  EXPECT_EQ(guide.heading(course, kRadius, {9.0, 0.3}).place, (Vec2{10, 0}));
}

TEST(Guidance, ARobotThatACartPushesOutOfSightOfItsRoutePlansAgainAndSaysSo) {
  // Down a shaft, and along the tunnel at its bottom.
  Scenario s =
      scene({Polyline{{{-1, 10}, {-1, -4}, {9, -4}}}, Polyline{{{1, 10}, {1, -2}, {9, -2}}}}, {0, 3}, {0, 9}, 0.4);
  s.time_limit = 16.0;
  s.moving_obstacles = {
      {"cart", geometry::Polygon{{{-1, 4}, {1, 6}, {1, 7}, {-1, 7}}, {}}, {{{0, 0}, {0, -8}, {6, -8}}, 1.0}}};
  const GuidedRun run = guided(s);
  std::size_t notes = 0;
  for (const Step& row : run.recording.steps)
    notes += row.robots[0].note.find("a new one is planned") != std::string::npos;
  EXPECT_GT(notes, 0u);
  EXPECT_EQ(notes, run.metrics.routes.value().pushed_off);
  EXPECT_EQ(run.metrics.routes->planned, 1u);
}

TEST(Guidance, AnEndWithoutMarginDoesNotTakeItFromTheWay) {
  const Scenario s = door(3.0);
  detail::Guide guide(s, 0.08);
  // 0.02 m of the start's margin are missing, and 0.03 m of the goal's.
  const Vec2 start{-5.44, 3}, goal{4, -5.45};
  const detail::Course course = *guide.course(0.5, start, {goal, 0.1}).course;
  EXPECT_EQ(course.points.front(), start);
  EXPECT_EQ(course.points.back(), goal);
  ASSERT_GT(course.points.size(), 3u);
  for (std::size_t k = 2; k + 1 < course.points.size(); ++k) EXPECT_GE(course.keeps[k], 0.58) << k;
  EXPECT_LT(course.keeps.back(), 0.51);
  Scenario run_of = s;
  run_of.robots[0].position = start;
  run_of.robots[0].goals = {goal};
  run_of.arrival_tolerance = 1e-3;
  const GuidedRun run = guided(run_of);
  EXPECT_TRUE(run.metrics.all_arrived) << run.metrics.outcome;
  int in_the_door = 0;
  for (const Step& row : run.recording.steps) {
    const Vec2 p = row.robots[0].position;
    if (std::fabs(p.x) > 2.0) continue;
    EXPECT_GT(geometry::signed_distance(s.obstacles[0].shape, p), 0.579);
    ++in_the_door;
  }
  EXPECT_GT(in_the_door, 10);
}

TEST(Guidance, WithoutObstaclesNoPlaceIsTooFar) {
  for (const Vec2 where : {Vec2{0, 0}, Vec2{1000, 1000}, Vec2{-1e8, 3}}) {
    Scenario s = scene({}, where, where + Vec2{5, 0});
    EXPECT_TRUE(guided(s).metrics.all_arrived) << where.x;
    s.robots.push_back(s.robots[0]);
    s.robots[1].id = "S";
    s.robots[1].position = where + Vec2{0, 3};
    s.robots[1].goals = {where + Vec2{5, 3}};
    EXPECT_TRUE(guided(s).metrics.all_arrived) << where.x;
  }
}

/// Once the cart rests at the end of its path.
TEST(Guidance, ARunWithAMovingObstacleEndsWhenThatRestsAndNoRobotGoesOn) {
  Scenario s;
  s.robots.resize(2);
  s.robots[0] = {"R", {-5, 0}, {}, 0.5, 1.0, {{0, 0}}};
  s.robots[1] = {"S", {-5, 4}, {}, 0.5, 1.0, {{5, 4}}};
  s.obstacles.push_back({"box", geometry::Polygon{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {}}});
  s.moving_obstacles.push_back(
      {"cart", geometry::Polygon{{{7, 7}, {8, 7}, {8, 8}, {7, 8}}, {}}, {{{7, 7}, {7, -13}}, 1.0}});
  const GuidedRun run = guided(s);
  EXPECT_THAT(run.metrics.outcome, testing::StartsWith("1 of 2 robots did not arrive; R cannot reach its goal: "));
  EXPECT_NEAR(run.recording.steps.back().time, 20.0, 1.0);
  EXPECT_TRUE(audits_clean(s, run.recording));
  Recording shorter = run.recording;
  shorter.steps.resize(shorter.steps.size() - 60);  // it ends while the cart moves
  EXPECT_FALSE(audits_clean(s, shorter));
}

TEST(Guidance, ARunEndsWhenNoRobotGoesOn) {
  Scenario s = door(0.5);
  s.time_limit = 1e5;
  const GuidedRun alone = guided(s);
  EXPECT_EQ(alone.recording.steps.size(), 2u) << "one decision, which `explain` speaks of";
  EXPECT_EQ(alone.recording.steps[0].robots[0].mode, Mode::staying);
  EXPECT_THAT(alone.metrics.outcome, testing::StartsWith("the robot did not arrive; R cannot reach its goal: "));
  s.robots.push_back(s.robots[0]);
  s.robots[1].id = "S";
  s.robots[1].position = {-4, -3};
  s.robots[1].goals = {{-2, -3}};
  const GuidedRun both = guided(s);
  EXPECT_GT(both.recording.steps.size(), 10u);
  EXPECT_THAT(both.metrics.outcome, testing::StartsWith("1 of 2 robots did not arrive; R cannot reach its goal: "));
}

// --- As near as can be ---

Scenario nearest(Scenario s) {
  s.unreachable = Unreachable::nearest;
  return s;
}

/// The robot's distance from its goal at the end.
double left_over(const Scenario& s, const GuidedRun& run) {
  return geometry::norm(run.recording.steps.back().robots[0].position - s.robots[0].goals.back());
}

/// The place by its Guide; and that one so much nearer to the goal is not free, or in another part.
detail::NearestPlace nearest_place(const Scenario& s) {
  detail::Guide guide(s, 0.08);
  const Robot& r = s.robots[0];
  const detail::CourseAnswer answer = guide.course(r.radius, r.position, {r.goals[0], 0.0});
  EXPECT_TRUE(answer.nearest) << answer.why_not;
  EXPECT_TRUE(answer.course);
  return answer.nearest.value_or(detail::NearestPlace{});
}

TEST(NearestPlace, LiesBeforeTheDoorThatIsTooNarrow) {
  // Before a gap of 0.6 m the centre of a disc of 0.5 m comes within sqrt(0.5^2 - 0.3^2) = 0.4 m of the middle.
  Scenario s = nearest(door(0.6));
  s.robots[0].goals = {{2, 0}};
  const detail::NearestPlace found = nearest_place(s);
  EXPECT_NEAR(found.place.x, -0.4, 1e-5);
  EXPECT_NEAR(found.place.y, 0.0, 1e-5);
  EXPECT_NEAR(found.distance, 2.4, 1e-5);
  EXPECT_NEAR(found.at_least, 2.2, 1e-5) << "2 m to the gap, and beyond it the radius less half of its width";
  const GuidedRun run = guided(s);
  EXPECT_FALSE(run.metrics.all_arrived);
  EXPECT_TRUE(is_safe(run.metrics));
  EXPECT_LE(left_over(s, run), 2.4 + 1e-5 + s.arrival_tolerance);
  EXPECT_LT(run.recording.steps.back().time, 60.0) << "it ends when no robot goes on";
  EXPECT_EQ((run.recording.steps.end() - 2)->robots[0].mode, Mode::staying);
  EXPECT_THAT(run.metrics.outcome, AllOf(HasSubstr("R cannot reach its goal: obstacles 'wall 1', 'wall 2'"),
                                         HasSubstr("and went as near as it can: it ends 2.4"),
                                         HasSubstr("the nearest place that it can reach is 2.4 m from it"),
                                         HasSubstr("(no place nearer than 2.2 m can be reached)")));
  EXPECT_EQ(run.recording.routes.value().nearest, 1u);
}

TEST(NearestPlace, OfAGoalInsideASolidLiesAtItsRim) {
  Scenario s = nearest(door(3.0));
  s.obstacles.push_back({"block", geometry::Polygon{{{2, 2}, {5, 2}, {5, 4}, {2, 4}}, {}}});
  s.robots[0].goals = {{2.3, 3.2}};
  const detail::NearestPlace found = nearest_place(s);
  EXPECT_NEAR(found.place.x, 1.5, 1e-5);
  EXPECT_NEAR(found.place.y, 3.2, 1e-5);
  EXPECT_NEAR(found.at_least, 0.8, 1e-5) << "proven: 0.3 m to the rim, and beyond it the radius";
}

TEST(NearestPlace, OfAGoalInACornerLiesWhereBothWallsAreOneRadiusAway) {
  Scenario s = nearest(door(3.0));
  s.robots[0].goals = {{5.9, 5.9}};
  const detail::NearestPlace found = nearest_place(s);
  EXPECT_NEAR(found.place.x, 5.5, 1e-5);
  EXPECT_NEAR(found.place.y, 5.5, 1e-5);
  EXPECT_GE(found.at_least, 0.4 - 1e-9);
}

TEST(NearestPlace, IsWhereTheRobotStandsIfItCannotGetNearer) {
  // The robot is in a closet; the goal is straight behind the wall of the closet.
  Scenario s = nearest(scene({Polyline{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}}}, {0.5, 0}, {9, 0}));
  s.robots[0].position.x = 0.5 - 3e-6;  // the room that a place needs
  const detail::NearestPlace found = nearest_place(s);
  EXPECT_NEAR(found.distance, 8.5, 1e-5);
  EXPECT_NEAR(found.at_least, 8.5 - 1e-5, 2e-5);
  EXPECT_EQ(guided(s).recording.steps.front().robots[0].mode, Mode::staying);
}

/// No free place that can be reached is nearer: by trying places on a lattice about the goal, with plans of the test's
/// own. And nothing contradicts the bound that is proven.
TEST(NearestPlace, NoneNearerIsFoundByALattice) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(74));
  std::size_t judged = 0;
  for (std::uint64_t item = 0; judged < 12; ++item) {
    ASSERT_LT(item, 500u);
    Scenario s = nearest(scene({}, {}, {}, random.uniform(0.3, 0.5)));
    for (SceneObstacle& o : datasets::generated_item(item % 2 == 0 ? "maze" : "block", item, 6))
      s.obstacles.push_back(o);
    geometry::Box box;
    std::vector<geometry::Obstacle> shapes;
    for (const SceneObstacle& o : s.obstacles) {
      shapes.push_back(o.shape);
      for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
    }
    const auto place = [&] {
      return Vec2{random.uniform(box.low.x, box.high.x), random.uniform(box.low.y, box.high.y)};
    };
    s.robots[0].position = place();
    s.robots[0].goals = {place()};
    const Robot& r = s.robots[0];
    const geometry::RoutePlan plan(geometry::RouteMap(shapes), r.radius);
    if (!validate(s).empty() || plan.is_reachable(r.position, r.goals[0])) continue;
    detail::Guide guide(s, 0.08);
    const detail::CourseAnswer answer = guide.course(r.radius, r.position, {r.goals[0], 0.0});
    if (answer.start_is_blocked) continue;
    ASSERT_TRUE(answer.nearest) << item << ": " << answer.why_not;
    ++judged;
    EXPECT_TRUE(plan.is_reachable(r.position, answer.nearest->place)) << item;
    EXPECT_LE(answer.nearest->at_least, answer.nearest->distance);
    constexpr int kHalf = 40;
    const double step = answer.nearest->distance / kHalf;
    for (int i = -kHalf; i <= kHalf; ++i)
      for (int k = -kHalf; k <= kHalf; ++k) {
        const Vec2 p = r.goals[0] + step * Vec2{static_cast<double>(i), static_cast<double>(k)};
        const double far = geometry::norm(p - r.goals[0]);
        if (far > answer.nearest->distance - 1e-5 || !plan.is_reachable(r.position, p)) continue;
        ADD_FAILURE() << item << ": " << far << " m, and " << answer.nearest->distance << " m was said";
        i = k = kHalf;
      }
  }
}

TEST(NearestPlace, OfAGoalOnTheWayIsTheRobotsLast) {
  Scenario s = nearest(door(0.6));
  s.robots[0].goals = {{4, 0}, {-4, -4}};
  const GuidedRun run = guided(s);
  EXPECT_THAT(run.metrics.outcome, HasSubstr("R cannot reach its goal 1: "));
  EXPECT_LE(geometry::norm(run.recording.steps.back().robots[0].position - Vec2{-0.4, 0}), s.arrival_tolerance + 1e-5);
}

TEST(Guidance, ARobotAtItsGoalNeedsNoRoute) {
  Scenario s = scene({Polyline{{{-1, 0.6}, {1, 0.6}}}}, {0, 0}, {0, 0.3});
  s.arrival_tolerance = 0.5;
  EXPECT_EQ(guided(s).metrics.outcome, "the robot arrived");
}

TEST(Guidance, AGoalOnTheWayThatIsPassedAndANextThatIsOutOfReachAreBothNoted) {
  Scenario s = door(2.0);
  s.robots[0].goals = {{4, 3}, {30, 30}};
  const GuidedRun run = guided(s);
  bool noted = false;
  for (const Step& step : run.recording.steps) {
    const std::string& note = step.robots[0].note;
    noted = noted || (note.find("goal 1 passed") != std::string::npos &&
                      note.find("cannot reach its goal 2") != std::string::npos);
  }
  EXPECT_TRUE(noted);
  EXPECT_THAT(run.metrics.outcome, HasSubstr("R cannot reach its goal 2: "));
}

// --- Moving obstacles that stand on a route ---

/// Two doors in a wall; a cart comes to stand in the first, 1.2 s before the robot would be there, and later goes on.
Scenario two_doors(double cart_leaves_after) {
  Scenario s = scene({Polyline{{{0, -8}, {0, -5}}}, Polyline{{{0, -3}, {0, 2}}}, Polyline{{{0, 4}, {0, 8}}},
                      Polyline{{{-9, -8}, {9, -8}, {9, 8}, {-9, 8}, {-9, -8}}}},
                     {-8, 3}, {8, 3});
  s.robots[0].max_speed = 1.0;
  s.time_limit = 100.0;
  MovingObstacle cart{"cart",
                      geometry::Polygon{{{-0.5, 7}, {0.5, 7}, {0.5, 7.8}, {-0.5, 7.8}}, {}},
                      {{{0, 0}, {0, -4}, {0, 0}}, 0.0, {{0, 2}, {2, 2}, {2, 0}}}};
  if (cart_leaves_after > 0.0) {
    cart.motion.profile.push_back({2 + cart_leaves_after, 0});
    cart.motion.profile.push_back({2 + cart_leaves_after, 2});
  }
  s.moving_obstacles = {cart};
  return s;
}

std::string notes_of(const GuidedRun& run) {
  std::string all;
  for (const Step& row : run.recording.steps)
    if (!row.robots[0].note.empty()) all += row.robots[0].note + "\n";
  return all;
}

TEST(CutRoutes, ARobotGoesRoundACartThatStandsOnItsRoute) {
  const Scenario s = two_doors(0.0);
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived) << run.metrics.outcome;
  EXPECT_TRUE(run.metrics.collisions.empty());
  EXPECT_EQ(run.metrics.routes.value().cut, 1u);
  EXPECT_THAT(notes_of(run), HasSubstr("moving obstacle 'cart' stands on its route: a new one leads round it"));
}

TEST(CutRoutes, WhatLeavesARouteGivesItBack) {
  const Scenario s = two_doors(2.5);
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived) << run.metrics.outcome;
  EXPECT_EQ(run.metrics.routes.value().cut, 2u);
  EXPECT_THAT(notes_of(run), HasSubstr("what it went round has moved: a new route is planned"));
  double lowest = 0.0;
  for (const Step& row : run.recording.steps) lowest = std::min(lowest, row.robots[0].position.y);
  EXPECT_GT(lowest, -3.0) << "it goes through the first door";
}

TEST(CutRoutes, WithoutAWayRoundItWaitsUntilTheCartGoesOn) {
  Scenario s = two_doors(20.0);
  s.obstacles.push_back({"second door", Polyline{{{0, -5}, {0, -3}}}});
  const GuidedRun run = guided(s);
  EXPECT_TRUE(run.metrics.all_arrived) << run.metrics.outcome;
  EXPECT_EQ(run.metrics.routes.value().cut, 0u);
  EXPECT_THAT(notes_of(run), HasSubstr("stands on its route: none leads round it, waits"));
  EXPECT_EQ(notes_of(run).find("waits"), notes_of(run).rfind("waits")) << "said once";
}

TEST(CutRoutes, WithoutAWayRoundWhatRestsForGoodItStaysAndTheRunEnds) {
  Scenario s = two_doors(0.0);
  s.obstacles.push_back({"second door", Polyline{{{0, -5}, {0, -3}}}});
  const GuidedRun run = guided(s);
  EXPECT_THAT(run.metrics.outcome,
              testing::StartsWith("the robot did not arrive; R waits: moving obstacle 'cart' stands on "
                                  "its route, and none leads round it"));
  EXPECT_LT(run.recording.steps.back().time, 20.0);
  const Step& decided = run.recording.steps[run.recording.steps.size() - 2];
  EXPECT_EQ(decided.robots[0].mode, Mode::staying);
  EXPECT_LT(geometry::norm(decided.robots[0].position - Vec2{0, 3}), 2.0) << "it has come up to the cart";
  EXPECT_TRUE(audits_clean(s, run.recording));
  Scenario other = s;  // the cart goes on much later: the run waits for it
  other.moving_obstacles = two_doors(60.0).moving_obstacles;
  EXPECT_TRUE(guided(other).metrics.all_arrived);
}

TEST(CutRoutes, AreTheSameInEveryRun) {
  const GuidedRun one = guided(two_doors(2.5)), other = guided(two_doors(2.5));
  ASSERT_EQ(one.recording.steps.size(), other.recording.steps.size());
  for (std::size_t k = 0; k < one.recording.steps.size(); ++k)
    EXPECT_EQ(one.recording.steps[k].robots[0].position, other.recording.steps[k].robots[0].position);
}

/// Only the last eight are kept beside those in use: a robot may go round a cart longer than that.
TEST(CutRoutes, AGuideRoundWhatStoodStaysValidAsLongAsItIsUsed) {
  const Scenario s = two_doors(0.0);
  detail::StandingObstacles standing(s, 0.08);
  double time = 0.0;
  const auto stands_at = [&](double y) {
    for (int k = 0; k < 2; ++k) standing.look(time += 2.0, {{{0, y}, {0, 0}}});
    return standing.detour().guide;
  };
  const std::shared_ptr<detail::Guide> used = stands_at(-4.0);
  const std::weak_ptr<detail::Guide> unused = stands_at(-3.5);
  EXPECT_EQ(stands_at(-4.0), used);
  const detail::Destination to{{8, 3}, 0.1};
  const detail::CourseAnswer before = used->course(0.5, {-8, 3}, to);
  ASSERT_TRUE(before.course);
  for (int k = 0; k < 9; ++k) stands_at(0.1 * k);
  EXPECT_TRUE(unused.expired());
  EXPECT_EQ(used->course(0.5, {-8, 3}, to).course.value().points, before.course->points);
}

/// The first scenario of README. R1 turned by 17 degrees for R2 behind the wall, and R2 crept before the desk, though
/// its route turns before it: it came after 5.4 s.
TEST(Guidance, RobotsGoStraightAlongTheirRoutesPastRobotsBehindWallsAndObstaclesBehindTurns) {
  for (const double mirror : {1.0, -1.0}) {
    Scenario s;
    const auto at = [&](double x, double y) { return Vec2{x, mirror * y}; };
    for (const auto& [id, from, to] :
         {std::tuple("R1", at(0, 0), at(12, 0)), std::tuple("R2", at(12, 0.5), at(0, 0.5))}) {
      Robot r;
      r.id = id;
      r.position = from;
      r.goals = {to};
      s.robots.push_back(r);
    }
    std::vector<Vec2> desk = {at(3, 3), at(5, 3), at(5, 4), at(3, 4)};
    if (mirror < 0.0) std::reverse(desk.begin(), desk.end());
    s.obstacles = {{"wall", Polyline{{at(6, -2), at(6, 2)}}}, {"desk", geometry::Polygon{desk, {}}}};
    const GuidedRun run = guided(s);
    ASSERT_TRUE(run.metrics.all_arrived);
    EXPECT_LT(run.metrics.robots[1].arrival_time.value(), 4.5);
    std::size_t hidden = 0;
    for (const Step& row : run.recording.steps) {
      const Vec2 a = row.robots[0].position, b = row.robots[1].position;
      const double crosses = a.y + (b.y - a.y) * (6.0 - a.x) / (b.x - a.x);
      const bool is_hidden = (a.x < 6.0) != (b.x < 6.0) && std::fabs(crosses) < 1.999;
      if (!is_hidden) break;
      ++hidden;
      for (const RobotStep& r : row.robots) EXPECT_LT(std::fabs(r.turned_right), 0.01) << row.time;
    }
    EXPECT_GT(hidden, 20U);
  }
}

TEST(Guidance, ARobotThatMustGiveWayToACartArrives) {
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
  for (std::uint64_t item = 0; reached < 6 || proven < 4; ++item) {
    ASSERT_LT(item, 500u);
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
    const bool arrived = run.metrics.all_arrived;  // maybe within its tolerance only
    EXPECT_TRUE(arrived || !reachable) << item << ": " << run.metrics.outcome;
    EXPECT_TRUE(is_safe(run.metrics)) << item;
    EXPECT_EQ(run.metrics.outcome.find("cannot reach") == std::string::npos, arrived) << item;
    ++(arrived ? reached : proven);
  }
}

}  // namespace
}  // namespace exactvo::formation
