// SPDX-License-Identifier: GPL-3.0-or-later
// A run stopped at a time ends with the decision of that time's row, all its half-planes kept.
#include <gtest/gtest.h>

#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

TEST(RunSchedule, StopsAtTheRowAskedForWhateverItsMultipleRoundsTo) {
  const Scenario scene = test::paper_scene("A2");
  // 6 * 0.05 > 0.3 and 3 * 0.05 > 0.15 in doubles.
  for (const int row : {0, 1, 3, 6, 7, 14, 56, 87, 199}) {
    SimulationOptions options;
    options.stop_at = row / 20.0;
    const Recording recording = simulate(scene, options);
    ASSERT_EQ(recording.steps.size(), static_cast<std::size_t>(row) + 2) << row;
    EXPECT_NEAR(recording.steps[static_cast<std::size_t>(row)].time, row / 20.0, 1e-12);
  }
}

TEST(RunSchedule, ATimeBetweenRowsGivesTheRowBefore) {
  SimulationOptions options;
  options.stop_at = 1.337;
  const Recording recording = simulate(test::paper_scene("A2"), options);
  EXPECT_NEAR(recording.steps[recording.steps.size() - 2].time, 1.3, 1e-12);
}

// A number of rows that no integer holds became row 0.
TEST(RunSchedule, ATimeFarBeyondTheRunDoesNotStopIt) {
  const Scenario scene = test::paper_scene("A2");
  const std::size_t whole = simulate(scene, {}).steps.size();
  ASSERT_GT(whole, 100u);
  for (const double time : {1e6, 1e19, 1e300}) {
    SimulationOptions options;
    options.stop_at = time;
    EXPECT_EQ(simulate(scene, options).steps.size(), whole) << time;
  }
}

TEST(RunSchedule, TheLastDecisionKeepsEveryHalfPlane) {
  const Scenario scene = test::paper_scene("A2");
  SimulationOptions all;
  all.record_all = true;
  const Recording whole = simulate(scene, all);
  for (const int row : {3, 6, 14, 56}) {
    SimulationOptions options;
    options.stop_at = row / 20.0;
    const auto k = static_cast<std::size_t>(row);
    const Recording recording = simulate(scene, options);
    for (std::size_t i = 0; i < scene.robots.size(); ++i)
      EXPECT_EQ(recording.steps[k].robots[i].constraints.size(), whole.steps[k].robots[i].constraints.size()) << row;
  }
}

}  // namespace
}  // namespace exactvo::formation
