// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain/decision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "exactvo/formation/balance.h"
#include "exactvo/formation/constraint_name.h"
#include "figures/velocity_space.h"

namespace exactvo::tools {
namespace {

using formation::ConstraintSource;
using formation::DecisionConstraint;
using testing::HasSubstr;

/// kDirections of explanation.cpp on shapes of a few metres.
constexpr double kSampled = 1e-5;

Decision with_two_walls() {
  Decision d;
  d.scenario.name = "corner";
  d.scenario.robots = {{"R1", {0.0, 0.0}, {0.0, 0.0}, 0.5, 3.0, {{5.0, 5.0}}}};
  d.scenario.obstacles = {{"east", geometry::Polyline{{{1.5, -2.0}, {1.5, 2.0}}}},
                          {"north", geometry::Polyline{{{-2.0, 1.5}, {2.0, 1.5}}}}};
  d.method = "method orca";
  d.step.preferred = {2.0, 1.0};
  d.step.chosen = {0.5, 0.5};
  const auto wall = [&](geometry::Segment s, std::size_t index, geometry::HalfPlane h, double multiplier) {
    d.bodies.push_back({ConstraintSource::obstacle_edge, s, {}, {index}});
    DecisionConstraint c;
    c.body = index;
    c.multiplier = multiplier;
    c.index = index;
    c.source = ConstraintSource::obstacle_edge;
    c.half_plane = h;
    d.seen.push_back({s, {0.0, 0.0}, 0.5, {}});
    c.time_horizon = 2.0;
    c.active = true;
    return c;
  };
  d.step.constraints = {wall({{1.5, -2.0}, {1.5, 2.0}}, 0, {{-1.0, 0.0}, -0.5}, 1.5),
                        wall({{-2.0, 1.5}, {2.0, 1.5}}, 1, {{0.0, -1.0}, -0.5}, 0.5)};
  return d;
}

TEST(Decision, BalanceIsTheSumOfPushesOfWhatBinds) {
  const formation::Balance b = balance_of(with_two_walls().step);
  ASSERT_EQ(b.forces.size(), 2u);
  EXPECT_EQ(b.forces[0].constraint, 0u);
  EXPECT_DOUBLE_EQ(b.forces[0].factor, 1.5);
  EXPECT_EQ(b.forces[1].constraint, 1u);
  EXPECT_DOUBLE_EQ(b.forces[1].factor, 0.5);
  EXPECT_NEAR(b.remainder, 0.0, 1e-15);
}

TEST(Decision, BalanceFindsTheSpeedBound) {
  Decision d = with_two_walls();
  d.step.constraints.clear();
  d.step.preferred = {0.0, 5.0};
  d.step.chosen = {0.0, 3.0};
  d.step.bound = {{lp::kDisc, 2.0 / 3.0}};
  const formation::Balance b = balance_of(d.step);
  ASSERT_EQ(b.forces.size(), 1u);
  EXPECT_FALSE(b.forces[0].constraint.has_value());
  EXPECT_DOUBLE_EQ(b.forces[0].factor, 2.0);
}

TEST(Decision, BalanceOwnsUpWhereNothingExplainsTheChoice) {
  Decision d = with_two_walls();
  for (auto& c : d.step.constraints) c.active = false;
  EXPECT_GT(balance_of(d.step).remainder, 1.0);
}

TEST(Decision, BalanceHasTheSidesOfABoxAndConstraintsOfAnyLength) {
  Decision d = with_two_walls();
  d.step.preferred = {2.0, 5.0};
  d.step.chosen = {0.5, 3.0};
  d.step.constraints.pop_back();
  d.step.constraints[0].half_plane = {{-0.5, 0.0}, -0.25};
  d.step.constraints[0].multiplier = 3.0;
  d.step.bound = {{{lp::BindingKind::box_top, 0}, 2.0}};
  const formation::Balance b = balance_of(d.step);
  ASSERT_EQ(b.forces.size(), 2u);
  EXPECT_DOUBLE_EQ(b.factor_of(0), 1.5);
  EXPECT_EQ(b.forces[1].normal, (geometry::Vec2{0.0, -1.0}));
  EXPECT_NEAR(b.remainder, 0.0, 1e-15);
}

TEST(Decision, DistanceAndTimeToContact) {
  const geometry::GrownShape disc{geometry::Disc{{5.0, 0.0}, 1.0}, {0.0, 0.0}, 0.5};
  EXPECT_NEAR(distance_to(disc), 3.5, kSampled);
  ASSERT_TRUE(time_to_contact(disc, {2.0, 0.0}).has_value());
  EXPECT_NEAR(*time_to_contact(disc, {2.0, 0.0}), 1.75, kSampled);
  EXPECT_FALSE(time_to_contact(disc, {-2.0, 0.0}).has_value());
  EXPECT_FALSE(time_to_contact(disc, {1.0, 1.0}).has_value());
  EXPECT_FALSE(time_to_contact(disc, {0.0, 0.0}).has_value());
}

TEST(Decision, NamesWhatAConstraintStandsFor) {
  const Decision d = with_two_walls();
  EXPECT_EQ(formation::name_of(d.step.constraints[0], d.scenario, d.bodies),
            "the edge (1.5, -2)-(1.5, 2) of obstacle east");
  DecisionConstraint enclosure = d.step.constraints[0];
  enclosure.source = ConstraintSource::enclosure;
  enclosure.body = 1;
  EXPECT_EQ(formation::name_of(enclosure, d.scenario, d.bodies), "enclosure 0 of obstacle north");
  DecisionConstraint robot = d.step.constraints[0];
  robot.source = ConstraintSource::robot;
  EXPECT_EQ(formation::name_of(robot, d.scenario, d.bodies), "acceleration of robot R1");
  EXPECT_EQ(formation::name_of(std::vector{robot, robot}, d.scenario, d.bodies), "acceleration of robot R1");
  robot.hard = false;
  EXPECT_EQ(formation::name_of(robot, d.scenario, d.bodies), "robot R1");
}

TEST(Explanation, NamesBindingConstraintsAndTheirPush) {
  const std::string words = explanation(with_two_walls());
  EXPECT_THAT(words, HasSubstr("2 half-planes: 2 binding (the chosen velocity lies on their lines)"));
  EXPECT_THAT(words, HasSubstr("1.50 n[1] + 0.50 n[2]"));
  EXPECT_THAT(words, HasSubstr("1.00 m from the robot's rim, reached in 0.50 s"));
}

/// A cart drives at the robot: the half-planes of both, soft, contradict each other, and the velocity that violates
/// them least lies 2.85 m/s on the forbidden side.
Decision before_a_cart() {
  Decision d = with_two_walls();
  d.scenario.moving_obstacles = {{"cart", geometry::Polyline{{{2.0, -1.0}, {2.0, 1.0}}}, {{{0, 0}, {-8, 0}}, 4.0}}};
  DecisionConstraint cart = d.step.constraints[0];
  cart.source = ConstraintSource::moving_obstacle;
  cart.index = 0;
  cart.hard = false;
  cart.half_plane = {{-1.0, 0.0}, 3.35};
  DecisionConstraint satisfied = d.step.constraints[1];
  satisfied.active = false;
  d.step.constraints = {cart, satisfied};
  d.step.chosen = {-0.5, 0.0};
  d.step.status = lp::Status::relaxed;
  d.step.violation = 2.85;
  return d;
}

TEST(Explanation, AViolatedLineIsNotCalledBinding) {
  const std::string words = explanation(before_a_cart());
  EXPECT_THAT(words, HasSubstr("2 half-planes: 0 binding, 1 violated"));
  EXPECT_THAT(words, HasSubstr("[1] moving obstacle cart, violated by 2.85 m/s"));
  EXPECT_THAT(words, HasSubstr("[2] the edge (-2, 1.5)-(2, 1.5) of obstacle north, slack"));
  EXPECT_THAT(words, testing::Not(HasSubstr("lies on")));
}

// A half-plane that a compromise violates by less than the greatest violation is no active one of the linear program.
TEST(Explanation, WhatIsViolatedByLessThanTheMostIsViolatedAndNotSlack) {
  Decision d = before_a_cart();
  d.step.constraints[0].active = true;
  d.step.constraints[1].half_plane.offset = 0.4;  // v_y <= -0.4
  EXPECT_THAT(explanation(d), HasSubstr("[2] the edge (-2, 1.5)-(2, 1.5) of obstacle north, violated by 0.40 m/s"));
  EXPECT_THAT(explanation(d), HasSubstr("has the least greatest violation, that of [1]; [2] is violated by less.\n"));
  EXPECT_THAT(velocity_space_figure(d).body, testing::Not(HasSubstr("half-plane, slack")));
  d.step.constraints[1].half_plane.offset = 0.0004;
  EXPECT_THAT(explanation(d), HasSubstr("of obstacle north, violated by 0.0004 m/s"));
}

TEST(Explanation, NamesTheRobotsThatARobotWaitsForAndThePairsThatFellBack) {
  Decision d = with_two_walls();
  EXPECT_THAT(explanation(d), testing::Not(testing::AnyOf(HasSubstr("waiting"), HasSubstr("ell back"))));
  d.waiting = "R1 waits for R2, which moves";
  d.step.constraints[1].source = ConstraintSource::robot;
  d.step.constraints[1].hard = false;
  d.step.constraints[1].index = 0;
  d.step.constraints[1].time_horizon = 0.1;
  d.step.constraints[1].fell_back = true;
  EXPECT_THAT(explanation(d), HasSubstr("  waiting    R1 waits for R2, which moves\n"));
  EXPECT_THAT(explanation(d), HasSubstr("[2] robot R1 (the pair fell back), binding"));
  EXPECT_THAT(explanation(d), HasSubstr("looking 0.1 s ahead"));
}

TEST(Explanation, TheSourceOfWhatIsViolatedIsNamed) {
  const std::string words = explanation(before_a_cart());
  EXPECT_THAT(words, HasSubstr("violated by at most 2.85 m/s, the least possible: moving obstacle cart\n"));
  EXPECT_THAT(words, testing::Not(HasSubstr("robots")));
}

TEST(VelocitySpace, DrawsEveryLayerOnce) {
  const Figure figure = velocity_space_figure(with_two_walls());
  for (const char* layer : {"allowed velocities", "velocity obstacle of an obstacle", "its legs", "its cut-off",
                            "half-plane, binding", "speed bound", "preferred velocity", "chosen velocity"}) {
    EXPECT_THAT(figure.body, HasSubstr(std::string("title '") + (layer[0] == 'i' ? "  " : "") + layer)) << layer;
  }
  EXPECT_THAT(figure.body, HasSubstr("set size ratio -1"));
  EXPECT_THAT(figure.data, testing::Not(HasSubstr("nan")));
}

/// A small acceleration: its sides are drawn as far as they bound what a step can reach, and the rim of that above all.
TEST(VelocitySpace, OwnLimitsAreAPolygonAndTheRimOfWhatIsAllowedLiesOnTop) {
  Decision d = with_two_walls();
  d.scenario.acceleration = formation::Acceleration{0.5};
  d.step.velocity = d.step.chosen;
  const std::vector<geometry::HalfPlane> limits = formation::own_limits(d.scenario, d.step, 0);
  ASSERT_GT(limits.size(), 4U);
  for (const geometry::HalfPlane& h : limits) {
    DecisionConstraint own = d.step.constraints[0];
    own.source = ConstraintSource::robot;
    own.index = 0;
    own.active = false;
    own.half_plane = h;
    d.step.constraints.push_back(own);
    d.seen.push_back(d.seen[0]);
  }
  const Figure figure = velocity_space_figure(d);
  EXPECT_THAT(figure.body, HasSubstr("title 'its own limits'"));
  EXPECT_THAT(figure.body, testing::Not(HasSubstr("half-plane, slack")));
  const std::size_t rim = figure.data.find("rim of the allowed velocities");
  ASSERT_NE(rim, std::string::npos);
  for (const char* below :
       {"the robot's own limits: boundaries", "half-plane, binding: boundaries", "chosen velocity: tip"})
    EXPECT_LT(figure.data.find(below), rim) << below;
  const std::size_t from = figure.data.find("the robot's own limits: boundaries");
  ASSERT_NE(from, std::string::npos);
  std::istringstream lines(figure.data.substr(from));
  std::string heading;
  std::getline(lines, heading);
  std::getline(lines, heading);
  std::size_t judged = 0;
  for (double x = 0.0, y = 0.0; lines >> x >> y; ++judged)
    EXPECT_LT(geometry::norm(geometry::Vec2{x, y} - d.step.velocity), 0.1) << "a side runs on beyond the polygon";
  EXPECT_GE(judged, 8U);
}

TEST(VelocitySpace, SaysWhereHalfPlanesWereNotRecorded) {
  Decision d = with_two_walls();
  EXPECT_THAT(velocity_space_figure(d).body, HasSubstr("title 'allowed velocities'"));
  EXPECT_THAT(velocity_space_figure(d).body, testing::Not(HasSubstr("Others may forbid more")));
  d.has_all_half_planes = false;
  EXPECT_THAT(velocity_space_figure(d).body, HasSubstr("title 'allowed by the half-planes recorded'"));
  EXPECT_THAT(velocity_space_figure(d).body, HasSubstr("Others may forbid more.'\n"));
}

/// What an acceleration forbids is forbidden in the figure too, whether its half-planes were recorded or not.
TEST(VelocitySpace, AllowedVelocitiesAreWithinTheAcceleration) {
  Decision d = with_two_walls();
  d.step.velocity = {-1.0, 0.5};
  const auto most_from_velocity = [&] {
    std::istringstream rows(velocity_space_figure(d).data);
    std::string line;
    double most = 0.0;
    bool is_allowed = false;
    while (std::getline(rows, line)) {
      if (line.rfind("#", 0) == 0)
        is_allowed = line.find("allowed velocities") != std::string::npos ||
                     (is_allowed && line.find("v_x") != std::string::npos);
      geometry::Vec2 v;
      std::istringstream numbers(line);
      if (is_allowed && numbers >> v.x >> v.y) most = std::max(most, norm(v - d.step.velocity));
    }
    return most;
  };
  EXPECT_GT(most_from_velocity(), 2.0);
  d.scenario.acceleration = formation::Acceleration{2.0};
  d.scenario.time_step = 0.1;
  EXPECT_NEAR(most_from_velocity(), 0.2, 1e-8);  // nine digits
  d.scenario.acceleration.reset();
  d.step.own_stage = formation::OwnStage::held;
  d.step.own = {{{{-1.0, 0.0}, 0.9}, true}};
  EXPECT_LT(most_from_velocity(), 3.5) << "half-planes of a user that hold";
}

// What the robot overlaps has no cone; its shape stood in the legend without the heading that it belongs to.
TEST(VelocitySpace, WhatIsOverlappedHasNoShapeInTheLegend) {
  Decision d = with_two_walls();
  for (formation::SeenBody& seen : d.seen) seen.radius = 2.0;
  EXPECT_THAT(velocity_space_figure(d).body, testing::Not(HasSubstr("its shape")));
}

// Inside an obstacle: all that was seen was forbidden, and no line said by what.
TEST(VelocitySpace, ShowsALineThatIsViolatedByFar) {
  Decision d = before_a_cart();
  d.step.constraints.pop_back();
  d.step.constraints[0].active = true;
  const auto has_line = [&] { return velocity_space_figure(d).body.find("half-plane, violated") != std::string::npos; };
  EXPECT_TRUE(has_line());
  d.step.constraints[0].half_plane.offset = 15.0;
  EXPECT_TRUE(has_line());
  d.step.constraints[0].half_plane.offset = 1e6;  // all else would be a dot beside it
  EXPECT_FALSE(has_line());
}

TEST(Decision, NamesAtMostThreeObstacles) {
  Decision d = with_two_walls();
  for (const char* id : {"a", "b", "c"})
    d.scenario.obstacles.push_back({id, geometry::Polyline{{{0.0, 1.5}, {0.0, 1.6}}}});
  DecisionConstraint all = d.step.constraints[0];
  all.source = ConstraintSource::enclosure;
  d.bodies[0].owners = {0, 1, 2, 3, 4};
  EXPECT_EQ(formation::name_of(all, d.scenario, d.bodies), "enclosure 0 of obstacles east, north, a and 2 more");
  d.bodies[0].owners = {0, 1};
  EXPECT_EQ(formation::name_of(all, d.scenario, d.bodies), "enclosure 0 of obstacles east and north");
}

TEST(Explanation, SaysThatBoostHadTurnedWhatIsAllowedAsItStands) {
  Decision d = with_two_walls();
  d.step.chosen = d.step.preferred = {0.5, 0.2};
  d.step.mode = formation::Mode::boost;
  d.step.constraints[1].active = false;
  const std::string words = explanation(d);
  EXPECT_THAT(words, HasSubstr("boost turned"));
  EXPECT_THAT(words, HasSubstr("lies on the line of [1]"));
  EXPECT_THAT(words, testing::Not(HasSubstr("no constraint forbids")));
}

TEST(Explanation, ARobotThatStaysHasAReason) {
  Decision d = with_two_walls();
  d.step.mode = formation::Mode::staying;
  EXPECT_THAT(explanation(d), HasSubstr("the robot stays, since its goal is out of reach or taken.\n"));
  d.scenario.formation.emplace();
  EXPECT_THAT(explanation(d), HasSubstr("the robot stays, since its slot cannot be filled.\n"));
}

TEST(Explanation, ABindingLineThatTheChosenVelocityLiesOnIsNotCalledMissed) {
  Decision d = with_two_walls();
  d.step.chosen = d.step.preferred = {0.5, 1.2};  // past the end of the wall, 0.1 m beside the robot's rim
  d.step.mode = formation::Mode::boost;
  d.step.constraints.pop_back();
  d.step.constraints[0].multiplier = 0.0;
  const std::string words = explanation(d);
  EXPECT_THAT(words,
              HasSubstr("[1] the edge (1.5, -2)-(1.5, 2) of obstacle east, binding: 1.00 m from the robot's rim, "
                        "passed closely at the chosen velocity"));
  EXPECT_THAT(words, testing::Not(HasSubstr("missed")));
}

}  // namespace
}  // namespace exactvo::tools
