// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/outcome.h"

#include <gtest/gtest.h>

namespace exactvo::tools {
namespace {

FinishedRun run_that(const char* outcome) {
  FinishedRun run;
  run.file.recording.outcome = outcome;
  return run;
}

TEST(Outcome, ACollisionComesFirst) {
  FinishedRun run = run_that("all robots arrived");
  run.metrics.min_obstacle_clearance = -0.12;
  EXPECT_EQ(outcome_words(run), "COLLISION: touched an obstacle by 0.12 m; all robots arrived");
  run.metrics.min_robot_clearance = -0.03;
  EXPECT_EQ(touch_words(run.metrics), "touched an obstacle by 0.12 m and another robot by 0.03 m");
  run.metrics.min_obstacle_clearance = 0.0;
  EXPECT_EQ(touch_words(run.metrics), "touched another robot by 0.03 m");
  run.metrics.min_robot_clearance.reset();
  EXPECT_FALSE(touched(run.metrics));
}

TEST(Outcome, OtherwiseItIsWhatTheRunSays) {
  EXPECT_EQ(outcome_words(run_that("diverged: far away")), "diverged: far away");
}

}  // namespace
}  // namespace exactvo::tools
