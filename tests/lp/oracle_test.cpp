// SPDX-License-Identifier: GPL-3.0-or-later
// Every solver against brute force in rationals, on random problems of every kind and on the adversarial families.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/sets/generated_sets.h"
#include "oracle.h"
#include "problem_text.h"
#include "support/seeded_random.h"

namespace exactvo::lp {
namespace {

using test::SeededRandom;

/// The certificate's gap bounds what rounding inward costs; beside it stand only the few roundings of comparing.
constexpr double kComparing = 0x1p-46;

Problem random_problem(SeededRandom& random) {
  Problem p;
  if (random.integer(0, 3) != 0) p.bound.disc = random.uniform(0.5, 3.0);
  if (random.integer(0, 2) == 0) p.bound.box_x = random.uniform(0.2, 3.0);
  if (random.integer(0, 2) == 0) p.bound.box_y = random.uniform(0.2, 3.0);
  p.preferred = random.in_box(3.0);
  const int m = random.integer(0, 7);
  const double reach = random.uniform(0.1, 2.0);
  for (int k = 0; k < m; ++k) {
    const Vec2 n = random.uniform(0.5, 2.0) * random.direction();
    const auto priority = random.integer(0, 2) == 0 ? Priority::hard : Priority::soft;
    p.constraints.push_back({{n, random.uniform(-reach, 0.6 * reach)}, priority, k});
  }
  return p;
}

/// Coordinates on a coarse grid: parallel lines, lines through one point, ties of every kind.
Problem grid_problem(SeededRandom& random) {
  Problem p;
  p.bound.disc = random.integer(0, 2) == 0 ? std::numeric_limits<double>::infinity() : random.integer(1, 5);
  if (random.integer(0, 1) == 0) p.bound.box_x = random.integer(0, 4);
  if (random.integer(0, 1) == 0) p.bound.box_y = random.integer(0, 4);
  p.preferred = {1.0 * random.integer(-4, 4), 1.0 * random.integer(-4, 4)};
  const int m = random.integer(0, 7);
  while (static_cast<int>(p.constraints.size()) < m) {
    const Vec2 n = {1.0 * random.integer(-3, 3), 1.0 * random.integer(-3, 3)};
    if (n == Vec2{}) continue;
    const auto priority = random.integer(0, 1) == 0 ? Priority::hard : Priority::soft;
    p.constraints.push_back({{n, 1.0 * random.integer(-6, 4)}, priority, 0});
  }
  return p;
}

Status verdict_of(const Proven& proven, const Problem& problem) {
  if (proven.solution.status != Status::no_interior) return proven.solution.status;
  return proven.certificate->contradiction.empty() ? Status::optimal : oracle::verdict(problem);
}

void expect_right(const Problem& problem, const Proven& proven) {
  const Status truth = oracle::verdict(problem);
  ASSERT_TRUE(proven.certificate.has_value()) << text_of(problem);
  EXPECT_STREQ(name(check(problem, *proven.certificate)), "none") << text_of(problem);
  ASSERT_STREQ(name(verdict_of(proven, problem)), name(truth)) << text_of(problem);
  const Solution& s = proven.solution;
  const double gap = proven.certificate->gap;
  if (s.status == Status::optimal && problem.objective == Objective::nearest) {
    const double squared = squared_norm(s.velocity - problem.preferred);
    const double least = oracle::least_squared_distance(problem);
    EXPECT_LE(squared, least + gap + kComparing * (1.0 + squared)) << text_of(problem);
    EXPECT_GE(squared, least - kComparing * (1.0 + squared)) << text_of(problem);
  }
  if (s.status == Status::optimal && problem.objective == Objective::farthest) {
    EXPECT_GE(dot(s.velocity, problem.preferred), oracle::farthest(problem) - gap - kComparing * 10.0)
        << text_of(problem);
  }
  if (s.status == Status::relaxed || s.status == Status::infeasible) {
    const double least = oracle::least_violation(problem);
    EXPECT_LE(s.violation, least + gap + kComparing * (1.0 + s.violation)) << text_of(problem);
    EXPECT_GE(s.violation, least - kComparing * (1.0 + s.violation)) << text_of(problem);
  }
}

class OnKind : public testing::TestWithParam<Problem (*)(SeededRandom&)> {};

TEST_P(OnKind, CertifiedAnswersAreRight) {
  SeededRandom random(test::seed_of_run(41));
  for (int k = 0; k < 1500; ++k) {
    const Problem problem = GetParam()(random);
    expect_right(problem, solve_certified(problem));
    if (HasFatalFailure()) return;
  }
}

TEST_P(OnKind, ExactAnswersAreRight) {
  SeededRandom random(test::seed_of_run(42));
  for (int k = 0; k < 1500; ++k) {
    const Problem problem = GetParam()(random);
    expect_right(problem, solve_exact(problem));
    if (HasFatalFailure()) return;
  }
}

TEST_P(OnKind, LinearObjectivesAreRight) {
  SeededRandom random(test::seed_of_run(43));
  for (int k = 0; k < 1500; ++k) {
    Problem problem = GetParam()(random);
    problem.objective = Objective::farthest;
    if (problem.preferred == Vec2{}) problem.preferred = {1.0, 0.0};
    if (std::isinf(problem.bound.disc)) problem.bound.box_x = problem.bound.box_y = 1.5;
    expect_right(problem, solve_certified(problem));
    expect_right(problem, solve_exact(problem));
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, OnKind, testing::Values(random_problem, grid_problem),
                         [](const auto& kind) { return kind.index == 0 ? "Random" : "Grid"; });

TEST(Adversarial, CertifiedVerdictsAreRightDownToTheLastDigit) {
  for (const std::string& family : adversarial_families()) {
    for (const char* perturbation : {"1e-3", "1e-6", "1e-9", "1e-12", "1e-14", "1e-15", "1e-16", "1e-17", "0"}) {
      for (const Problem& problem : generate(family + ":" + perturbation, 25, 7)) {
        expect_right(problem, solve_certified(problem));
        if (HasFatalFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace exactvo::lp
