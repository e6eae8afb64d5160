// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of a robot that did not arrive, against runs whose end is known.
#include "exactvo/formation/stuck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/formation/metrics.h"
#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Stuck, OrcaAtAFlatWallIsAStableTrap) {
  const Scenario s = test::paper_scene("A11");
  const std::vector<StuckReport> reports = explain_stuck(s, simulate(s, test::with_method(Method::orca)));
  ASSERT_EQ(reports.size(), 1u);
  ASSERT_TRUE(reports[0].equilibrium.has_value()) << reports[0].text;
  EXPECT_TRUE(reports[0].equilibrium->stable);
  EXPECT_NE(reports[0].text.find("stable trap"), std::string::npos) << reports[0].text;
}

TEST(Stuck, TheThinEllipseNamesItsCurvature) {
  const Scenario s = test::paper_scene("A11");
  SimulationOptions options = test::with_method(Method::ivo_edge);
  options.facade_fixed_minor = 0.1;
  const std::vector<StuckReport> reports = explain_stuck(s, simulate(s, options));
  ASSERT_EQ(reports.size(), 1u);
  ASSERT_TRUE(reports[0].equilibrium.has_value()) << reports[0].text;
  const Equilibrium& e = *reports[0].equilibrium;
  EXPECT_GT(e.radius_of_curvature, e.distance);
  EXPECT_TRUE(std::isfinite(e.radius_of_curvature));
}

TEST(Stuck, ARobotThatCirclesAnUnreachableGoalIsNotAtRest) {
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  s.robots.emplace_back();
  s.robots.front().id = "R1";
  s.robots.front().position = {0, 0};
  s.robots.front().goals = {{8, 0.3}};
  s.obstacles.push_back({"desk", geometry::Polygon{{{6, -2}, {10, -2}, {10, 2}, {6, 2}}, {}}});
  s.time_limit = 40.0;
  const Recording recording = simulate(s);
  const std::vector<StuckReport> reports = explain_stuck(s, recording);
  ASSERT_EQ(reports.size(), 1u);
  const StuckReport& r = reports.front();
  double nearest = r.goal_distance;
  for (const Step& step : recording.steps) {
    nearest = std::min(nearest, norm(step.robots[0].position - s.robots.front().goals.back()));
  }
  ASSERT_LT(nearest, r.goal_distance);
  char words[80];
  std::snprintf(words, sizeof words, " s, %.3g m away", nearest);
  EXPECT_NE(r.text.find("it was nearest at"), std::string::npos) << r.text;
  EXPECT_NE(r.text.find(words), std::string::npos) << r.text;
  EXPECT_EQ(r.text.find("at rest"), std::string::npos) << r.text;
}

TEST(Stuck, ARobotThatArrivedHasNoReport) {
  const Scenario s = test::paper_scene("A4");
  EXPECT_TRUE(explain_stuck(s, simulate(s)).empty());
}

// --- Recordings made by hand: what is said follows from what was recorded alone ---

constexpr double kStep = 0.05;   // s
constexpr double kEnd = 55.0;    // s
constexpr double kRadius = 0.5;  // m

/// A half-plane with the shape of its body.
struct OfShape : DecisionConstraint {
  geometry::ConvexShape shape;
};

struct End {
  Vec2 position;
  Vec2 goal;
  Vec2 velocity;
  Vec2 preferred;
  std::vector<OfShape> constraints;
  Mode mode = Mode::direct;
  lp::Status status = lp::Status::optimal;
  double violation = 0.0;
};

Scenario scene_of(const std::vector<End>& ends) {
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    Robot r;
    r.id = "R" + std::to_string(i + 1);
    r.position = ends[i].position;
    r.radius = kRadius;
    r.goals = {ends[i].goal};
    s.robots.push_back(r);
  }
  s.time_limit = kEnd;
  return s;
}

