// SPDX-License-Identifier: GPL-3.0-or-later
// Robots of a formation that block each other's slots: they go by joint plans once the leader rests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "exactvo/datasets/audit.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/stuck.h"
#include "exactvo/formation/waiting.h"
#include "liveness_scenes.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using test_scenes::at_slots;
using testing::ElementsAre;

struct SlotRun {
  Scenario scenario;
  Recording recording;
  Metrics metrics;

  bool is_formed() const { return metrics.formation_course && metrics.formation_course->formed_since.has_value(); }
  std::size_t not_optimal() const {
    std::size_t count = 0;
    for (const Step& row : recording.steps)
      for (const RobotStep& r : row.robots) count += r.status != lp::Status::optimal;
    return count;
  }
};

SlotRun run(Scenario s, const SimulationOptions& options = {}) {
  SlotRun r{std::move(s), {}, {}};
  r.recording = simulate(r.scenario, options);
  r.metrics = measure(r.scenario, r.recording);
  return r;
}

datasets::AuditReport audited(const SlotRun& r) {
  const SimulationOptions options;
  datasets::RunInfo info{r.scenario.name, name(options.method), name(options.controller), name(options.integrator), {},
                         std::nullopt,    name(Liveness::plan)};
  return datasets::audit({std::move(info), r.scenario, r.recording});
}

SimulationOptions without_plans() {
  SimulationOptions options;
  options.liveness = Liveness::off;
  return options;
}

Scenario limited(Scenario s, double time_limit) {
  s.time_limit = time_limit;
  return s;
}

void expect_formed(const std::string& what, Scenario s) {
  SCOPED_TRACE(what);
  const SlotRun r = run(limited(std::move(s), 150.0));
  EXPECT_TRUE(r.is_formed()) << r.metrics.outcome;
  EXPECT_TRUE(r.metrics.collisions.empty()) << r.metrics.outcome;
  EXPECT_EQ(r.not_optimal(), 0u) << "relaxed, or without room";
  EXPECT_EQ(r.metrics.uncertified_half_planes, 0u);
  const datasets::AuditReport report = audited(r);
  EXPECT_TRUE(report.clean());
  for (const std::string& finding : report.findings) ADD_FAILURE() << finding;
}

TEST(SlotPlans, RobotsThatBlockEachOthersSlotsInAStreetPass) {
  for (const int count : {4, 8, 14})
    expect_formed(std::to_string(count), at_slots(test_scenes::street(count, count == 4 ? 3.0 : 4.0)));
}

TEST(SlotPlans, TwoHeadOnInACorridorPassInItsNiche) {
  const Scenario s = limited(at_slots(test_scenes::siding()), 100.0);
  EXPECT_FALSE(run(s, without_plans()).is_formed()) << "it shows nothing";
  expect_formed("siding", s);
}

TEST(SlotPlans, ThroughADoorAndInAFullBox) {
  test::SeededRandom random(test::seed_of_run(31));
  expect_formed("door", at_slots(test_scenes::door(10, 1.5, random)));
  expect_formed("rooms", at_slots(test_scenes::rooms(6, 1.5, random)));
  for (const double percent : {20.0, 30.0})
    expect_formed("box", at_slots(test_scenes::crowded_box(20, percent, random)));
}

TEST(SlotPlans, LargeCirclesForm) {
  expect_formed("circle", at_slots(test_scenes::circle(40)));
}

