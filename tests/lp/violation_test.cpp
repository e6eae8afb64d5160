// SPDX-License-Identifier: GPL-3.0-or-later
// The arena's measure of violations: what is kept exactly counts as 0, whatever doubles make of it.
#include "violation.h"
#include "lp/sets/generated_sets.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::bench {
namespace {

double rounded_worst(const lp::Problem& problem, lp::Vec2 v) {
  double worst = 0.0;
  for (const lp::Constraint& c : problem.constraints) worst = std::max(worst, geometry::violation(c.half_plane, v));
  return worst;
}

TEST(WorstViolation, IsZeroWhereTheExactSolverKeepsWhatDoublesCallBroken) {
  std::size_t called_broken = 0;
  for (const lp::Problem& problem : lp::generate("RF10", 2000, 1)) {
    const lp::Solution s = lp::solve_exact(problem).solution;
    if (s.status != lp::Status::optimal) continue;
    EXPECT_EQ(worst_violation(problem.constraints, s.velocity), 0.0);
    called_broken += rounded_worst(problem, s.velocity) > 0.0;
  }
  EXPECT_GT(called_broken, 0u);
}

TEST(WorstViolation, SeesABreachOfTheLastBit) {
  const std::vector<lp::Constraint> above_a_third = {{{{3.0, 0.0}, 1.0}}};
  EXPECT_GT(worst_violation(above_a_third, {1.0 / 3.0, 0.0}), 0.0) << "a third rounds down, 3 times that to 1";
  EXPECT_EQ(worst_violation({{{{1.0, 0.0}, 0.5}}}, {0.25, 0.0}), 0.25);
  EXPECT_EQ(worst_violation({}, {1.0, 1.0}), 0.0);
}

}  // namespace
}  // namespace exactvo::bench