/// Every robot at one place with one velocity, from 0 s to the end.
Recording unchanged(const std::vector<End>& ends) {
  Recording r;
  r.time_step = kStep;
  Step row;
  for (const End& end : ends) {
    RobotStep step;
    step.position = step.anchor = end.position;
    step.velocity = step.anchor_velocity = step.chosen = end.velocity;
    step.preferred = end.preferred;
    for (OfShape c : end.constraints) {
      c.body = r.bodies.size();
      r.bodies.push_back({c.source, c.shape, {}, {c.index}});
      step.constraints.push_back(c);
    }
    step.mode = end.mode;
    step.status = end.status;
    step.violation = end.violation;
    row.robots.push_back(step);
  }
  for (const double time : {0.0, kEnd - kStep, kEnd}) {
    row.time = time;
    r.steps.push_back(row);
  }
  for (RobotStep& step : r.steps.back().robots) step.constraints.clear();
  return r;
}

OfShape constraint(ConstraintSource source, std::size_t index, geometry::ConvexShape shape, Vec2 normal,
                   double multiplier) {
  OfShape c;
  c.multiplier = multiplier;
  c.source = source;
  c.index = index;
  c.shape = std::move(shape);
  c.half_plane = {normal, 0.0};
  c.time_horizon = 2.0;
  c.hard = source == ConstraintSource::enclosure || source == ConstraintSource::obstacle_edge;
  c.active = true;
  return c;
}

std::string text_of(const Scenario& s, const Recording& recording, std::size_t robot = 0) {
  for (const StuckReport& r : explain_stuck(s, recording))
    if (r.robot == robot) return r.text;
  return "";
}

/// Two robots that face each other on the x axis, 1.04 m apart, and hardly move.
std::vector<End> head_on() {
  const Vec2 left{5.48, 0.0}, right{6.52, 0.0};
  const auto robot = [](std::size_t i, Vec2 at, double nx) {
    return constraint(ConstraintSource::robot, i, geometry::Disc{at, kRadius}, {nx, 0.0}, 3.0);
  };
  return {{left, {12, 0}, {1.5e-13, 0}, {3, 0}, {robot(1, right, -1.0)}},
          {right, {0, 0}, {-1.5e-13, 0}, {-3, 0}, {robot(0, left, 1.0)}}};
}

TEST(Stuck, RobotsThatStandHeadOnAreNotSlidingOffABoundary) {
  const auto ends = head_on();
  const auto reports = explain_stuck(scene_of(ends), unchanged(ends));
  ASSERT_EQ(reports.size(), 2u);
  for (const StuckReport& r : reports) {
    EXPECT_FALSE(r.equilibrium.has_value());
    EXPECT_DOUBLE_EQ(r.rest_time, kEnd);
    EXPECT_THAT(r.text, HasSubstr("at rest for 55 s (1.5e-13 m/s)"));
    EXPECT_THAT(r.text, HasSubstr(r.robot == 0
                                      ? "blocked by robot R2; R1 waits for R2, which waits for R1: a deadlock of two"
                                      : "blocked by robot R1; R2 waits for R1, which waits for R2: a deadlock of two"));
    for (const char* untrue : {"unstable", "sliding", "curvature", "trap"}) EXPECT_THAT(r.text, Not(HasSubstr(untrue)));
  }
}

TEST(Stuck, WhatTheRobotInTheWayDoesIsReported) {
  auto ends = head_on();
  ends[1].constraints.clear();
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("blocked by robot R2, which is at rest"));
  ends[1].goal = ends[1].position;
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("blocked by robot R2, which is at its goal"));
  ends[1].goal = {0, 0};
  ends[1].velocity = {0, 1};
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("blocked by robot R2, which is moving"));
}

/// A robot that creeps, as between a wall and another robot, waits like one at rest.
TEST(Stuck, ARobotThatCreepsAndWaitsNamesTheOneItWaitsFor) {
  auto ends = head_on();
  ends[0].velocity = {0.02, 0};
  ends[1].velocity = {-0.02, 0};
  const Scenario s = scene_of(ends);
  EXPECT_THAT(text_of(s, unchanged(ends)),
              HasSubstr("still moving when time ran out (0.02 m/s); its velocity is limited "
                        "by robot R2; R1 waits for R2, which waits for R1"));
  EXPECT_THAT(measure(s, unchanged(ends)).deadlock, testing::IsEmpty()) << "a robot that moves may get on";
  for (End& end : ends) end.velocity = 0.2 * end.velocity;
  EXPECT_THAT(measure(s, unchanged(ends)).deadlock, testing::ElementsAre("R1", "R2"));
  ends[0].goal = ends[0].position;
  EXPECT_THAT(measure(scene_of(ends), unchanged(ends)).deadlock, testing::IsEmpty())
      << "a robot at its goal waits for none";
}