TEST(SlotPlans, RunsAreTheSameBits) {
  const Scenario s = limited(at_slots(test_scenes::street(8, 4.0)), 40.0);
  const SlotRun a = run(s), b = run(s);
  ASSERT_EQ(a.recording.steps.size(), b.recording.steps.size());
  for (std::size_t k = 0; k < a.recording.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      ASSERT_EQ(a.recording.steps[k].robots[i].position, b.recording.steps[k].robots[i].position) << k;
  EXPECT_FALSE(a.recording.plans.empty());
}

/// A formation that no robot blocks has the bits that it has without plans, and while the leader moves none is made.
TEST(SlotPlans, ChangeNothingWhereNoRobotIsBlocked) {
  Scenario s = at_slots(test_scenes::circle(6));
  s.formation->leader.path = {{0.0, 0.0}, {20.0, 0.0}};
  s.formation->leader.speed = 0.7;
  s.time_limit = 25.0;
  const SlotRun with = run(s), without = run(s, without_plans());
  ASSERT_TRUE(with.recording.liveness);
  EXPECT_EQ(with.recording.liveness->groups, 0u);
  ASSERT_EQ(with.recording.steps.size(), without.recording.steps.size());
  for (std::size_t k = 0; k < with.recording.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      ASSERT_EQ(with.recording.steps[k].robots[i].position, without.recording.steps[k].robots[i].position) << k;
}

TEST(SlotPlans, AreMadeOnlyWhereBrakePointsDoAsChosen) {
  const Scenario s = at_slots(test_scenes::circle(4));
  EXPECT_EQ(liveness_of(s, {}), Liveness::plan);
  EXPECT_EQ(liveness_of(s, without_plans()), Liveness::off);
  SimulationOptions options;
  options.liveness = Liveness::bias;
  EXPECT_EQ(liveness_of(s, options), Liveness::off);
  for (const Method method : {Method::orca, Method::ivo_edge}) {
    SimulationOptions without_margins;
    without_margins.method = method;
    EXPECT_EQ(liveness_of(s, without_margins), Liveness::off);
  }
  for (const Controller controller : {Controller::paper_literal, Controller::paper_signs}) {
    SimulationOptions paper;
    paper.controller = controller;
    EXPECT_EQ(liveness_of(s, paper), Liveness::off);
  }
  const std::vector<std::function<void(ControllerOptions&)>> switches = {
      [](ControllerOptions& r) { r.brake_point = false; }, [](ControllerOptions& r) { r.absolute_frame = false; },
      [](ControllerOptions& r) { r.filter_last = false; }, [](ControllerOptions& r) { r.acceleration_bound = 8.0; }};
  for (std::size_t k = 0; k < switches.size(); ++k) {
    SimulationOptions one;
    one.controller_options = controller_options_of(one.controller);
    switches[k](*one.controller_options);
    EXPECT_EQ(liveness_of(s, one), Liveness::off) << k;
  }
}

/// A leader that begins at rest, with a start in which no slot is free: slots count where it ends.
TEST(SlotPlans, AreMadeForTheSlotsAtTheLeadersEnd) {
  Scenario s = at_slots(test_scenes::siding());
  s.formation->leader.path = {{0.0, 3.0}, {0.0, 0.0}};
  s.formation->leader.profile = {{0.0, 0.0}, {1.0, 2.0}, {2.0, 1.0}, {3.0, 0.5}};
  s.time_limit = 100.0;
  EXPECT_TRUE(run(s).is_formed());
}

TEST(SlotPlans, NoPlansForRobotsThatDoNotCooperateNorAmongMovingObstacles) {
  Scenario s = limited(at_slots(test_scenes::siding()), 30.0);
  s.robots[1].cooperates = false;
  for (const JointPlan& plan : run(s).recording.plans) EXPECT_THAT(plan.robots, ElementsAre(0u));
  s.moving_obstacles.emplace_back();
  EXPECT_EQ(liveness_of(s, {}), Liveness::off);
}

/// A line of robots beside each other, whose leader drives 10 m to the right.
Scenario line_of(std::vector<double> offsets) {
  Scenario s;
  for (const double y : offsets)
    test_scenes::add_robot(s, {-10.0, 2.0 * static_cast<double>(s.robots.size()) - 3.0}, {0.0, y});
  s = at_slots(std::move(s));
  s.formation->leader.path = {{-10.0, 0.0}, {0.0, 0.0}};
  s.formation->leader.speed = 1.5;
  s.time_limit = 60.0;
  return s;
}

bool rests_at_the_end(const SlotRun& r) {
  const std::vector<RobotStep>& last = r.recording.steps.back().robots;
  return std::all_of(last.begin(), last.end(), [](const RobotStep& x) {
    constexpr double kFastest = 1.5;  // m/s
    return geometry::norm(x.velocity) < kAtRestShare * kFastest;
  });
}

/// Robots that were plans' goals moved in and out of each other's slots until the time limit, or drove round the
/// obstacle for as long.
TEST(SlotPlans, ARobotWhoseSlotAnObstacleTakesGoesBesideItAndStays) {
  Scenario s = line_of({-3.0, -1.0, 1.0, 3.0});
  s.obstacles.push_back({"block", geometry::Polygon{{{-1, 2}, {1, 2}, {1, 4}, {-1, 4}}, {}}});
  const SlotRun r = run(s);
  EXPECT_EQ(r.recording.liveness->groups, 0u);
  EXPECT_TRUE(r.metrics.collisions.empty()) << r.metrics.outcome;
  EXPECT_THAT(r.metrics.outcome,
              testing::HasSubstr("R4 cannot take its slot, (0, 3): obstacle 'block' stands in it; it ends 1.6"));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(r.metrics.robots[i].arrived) << i;
  EXPECT_FALSE(r.metrics.robots[3].arrived);
  EXPECT_TRUE(rests_at_the_end(r));
  EXPECT_TRUE(audited(r).clean());
}

TEST(SlotPlans, OneOfSeveralSlotsInOnePlaceIsFilledAndOtherRobotsStandBesideIt) {
  const SlotRun r = run(line_of({0.0, 0.3, -0.3}));
  EXPECT_EQ(r.recording.liveness->groups, 0u);
  EXPECT_THAT(r.metrics.outcome, testing::HasSubstr(" cannot take its slot, (0, 0"));
  EXPECT_THAT(r.metrics.outcome, testing::HasSubstr("the slot of R"));
  std::size_t arrived = 0;
  for (const RobotMetrics& robot : r.metrics.robots) arrived += robot.arrived;
  EXPECT_EQ(arrived, 1u);
  EXPECT_TRUE(rests_at_the_end(r));
}

/// A slot that the margin keeps a robot off, or leaves just so: it drove round the wall for the whole run.
TEST(SlotPlans, SlotsInTheMarginOfAWallAreFilledAsNearAsTheMarginLeaves) {
  for (const double margin : {0.05, 0.1})
    for (const double clearance : {0.48, 0.5, 0.52, 0.55, 0.58, 0.6}) {
      Scenario s = line_of({-3.0, -1.0, 1.0, 3.0});
      s.margins.obstacle = margin;
      s.obstacles.push_back({"box", geometry::Polygon{{{clearance, -6}, {6, -6}, {6, 6}, {clearance, 6}}, {}}});
      const SlotRun r = run(limited(s, 30.0));
      SCOPED_TRACE(std::to_string(margin) + " " + std::to_string(clearance) + ": " + r.metrics.outcome);
      EXPECT_TRUE(r.metrics.collisions.empty());
      for (const RobotMetrics& robot : r.metrics.robots) {
        EXPECT_LT(robot.path_length, 14.0) << robot.id;
      }
      for (const RobotStep& robot : r.recording.steps.back().robots)
        EXPECT_NEAR(robot.position.x, -std::max(0.0, 0.5 + margin - clearance), 1e-3);
      EXPECT_TRUE(rests_at_the_end(r));
    }
}

/// The leader rests from the first row on: what a robot sees first is what it sees beside its slot.
TEST(SlotPlans, ARobotThatGoesBesideItsSlotFromTheFirstRowOnIsAudited) {
  Scenario s = line_of({-3.0, 3.0});
  s.formation->leader.path = {{0.0, 0.0}};
  s.obstacles.push_back({"block", geometry::Polygon{{{-1, 2}, {1, 2}, {1, 4}, {-1, 4}}, {}}});
  const SlotRun r = run(limited(s, 20.0));
  EXPECT_THAT(r.metrics.outcome, testing::HasSubstr("R2 cannot take its slot, (0, 3)"));
  EXPECT_TRUE(audited(r).clean());
}

/// Behind walls: no robot drives round them for ever.
TEST(SlotPlans, ASlotInAClosedRoomIsNamed) {
  Scenario s = line_of({-2.0, 3.0});
  s.obstacles.push_back({"room", geometry::Polyline{{{-1, 2}, {1, 2}, {1, 4}, {-1, 4}, {-1, 2}}}});
  const SlotRun r = run(s);
  EXPECT_THAT(r.metrics.outcome, testing::HasSubstr("R2 cannot take its slot, (0, 3): obstacle 'room' encloses it"));
  EXPECT_TRUE(r.metrics.robots[0].arrived);
  EXPECT_TRUE(rests_at_the_end(r)) << r.metrics.outcome;
}

TEST(SlotPlans, BeginWhereTheBrakePointsWere) {
  const SlotRun r = run(limited(at_slots(test_scenes::street(14, 4.0)), 60.0));
  std::size_t compared = 0;
  for (const JointPlan& plan : r.recording.plans)
    for (std::size_t k = 0; k < plan.robots.size(); ++k) {
      const Step& from = r.recording.steps[plan.from_row];
      EXPECT_EQ(from.robots[plan.robots[k]].anchor, plan.starts[k]);
      ++compared;
    }
  EXPECT_GT(compared, 0u);
}

/// Two head-on in a corridor without a siding stand for good, which is said by name; while the leader drives, nothing
/// of the kind is.
TEST(SlotPlans, ADeadlockOfAFormationIsNamedOnceItsLeaderRests) {
  Scenario s;
  test_scenes::add_box(s, 8.0, 0.75);
  test_scenes::add_robot(s, {-5.0, 0.0}, {5.0, 0.0});
  test_scenes::add_robot(s, {5.0, 0.0}, {-5.0, 0.0});
  const SlotRun blocked = run(limited(at_slots(s), 60.0));
  EXPECT_FALSE(blocked.is_formed());
  EXPECT_THAT(blocked.metrics.deadlock, ElementsAre("R1", "R2"));
  ASSERT_EQ(blocked.metrics.stuck.size(), 2u);
  EXPECT_THAT(blocked.metrics.stuck.front(),
              testing::HasSubstr("R1 waits for R2, which waits for R1: a deadlock of two"));
  Scenario driving = blocked.scenario;
  driving.formation->leader.path.push_back({1e6, 0.0});
  for (const Step& row : blocked.recording.steps)
    for (const std::vector<std::size_t>& by : waiting_in(driving, row)) ASSERT_TRUE(by.empty());
}

}  // namespace
}  // namespace exactvo::formation
