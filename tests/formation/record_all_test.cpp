// SPDX-License-Identifier: GPL-3.0-or-later
// A run that keeps every half-plane is proven whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "exactvo/datasets/audit.h"
#include "exactvo/formation/speed_profile.h"
#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

datasets::RecordingFile recorded(const char* scene) {
  SimulationOptions options;
  options.record_all = true;
  datasets::RecordingFile file;
  file.scenario = test::paper_scene(scene);
  file.recording = simulate(file.scenario, options);
  return file;
}

class RecordAll : public testing::TestWithParam<const char*> {};

TEST_P(RecordAll, TheAuditProvesTheWholeRun) {
  const datasets::RecordingFile file = recorded(GetParam());
  EXPECT_TRUE(file.recording.all_half_planes);
  std::size_t of_obstacles = 0;
  const std::size_t decisions = file.recording.steps.size() - 1;
  for (const Step& row : file.recording.steps)
    for (const RobotStep& robot : row.robots)
      for (const DecisionConstraint& c : robot.constraints) {
        EXPECT_TRUE(c.certified);
        of_obstacles += c.source != ConstraintSource::robot;
      }
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_EQ(report.half_planes, of_obstacles);
  EXPECT_GT(report.half_planes, decisions / 4);
  EXPECT_EQ(report.unsafe, 0u);
  EXPECT_EQ(report.steps, decisions * file.scenario.robots.size());
  EXPECT_EQ(report.collisions, 0u);
  EXPECT_EQ(report.inconsistencies, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RecordAll, testing::Values("A7", "A14", "B1", "B3"),
                         [](const auto& row) { return std::string(row.param); });

Robot robot(const std::string& id, Vec2 position, Vec2 goal, double radius) {
  Robot r;
  r.id = id;
  r.position = position;
  r.goals = {goal};
  r.radius = radius;
  return r;
}

/// The margin of guided robots changes on their way: the half-planes of one decision are built for one margin.
TEST(RecordAllKept, ChangesNothingOfARunBetweenWallsNearerThanTheMargin) {
  for (const double beside : {0.36, 0.381, 0.4, 0.7}) {
    Scenario s;
    s.time_limit = 5.0;
    s.robots = {robot("A", {0, 0}, {6, 0}, 0.3), robot("B", {6, 0}, {0, 0}, 0.3)};
    s.obstacles = {{"n", geometry::Polyline{{{-6, beside}, {26, beside}}}},
                   {"s", geometry::Polyline{{{-6, -beside}, {26, -beside}}}}};
    SimulationOptions all;
    all.record_all = true;
    datasets::RecordingFile file;
    file.scenario = s;
    file.recording = simulate(s);
    const Recording whole = simulate(s, all);
    ASSERT_EQ(file.recording.steps.size(), whole.steps.size()) << beside;
    for (std::size_t k = 0; k < whole.steps.size(); ++k)
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_EQ(file.recording.steps[k].robots[i].chosen, whole.steps[k].robots[i].chosen) << beside << " row " << k;
    EXPECT_TRUE(datasets::audit(file).clean()) << beside;
  }
}

/// Where half-planes contradict each other, all that the choice violates are on the record.
TEST(RecordAllKept, AnOrdinaryRecordingHasTheViolatedHalfPlanesOfARelaxedDecision) {
  Scenario s;
  s.time_limit = 6.0;
  s.liveness = Liveness::off;
  for (int i = 0; i < 9; ++i) {
    const Vec2 place{1.1 * (i % 3) - 1.1, 1.15 * (i / 3) - 1.15};
    s.robots.push_back(robot("R" + std::to_string(i), place, -3.0 * place, 0.5));
  }
  SimulationOptions all;
  all.record_all = true;
  const Recording ordinary = simulate(s), whole = simulate(s, all);
  const auto violated = [](const RobotStep& r) {
    return std::count_if(r.constraints.begin(), r.constraints.end(), [&](const DecisionConstraint& c) {
      return geometry::violation(c.half_plane, r.chosen) > 1e-9;
    });
  };
  long more_than_bind = 0;
  for (std::size_t k = 0; k < whole.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      const RobotStep& r = ordinary.steps[k].robots[i];
      EXPECT_EQ(violated(r), violated(whole.steps[k].robots[i])) << "row " << k << " robot " << i;
      more_than_bind += violated(r) > 3;
    }
  EXPECT_GT(more_than_bind, 0) << "the crowd is no test";
}

TEST(RecordAllKept, HoldsEverythingThatAnOrdinaryRecordingHolds) {
  const Scenario s = test::paper_scene("B3");
  SimulationOptions all;
  all.record_all = true;
  const Recording whole = simulate(s, all), active = simulate(s);
  std::size_t more = 0;
  for (std::size_t k = 0; k + 1 < whole.steps.size(); ++k)
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      const auto& kept = whole.steps[k].robots[i].constraints;
      const auto& binding = active.steps[k].robots[i].constraints;
      EXPECT_GE(kept.size(), binding.size());
      EXPECT_GE(kept.size(), 2u);  // the two other robots are always near
      more += kept.size() - binding.size();
    }
  EXPECT_GT(more, whole.steps.size());
}

