// SPDX-License-Identifier: GPL-3.0-or-later
// RVO and HRVO as methods: their runs, what they promise, and what the audit asks of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "exactvo/datasets/audit.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::datasets::test {
namespace {

using formation::DecisionConstraint;
using formation::Method;
using formation::RobotStep;
using formation::Scenario;
using formation::Step;
using geometry::Vec2;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr Method kCones[] = {Method::rvo, Method::hrvo};

/// Robots on a circle that change places with those opposite.
Scenario circle(int count, double radius) {
  Scenario s;
  s.time_step = 0.1;
  s.time_limit = 60.0;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * geometry::kPi * k / count;
    formation::Robot r;
    r.id = "R" + std::to_string(k + 1);
    r.position = radius * Vec2{std::cos(angle), std::sin(angle)};
    r.goals = {-r.position};
    r.radius = 0.4;
    r.max_speed = 1.0;
    s.robots.push_back(r);
  }
  return s;
}

RecordingFile recorded(const Scenario& s, Method method) {
  formation::SimulationOptions options;
  options.method = method;
  options.record_all = true;
  RecordingFile file;
  file.scenario = s;
  file.info.method = name(method);
  file.recording = formation::simulate(s, options);
  return file;
}

bool all_arrive(const RecordingFile& file) {
  const Step& last = file.recording.steps.back();
  for (std::size_t i = 0; i < last.robots.size(); ++i)
    if (norm(last.robots[i].position - file.scenario.robots[i].goals.back()) > file.scenario.arrival_tolerance)
      return false;
  return true;
}

TEST(ConeMethods, PairsChangePlacesAndTheAuditProvesTheirHalfPlanes) {
  for (const Method method : kCones) {
    Scenario s = circle(2, 4.0);
    s.obstacles = {{"wall", geometry::Polyline{{{-1.0, 2.5}, {1.0, 2.5}}}}};
    const RecordingFile file = recorded(s, method);
    EXPECT_TRUE(all_arrive(file)) << name(method);
    EXPECT_THAT(file.recording.warnings, Contains(HasSubstr("promises nothing between robots"))) << name(method);
    const AuditReport report = audit(file);
    EXPECT_TRUE(report.clean()) << name(method) << to_json(report);
    EXPECT_TRUE(report.without_pairs);
    EXPECT_THAT(to_json(report), HasSubstr("the method promises nothing between robots"));
    EXPECT_GT(report[AuditPoint::half_planes].proven, 50u) << name(method);
    EXPECT_EQ(report.collisions, 0u);
  }
}

TEST(ConeMethods, HalfPlanesBetweenRobotsAreNotCertified) {
  std::size_t between = 0;
  for (const Method method : kCones)
    for (const Step& row : recorded(circle(3, 3.0), method).recording.steps)
      for (const RobotStep& robot : row.robots)
        for (const DecisionConstraint& c : robot.constraints) {
          if (c.source != formation::ConstraintSource::robot) continue;
          ++between;
          EXPECT_FALSE(c.certified);
        }
  EXPECT_GT(between, 200u);
}

TEST(ConeMethods, AHalfPlaneThatCutsIntoItsConeIsRefuted) {
  for (const Method method : kCones) {
    RecordingFile file = recorded(circle(2, 4.0), method);
    DecisionConstraint& c = file.recording.steps[3].robots[0].constraints.front();
    ASSERT_EQ(c.source, formation::ConstraintSource::robot);
    c.half_plane.offset -= 0.1;
    EXPECT_GT(audit(file)[AuditPoint::half_planes].refuted, 0u) << name(method);
  }
}

TEST(ConeMethods, OverlapsFailTheAuditAndAreCounted) {
  // Many in little room: some choose sides that do not go together.
  std::size_t overlapping = 0;
  for (const Method method : kCones)
    for (const int count : {12, 16}) {
      Scenario s = circle(count, 0.17 * count);
      s.time_limit = 25.0;
      const RecordingFile file = recorded(s, method);
      const AuditReport report = audit(file);
      const bool overlaps = formation::evaluate(s, file.recording).metrics.min_robot_clearance < 0.0;
      overlapping += overlaps;
      EXPECT_EQ(report.collisions > 0, overlaps) << name(method) << " " << count;
      EXPECT_EQ(report.clean(), !overlaps) << name(method) << " " << count << to_json(report);
    }
  EXPECT_GT(overlapping, 0u) << "the scenes are too easy to show it";
}

TEST(ConeMethods, LivenessIsOffAndFormationsAreRefused) {
  Scenario s = circle(2, 3.0);
  for (const Method method : kCones) {
    formation::SimulationOptions options;
    options.method = method;
    options.liveness = formation::Liveness::plan;
    EXPECT_EQ(liveness_of(s, options), formation::Liveness::off);
  }
  s.formation.emplace();
  s.formation->topology = {{{0, 1}, {1, 0}}, {1, 1}};
  s.formation->offsets = {{0, 0}, {0, 1.3}};
  s.formation->leader = {{{{0.5, 0.5}, {9, 3}}, 1.5}};
  for (formation::Robot& r : s.robots) r.goals.clear();
  formation::SimulationOptions options;
  options.method = Method::hrvo;
  EXPECT_THROW(formation::simulate(s, options), std::logic_error);
}

}  // namespace
}  // namespace exactvo::datasets::test
