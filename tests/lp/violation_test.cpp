// SPDX-License-Identifier: GPL-3.0-or-later
// The arena's measure of violations: what is kept exactly counts as 0, whatever doubles make of it.
#include "violation.h"
#include "lp/sets/generated_sets.h"

#include <gtest/gtest.h>

#include <limits>

#include <algorithm>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::bench {
namespace {

double rounded_worst(const lp::Problem& problem, lp::Vec2 v) {
  double worst = 0.0;
  for (const lp::Constraint& c : problem.constraints) worst = std::max(worst, geometry::violation(c.half_plane, v));
  return worst;
}

TEST(WorstViolation, IsZeroForExactAnswersThatDoublesCallViolated) {
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

TEST(WorstBreach, KnowsTheDiscAndVelocitiesThatAreNoNumbers) {
  lp::Problem problem;
  problem.bound.disc = 1.0;
  EXPECT_EQ(worst_breach(problem, {1.0, 0.0}), 0.0);
  EXPECT_GT(worst_breach(problem, {1.0, 1e-9}), 0.0) << "its rounded length is 1";
  EXPECT_EQ(worst_breach(problem, {3.0, 4.0}), 4.0);
  const double most = std::numeric_limits<double>::max();
  problem.constraints.push_back({{{1.0, 0.0}, 0.5}});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(worst_breach(problem, {bad, 0.0}), most);
  EXPECT_EQ(worst_breach(problem, {-most, -most}), most);
  EXPECT_DOUBLE_EQ(worst_breach(problem, {1e200, 0.0}), 1e200) << "its square is beyond all doubles";
}

}  // namespace
}  // namespace exactvo::bench