TEST(Bodies, AConstraintNamesTheShapeItWasBuiltOn) {
  for (const char* scene : {"A2", "A4", "B1"}) {
    const Scenario s = test::paper_scene(scene);
    for (const Method method : {Method::orca, Method::ivo_edge, Method::ivo}) {
      SimulationOptions options = test::with_method(method);
      options.record_all = true;
      const Recording rec = simulate(s, options);
      std::size_t named = 0;
      for (const Step& row : rec.steps)
        for (std::size_t i = 0; i < row.robots.size(); ++i)
          for (const DecisionConstraint& c : row.robots[i].constraints) {
            const vo::Body& body = rec.bodies.at(c.body);
            ASSERT_EQ(body.kind, c.source);
            const SeenBody seen = seen_body(s, rec.bodies, row, i, c);
            ASSERT_EQ(seen.position, row.robots[i].anchor);
            ASSERT_EQ(seen.radius, s.robots[i].radius);
            if (c.source == ConstraintSource::robot) {
              ASSERT_EQ(body.owners, std::vector<std::size_t>{c.index});
              ASSERT_EQ(std::get<geometry::Disc>(seen.shape).center, row.robots[c.index].anchor);
              ASSERT_EQ(seen.velocity, row.robots[c.index].anchor_velocity);
            } else {
              ASSERT_EQ(geometry::to_string(body.shape), geometry::to_string(seen.shape));
            }
            ++named;
          }
      EXPECT_GT(named, 100u) << scene << " " << name(method);
    }
  }
}

TEST(Bodies, AMovingObstacleIsSeenWhereItsRowHasIt) {
  Scenario s = test::paper_scene("A2");
  s.moving_obstacles = {
      {"cart", geometry::Polygon{{{9, 2}, {10, 2}, {10, 3}, {9, 3}}, {}}, {{{0, 0}, {0, 6}, {3, 6}}, 0.8}}};
  SimulationOptions options;
  options.record_all = true;
  const Recording rec = simulate(s, options);
  std::size_t seen_moving = 0;
  for (const Step& row : rec.steps)
    for (std::size_t i = 0; i < row.robots.size(); ++i)
      for (const DecisionConstraint& c : row.robots[i].constraints) {
        if (c.source != ConstraintSource::moving_obstacle) continue;
        const SeenBody seen = seen_body(s, rec.bodies, row, i, c);
        ASSERT_EQ(
            geometry::to_string(seen.shape),
            geometry::to_string(hull_of(s.moving_obstacles[0], displacement_at(s.moving_obstacles[0], row.time))));
        ASSERT_EQ(seen.velocity, row.moving[0].velocity);
        ++seen_moving;
      }
  EXPECT_GT(seen_moving, 50u);
}

TEST(Multipliers, BalanceTheChoiceAgainstThePreferredVelocity) {
  constexpr double kRounding = 1e-9;  // m/s
  std::size_t balanced = 0;
  for (const char* scene : {"A2", "A4", "A7", "B1"}) {
    const Scenario s = test::paper_scene(scene);
    for (const Step& row : simulate(s).steps)
      for (const RobotStep& r : row.robots) {
        if (r.status != lp::Status::optimal) continue;
        Vec2 sum{};
        for (const DecisionConstraint& c : r.constraints) {
          ASSERT_GE(c.multiplier, 0.0);
          sum += c.multiplier * c.half_plane.normal;
        }
        for (const lp::ActiveConstraint& part : r.bound) {
          ASSERT_EQ(part.binding.kind, lp::BindingKind::disc);
          sum -= part.multiplier * r.chosen;
        }
        ASSERT_LT(norm(sum - (r.chosen - r.preferred)), kRounding) << scene << " at " << row.time;
        balanced += !r.constraints.empty() || !r.bound.empty();
      }
  }
  EXPECT_GT(balanced, 200u);
}

TEST(GoalBodies, EveryGoalsEnclosuresAreKept) {
  Scenario s;
  s.guidance = Guidance::none;
  s.liveness = Liveness::off;
  Robot r;
  r.id = "R1";
  r.goals = {{10, 0}, {20, 0}};
  s.robots = {r};
  s.obstacles = {{"first", geometry::Polyline{{{5, -2}, {5, 2}}}}, {"second", geometry::Polyline{{{15, -2}, {15, 2}}}}};
  const Recording rec = simulate(s);
  ASSERT_EQ(rec.goal_bodies.size(), 2u);
  EXPECT_EQ(rec.goal_bodies[0].goal, 0u);
  EXPECT_EQ(rec.goal_bodies[0].time, 0.0);
  EXPECT_EQ(rec.goal_bodies[1].goal, 1u);
  EXPECT_GT(rec.goal_bodies[1].time, 3.0);
  for (const GoalBodies& of_goal : rec.goal_bodies) {
    ASSERT_EQ(of_goal.bodies.size(), 2u);
    for (const std::size_t body : of_goal.bodies) EXPECT_EQ(rec.bodies.at(body).owners.size(), 1u);
  }
  std::set<std::string> notes;
  for (const Step& row : rec.steps) notes.insert(row.robots[0].note);
  EXPECT_EQ(notes.count("goal 1 passed: heads for the next"), 1u);
}

TEST(Notes, SayWhyFollowingBeganOnWhichSideAndWhyItEnded) {
  const Recording rec = simulate(test::paper_scene("A14"));
  std::string all;
  for (const Step& row : rec.steps) all += row.robots[0].note + "\n";
  EXPECT_NE(all.find("stalled: follows the boundary, turning "), std::string::npos) << all;
  EXPECT_NE(all.find(" s to go that way, "), std::string::npos) << all;
  EXPECT_NE(all.find("left the boundary: nearer to the goal"), std::string::npos) << all;
  std::string sides;
  for (const Step& row : simulate(test::paper_scene("B1")).steps)
    for (const RobotStep& robot : row.robots) sides += robot.note + "\n";
  EXPECT_NE(sides.find("blocked: keeps "), std::string::npos);
  EXPECT_NE(sides.find("free again: the side is given up"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::formation
