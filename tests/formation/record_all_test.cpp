// SPDX-License-Identifier: GPL-3.0-or-later
// A run that keeps every half-plane is proven whole.
#include <gtest/gtest.h>

#include <set>

#include "exactvo/datasets/audit.h"
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
      for (const RecordedConstraint& c : robot.constraints) {
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

TEST(Outlooks, EveryGoalsEnclosuresAreKept) {
  Scenario s;
  Robot r;
  r.id = "R1";
  r.goals = {{10, 0}, {20, 0}};
  s.robots = {r};
  s.obstacles = {{"first", geometry::Polyline{{{5, -2}, {5, 2}}}}, {"second", geometry::Polyline{{{15, -2}, {15, 2}}}}};
  const Recording rec = simulate(s);
  ASSERT_EQ(rec.later_outlooks.size(), 1u);
  EXPECT_EQ(rec.later_outlooks[0].goal, 1u);
  EXPECT_FALSE(rec.later_outlooks[0].enclosures.empty());
  EXPECT_GT(rec.later_outlooks[0].time, 3.0);
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