/// Next to a wall, the robot that another one waits for was not named if it waits for none itself.
TEST(Stuck, ARobotHeldByAWallAndOneRobotNamesTheRobotItWaitsFor) {
  auto ends = head_on();
  const geometry::Segment wall{{0, -0.5}, {9, -0.5}};
  ends[0].constraints.push_back(constraint(ConstraintSource::obstacle_edge, 0, wall, {0, 1}, 1.0));
  ends[1].constraints.clear();
  ends[1].mode = Mode::arrived;
  Scenario s = scene_of(ends);
  s.obstacles = {{"wall", geometry::Polyline{{wall.a, wall.b}}}};
  EXPECT_THAT(text_of(s, unchanged(ends)), HasSubstr("; R1 waits for R2, which rests at its goal"));
}

/// A goal in which another robot rests is not out of reach, nor is a slot that an obstacle stands in.
TEST(Stuck, ARobotThatStaysSaysWhy) {
  auto ends = head_on();
  for (End& end : ends) end.constraints.clear();
  ends[0].mode = Mode::staying;
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("it stays, since its goal is out of reach"));
  ends[1].mode = Mode::arrived;
  ends[1].goal = ends[1].position;
  ends[0].goal = ends[1].goal + Vec2{0.3, 0.0};
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)),
              HasSubstr("it stays, since R2 was first at its goal, 0.3 m from that of R1"));
  ends[0].goal = ends[1].goal;
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)),
              HasSubstr("it stays, since R2 was first at the goal that both have"));
  ends[1].position += Vec2{9.0, 0.0};  // pushed far off its goal
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("it stays, since its goal is out of reach or taken"));
  ends[0].goal = ends[1].goal + Vec2{1.1, 0.0};
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), testing::Not(HasSubstr("taken")));
}

TEST(Stuck, ARobotThatGoesByAPlanSaysSo) {
  auto ends = head_on();
  ends.resize(1);
  ends[0].constraints.clear();
  ends[0].mode = Mode::by_plan;
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("no active constraint; it goes by a joint plan"));
}

/// Two robots whose leader has come to its end, 0.5 m and 3 m from their slots; they began in them.
struct BesideTheirSlots {
  Scenario scenario;
  Recording recording;

  explicit BesideTheirSlots(Vec2 velocity, Vec2 leader_velocity = {}) {
    const std::vector<End> ends{{{0.5, 0}, {}, {}, {}, {}, Mode::staying},
                                {{3, 4}, {}, velocity, {}, {}, Mode::staying}};
    scenario = scene_of(ends);
    scenario.formation.emplace().leader.path = {{0, 0}};
    recording = unchanged(ends);
    recording.offsets = {{0, 0}, {0, 4}};
    for (std::size_t i = 0; i < 2; ++i) recording.steps[0].robots[i].position = recording.offsets[i];
    for (Step& row : recording.steps) row.leader_velocity = leader_velocity;
    recording.diverged = has_diverged(recording);
  }
};

/// It was called diverged because its error had grown, and nothing was said of its robots.
TEST(Stuck, AFormationThatRestsBesideItsSlotsHasNotDiverged) {
  const BesideTheirSlots rests({});
  EXPECT_FALSE(rests.recording.diverged);
  const auto reports = explain_stuck(rests.scenario, rests.recording);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_THAT(reports[1].text, HasSubstr("R2 is 3 m from its slot, at (3.000, 4.000), at rest for "));
  EXPECT_THAT(reports[1].text, HasSubstr("it stays, since its slot cannot be filled"));
  EXPECT_TRUE(BesideTheirSlots({0.1, 0}).recording.diverged);
  EXPECT_TRUE(BesideTheirSlots({}, {1, 0}).recording.diverged);
}

