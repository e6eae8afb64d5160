// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured of a run on a crowd, against the metrics of a recording with the same rows.
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace exactvo::formation {
namespace {

using geometry::Vec2;
using testing::HasSubstr;

/// A circle of robots with a waypoint each, round a block, past a cart. The first two overlap at the start.
Scenario circle() {
  Scenario s;
  s.name = "circle";
  s.time_step = 0.1;
  s.time_limit = 30.0;
  for (int k = 0; k < 20; ++k) {
    const double angle = 0.1 * 3.14159 * k;
    Robot r;
    r.id = "R" + std::to_string(k + 1);
    r.position = {10.0 * std::cos(angle), 10.0 * std::sin(angle)};
    r.goals = {Vec2{-0.4 * r.position.y, 0.4 * r.position.x}, -1.0 * r.position};
    r.radius = 0.4;
    r.max_speed = 1.0 + 0.05 * k;
    s.robots.push_back(r);
  }
  s.robots[1].position = s.robots[0].position + Vec2{0.0, 0.5};
  s.obstacles.push_back({"block", geometry::Polygon{{{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}, {}}});
  return s;
}

/// Keeps every row as a recording has it.
struct AsRecording final : RunSink {
  explicit AsRecording(const Scenario& s) { run.time_step = s.time_step; }
  void add_state(const RunState& now) override {
    Step& row = run.steps.emplace_back();
    row.time = now.time;
    row.robots.resize(now.positions.size());
    for (std::size_t i = 0; i < now.positions.size(); ++i) {
      row.robots[i].position = now.positions[i];
      row.robots[i].velocity = now.velocities[i];
    }
  }
  Recording run;
};

void expect_same(const Metrics& found, const Metrics& expected) {
  EXPECT_EQ(found.arrived, expected.arrived);
  EXPECT_EQ(found.all_arrived, expected.all_arrived);
  EXPECT_EQ(found.median_arrival_time, expected.median_arrival_time);
  EXPECT_EQ(found.last_arrival_time, expected.last_arrival_time);
  EXPECT_EQ(found.min_obstacle_clearance, expected.min_obstacle_clearance);
  EXPECT_EQ(found.min_robot_clearance, expected.min_robot_clearance);
  EXPECT_EQ(found.jitter, expected.jitter);
  EXPECT_EQ(found.velocity_variation, expected.velocity_variation);
  EXPECT_EQ(found.peak_acceleration, expected.peak_acceleration);
  EXPECT_EQ(found.heading_reversals, expected.heading_reversals);
  EXPECT_EQ(found.steps, expected.steps);
  EXPECT_EQ(found.time, expected.time);
  ASSERT_EQ(found.robots.size(), expected.robots.size());
  for (std::size_t i = 0; i < found.robots.size(); ++i) {
    EXPECT_EQ(found.robots[i].id, expected.robots[i].id);
    EXPECT_EQ(found.robots[i].arrival_time, expected.robots[i].arrival_time) << i;
    EXPECT_EQ(found.robots[i].path_length, expected.robots[i].path_length) << i;
    EXPECT_EQ(found.robots[i].detour, expected.robots[i].detour) << i;
    EXPECT_EQ(found.robots[i].min_obstacle_clearance, expected.robots[i].min_obstacle_clearance) << i;
  }
  ASSERT_EQ(found.collisions.size(), expected.collisions.size());
  for (std::size_t k = 0; k < found.collisions.size(); ++k) {
    EXPECT_EQ(found.collisions[k].robot, expected.collisions[k].robot);
    EXPECT_EQ(found.collisions[k].with, expected.collisions[k].with);
    EXPECT_EQ(found.collisions[k].until, expected.collisions[k].until);
    EXPECT_EQ(found.collisions[k].depth, expected.collisions[k].depth);
  }
}

TEST(CrowdMetrics, AreThoseOfTheSameRowsInARecording) {
  const Scenario s = circle();
  AsRecording rows(s);
  Evaluator evaluator(s, &rows);
  const RunReport report = run_crowd(s, {}, &evaluator);
  const Metrics found = evaluator.finish(report, {"a warning"}), expected = measure(s, rows.run);
  expect_same(found, expected);
  EXPECT_GT(found.arrived, 0U);
  EXPECT_GT(found.heading_reversals, 0U);
  EXPECT_EQ(found.collisions.size(), 1U) << "the two that overlap at the start";
  EXPECT_THAT(found.outcome, HasSubstr("COLLISION: R1 overlapped robot 'R2' by 0.3 m at 0 s"));
  EXPECT_EQ(found.warnings, std::vector<std::string>{"a warning"});
  EXPECT_EQ(found.relaxed_steps, report.relaxed);
  EXPECT_EQ(found.crowd->against_robots, report.against_robots);
}

TEST(CrowdMetrics, ARunThatGoesOnFromASnapshotIsMeasuredTheSame) {
  const Scenario s = circle();
  std::vector<std::string> kept;
  SimulationOptions options;
  options.snapshot_every = 25;
  options.keep_snapshot = [&](const std::string& bytes) { kept.push_back(bytes); };
  Evaluator whole(s);
  const Metrics expected = whole.finish(run_crowd(s, options, &whole), {});
  ASSERT_GT(kept.size(), 2U);
  for (const std::string& snapshot : kept) {
    SimulationOptions again;
    again.resume_from = snapshot;
    Evaluator rest(s);
    const Metrics found = rest.finish(run_crowd(s, again, &rest), {});
    expect_same(found, expected);
    EXPECT_EQ(found.outcome, expected.outcome);
  }
  // A scenario with another number of robots.
  Scenario fewer = s;
  fewer.robots.pop_back();
  std::ostringstream saved;
  whole.save(saved);
  std::istringstream bytes(saved.str());
  Evaluator other(fewer);
  EXPECT_THROW(other.restore(RunState{0, 0.0, {}, {}}, bytes), CrowdError);
}

TEST(CrowdMetrics, ClearancesOfVeryManyRobotsAreNotMeasuredAndThatIsReported) {
  Scenario s;
  s.name = "many";
  s.time_limit = 0.1;
  for (std::size_t k = 0; k <= kMostClearances; ++k) {
    Robot r;
    r.id = "R" + std::to_string(k);
    r.position = {2.0 * static_cast<double>(k), 0.0};
    r.goals = {r.position + Vec2{0.0, 5.0}};
    s.robots.push_back(r);
  }
  for (const bool is_less : {false, true}) {
    if (is_less) s.robots.pop_back();
    Evaluator evaluator(s);
    const Metrics m = evaluator.finish(run_crowd(s, {}, &evaluator), {});
    EXPECT_EQ(m.min_robot_clearance.has_value(), is_less);
    EXPECT_EQ(m.not_measured.size(), is_less ? 1U : 2U);
    EXPECT_GT(m.robots.front().path_length, 0.0);
    EXPECT_EQ(m.stuck.size(), s.robots.size());
    EXPECT_THAT(m.stuck.front(), HasSubstr("R0 is "));
    EXPECT_THAT(m.outcome, HasSubstr("none of 200" + std::string(is_less ? "0" : "1") + " robots arrived within"));
  }
}

}  // namespace
}  // namespace exactvo::formation
