// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/outcome.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace exactvo::tools {
namespace {

FinishedRun run_of(std::size_t robots, std::size_t arrived) {
  FinishedRun run;
  run.metrics.robots.resize(robots);
  for (std::size_t i = 0; i < arrived; ++i) run.metrics.robots[i].arrived = true;
  return run;
}

TEST(Outcome, CountsRobotsInWordsThatAgree) {
  EXPECT_EQ(outcome_words(run_of(1, 1)), "the robot arrived");
  EXPECT_EQ(outcome_words(run_of(1, 0)), "the robot did not arrive within the time limit");
  EXPECT_EQ(outcome_words(run_of(3, 3)), "all robots arrived");
  EXPECT_EQ(outcome_words(run_of(3, 2)), "1 of 3 robots did not arrive within the time limit");
  EXPECT_EQ(outcome_words(run_of(3, 0)), "none of 3 robots arrived within the time limit");
}

TEST(Outcome, ACollisionComesFirst) {
  FinishedRun run = run_of(2, 2);
  run.metrics.min_obstacle_clearance = -0.12;
  EXPECT_EQ(outcome_words(run), "COLLISION: touched an obstacle by 0.12 m; all robots arrived");
  run.metrics.min_robot_clearance = -0.03;
  EXPECT_EQ(touch_words(run.metrics), "touched an obstacle by 0.12 m and another robot by 0.03 m");
  run.metrics.min_obstacle_clearance = 0.0;
  EXPECT_EQ(touch_words(run.metrics), "touched another robot by 0.03 m");
  run.metrics.min_robot_clearance.reset();
  EXPECT_FALSE(touched(run.metrics));
}

TEST(Outcome, AFormationSaysWhatItsRunSays) {
  FinishedRun run = run_of(3, 0);
  run.file.scenario.formation.emplace();
  run.file.recording.outcome = "diverged: far away";
  EXPECT_EQ(outcome_words(run), "diverged: far away");
}

}  // namespace
}  // namespace exactvo::tools