TEST(Stuck, AMovingObstacleHasNoEquilibrium) {
  auto ends = head_on();
  ends.resize(1);
  ends[0].constraints[0].source = ConstraintSource::moving_obstacle;
  ends[0].constraints[0].index = 0;
  Scenario s = scene_of(ends);
  s.moving_obstacles = {{"cart", geometry::Polyline{{{6, -1}, {6, 1}}}, {{{0, 0}}, 0.0}}};
  Recording run = unchanged(ends);
  for (Step& row : run.steps) row.moving = {{}};
  const std::string text = text_of(s, run);
  EXPECT_THAT(text, HasSubstr("blocked by moving obstacle cart"));
  EXPECT_THAT(text, Not(HasSubstr("curvature")));
}

/// A robot at a round enclosure (radius 2) straight before its goal 8 m behind: an unstable equilibrium.
End at_a_round_enclosure(Vec2 velocity) {
  const geometry::Ellipse round = geometry::ellipse_from_axes({0, 0}, {2, 2, 0});
  return {{-2.5, 0.0},
          {8, 0},
          velocity,
          {3, velocity.y},
          {constraint(ConstraintSource::enclosure, 0, round, {-1, 0}, 3.0)}};
}

TEST(Stuck, OnlyARobotThatMovesIsSlidingOff) {
  const std::vector<End> standing{at_a_round_enclosure({0, 1e-9})}, moving{at_a_round_enclosure({0, 0.05})};
  const std::string rests = text_of(scene_of(standing), unchanged(standing));
  EXPECT_THAT(rests, HasSubstr("at rest for 55 s"));
  EXPECT_THAT(rests, HasSubstr("an unstable equilibrium"));
  EXPECT_THAT(rests, HasSubstr("less than the distance to the goal"));
  EXPECT_THAT(rests, Not(HasSubstr("sliding")));
  const std::string slides = text_of(scene_of(moving), unchanged(moving));
  EXPECT_THAT(slides, HasSubstr("still moving when time ran out (0.05 m/s)"));
  EXPECT_THAT(slides, HasSubstr("sliding off an unstable equilibrium"));
}

TEST(Stuck, FarFromABoundaryThereIsNoEquilibrium) {
  std::vector<End> ends{at_a_round_enclosure({1, 0})};
  ends[0].position.x = -4.0;
  const auto reports = explain_stuck(scene_of(ends), unchanged(ends));
  EXPECT_FALSE(reports.at(0).equilibrium.has_value());
  EXPECT_THAT(reports[0].text, HasSubstr("its velocity is limited by enclosure 0"));
}

TEST(Stuck, WhatIsActiveWithoutPushingBlocksNothing) {
  const geometry::Segment front{{1, -2}, {1, 2}}, beside{{-2, 0.5}, {1, 0.5}};
  const auto edge = [](std::size_t i, geometry::Segment s, Vec2 n, double multiplier) {
    return constraint(ConstraintSource::obstacle_edge, i, s, n, multiplier);
  };
  std::vector<End> ends{
      {{0.5, 0}, {8, 0}, {0, 0}, {3, 0}, {edge(1, beside, {0, -1}, 0.0), edge(0, front, {-1, 0}, 3.0)}}};
  Scenario s = scene_of(ends);
  s.obstacles = {{"front", geometry::Polyline{{front.a, front.b}}},
                 {"beside", geometry::Polyline{{beside.a, beside.b}}}};
  const auto reports = explain_stuck(s, unchanged(ends));
  EXPECT_THAT(reports.at(0).text, HasSubstr("blocked by the edge (1, -2)-(1, 2) of obstacle front: a stable trap"));
  EXPECT_THAT(reports[0].text, Not(HasSubstr("beside")));
  EXPECT_FALSE(reports[0].binding[0].pressing);
  EXPECT_TRUE(reports[0].binding[1].pressing);
  // The goal behind both: each of them is needed.
  ends[0].goal = {8, 8};
  ends[0].preferred = {2, 2};
  for (OfShape& c : ends[0].constraints) c.multiplier = 2.0;
  s.robots[0].goals = {ends[0].goal};
  EXPECT_THAT(text_of(s, unchanged(ends)),
              HasSubstr("blocked between the edge (-2, 0.5)-(1, 0.5) of obstacle beside and "
                        "the edge (1, -2)-(1, 2) of obstacle front"));
}

TEST(Stuck, WhatPushesTogetherWithTheSpeedBoundIsNamed) {
  // A formation's robot wants 5 m/s slantwise; the wall takes the normal part away and the disc of 3 m/s shortens the
  // rest: the push is no multiple of the wall's normal.
  std::vector<End> ends{
      {{0.5, 0},
       {8, 8},
       {0, 3},
       {3, 4},
       {constraint(ConstraintSource::obstacle_edge, 0, geometry::Segment{{1, -9}, {1, 9}}, {-1, 0}, 3)}}};
  Scenario s = scene_of(ends);
  s.obstacles = {{"wall", geometry::Polyline{{{1, -9}, {1, 9}}}}};
  Recording recording = unchanged(ends);
  for (Step& row : recording.steps) row.robots[0].bound = {{lp::kDisc, 1.0 / 3.0}};
  EXPECT_THAT(text_of(s, recording), HasSubstr("its velocity is limited by the edge (1, -9)-(1, 9) of obstacle wall"));
}

TEST(Stuck, ADecisionThatIsACompromiseSaysByHowMuch) {
  auto ends = head_on();
  ends[0].status = lp::Status::relaxed;
  ends[0].violation = 0.4;
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("the half-planes contradict each other by 0.4 m/s"));
}

TEST(Stuck, ARobotInContactSaysSo) {
  auto ends = head_on();
  ends[0].mode = Mode::pushing_out;
  EXPECT_THAT(text_of(scene_of(ends), unchanged(ends)), HasSubstr("in contact with an obstacle"));
}

TEST(Stuck, ARestThatBeganLateIsCountedFromThere) {
  auto ends = head_on();
  Recording r = unchanged(ends);
  r.steps[0].robots[0].velocity = {1, 0};
  EXPECT_NEAR(explain_stuck(scene_of(ends), r).at(0).rest_time, kStep, 1e-12);
  r.steps[2].robots[0].velocity = {1, 0};
  EXPECT_EQ(explain_stuck(scene_of(ends), r).at(0).rest_time, 0.0);
}

// --- Runs ---

Scenario one_robot(Vec2 goal) {
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  Robot r;
  r.id = "R1";
  r.goals = {goal};
  s.robots = {r};
  return s;
}

TEST(Stuck, ARobotInOpenSpaceRanOutOfTime) {
  Scenario s = one_robot({100, 0});
  s.time_limit = 2.0;
  EXPECT_THAT(text_of(s, simulate(s)), HasSubstr("still moving when time ran out (3 m/s); no active constraint"));
  s.time_limit = 120.0;
  SimulationOptions options;
  options.stop_at = 2.0;
  EXPECT_THAT(text_of(s, simulate(s, options)), HasSubstr("moving at 2.05 s (3 m/s); no active constraint"));
}

/// A U that opens towards the robot, wide enough to drive in: the ellipses of its corner overlap.
Scenario before_a_u() {
  Scenario s = one_robot({14, 0});
  s.obstacles = {
      {"U", geometry::Polygon{{{4, -4}, {10, -4}, {10, 4}, {4, 4}, {4, 3.5}, {9, 3.5}, {9, -3.5}, {4, -3.5}}, {}}}};
  s.time_limit = 40.0;
  return s;
}

TEST(Stuck, BetweenEnclosuresOfOneObstacle) {
  Scenario s = before_a_u();
  s.robots[0].goals = {{12, 6}};
  const auto reports = explain_stuck(s, simulate(s, test::with_method(Method::ivo_edge)));
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_THAT(reports[0].text, HasSubstr("at rest for"));
  EXPECT_THAT(reports[0].text, HasSubstr("blocked between enclosures 4 and 5 of obstacle U"));
}

}  // namespace
}  // namespace exactvo::formation
