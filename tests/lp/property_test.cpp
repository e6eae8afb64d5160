// SPDX-License-Identifier: GPL-3.0-or-later
// What must not change an answer does not, and what must, does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/sets/generated_sets.h"
#include "problem_text.h"
#include "support/seeded_random.h"

namespace exactvo::lp {
namespace {

constexpr std::size_t kCount = 2000;

/// Two rounded answers of the same optimum: 16 u V of slack each, times the sharpness that random vertices have.
constexpr double kSame = 1e-9;

std::vector<Problem> mixture() {
  std::vector<Problem> problems = generate("RF10", kCount, 3);
  for (const char* set : {"RI10", "RF20", "RI5"}) {
    const std::vector<Problem> more = generate(set, kCount, 4);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  for (std::size_t k = 0; k < problems.size(); k += 3)
    for (std::size_t j = 0; j < problems[k].constraints.size(); j += 4)
      problems[k].constraints[j].priority = Priority::hard;
  return problems;
}

void expect_same(const Problem& problem, const Solution& a, const Solution& b) {
  ASSERT_STREQ(name(a.status), name(b.status)) << text_of(problem);
  EXPECT_NEAR(a.violation, b.violation, kSame) << text_of(problem);
  if (a.status != Status::optimal) return;
  EXPECT_NEAR(a.velocity.x, b.velocity.x, kSame) << text_of(problem);
  EXPECT_NEAR(a.velocity.y, b.velocity.y, kSame) << text_of(problem);
}

template <class Change>
void expect_unchanged_by(Change change) {
  test::SeededRandom random(test::seed_of_run(5));
  for (const Problem& problem : mixture()) {
    Problem changed = problem;
    change(changed, random);
    expect_same(problem, solve_certified(problem).solution, solve_certified(changed).solution);
  }
}

TEST(Properties, PermutingConstraintsKeepsTheOptimum) {
  expect_unchanged_by([](Problem& p, test::SeededRandom& random) {
    for (std::size_t k = p.constraints.size(); k > 1; --k)
      std::swap(p.constraints[k - 1], p.constraints[random.integer(0, static_cast<int>(k) - 1)]);
  });
}

TEST(Properties, DuplicatingAConstraintKeepsTheOptimum) {
  expect_unchanged_by([](Problem& p, test::SeededRandom& random) {
    const std::size_t k = random.integer(0, static_cast<int>(p.constraints.size()) - 1);
    p.constraints.insert(p.constraints.begin(), p.constraints[k]);
  });
}

TEST(Properties, ARedundantConstraintKeepsTheOptimum) {
  expect_unchanged_by([](Problem& p, test::SeededRandom& random) {
    p.constraints.push_back({{random.direction(), -3.0}, Priority::hard, -1});  // beyond the disc of radius 2
  });
}

TEST(Properties, ScalingSpeedsByAPowerOfTwoScalesTheAnswerExactly) {
  for (const Problem& problem : mixture()) {
    Problem scaled = problem;
    scaled.bound.disc *= 0.125;
    scaled.preferred = 0.125 * scaled.preferred;
    for (Constraint& c : scaled.constraints) c.half_plane.offset *= 0.125;
    const Solution a = solve_certified(problem).solution;
    const Solution b = solve_certified(scaled).solution;
    ASSERT_STREQ(name(a.status), name(b.status)) << text_of(problem);
    EXPECT_EQ(0.125 * a.velocity.x, b.velocity.x);
    EXPECT_EQ(0.125 * a.velocity.y, b.velocity.y);
  }
}

TEST(Properties, RotatingBy90DegreesRotatesTheAnswer) {
  for (const Problem& problem : mixture()) {
    Problem rotated = problem;
    rotated.preferred = perp(problem.preferred);
    for (Constraint& c : rotated.constraints) c.half_plane.normal = perp(c.half_plane.normal);
    const Solution a = solve_certified(problem).solution;
    Solution b = solve_certified(rotated).solution;
    b.velocity = -perp(b.velocity);
    expect_same(problem, a, b);
  }
}

TEST(Properties, RemovingAWitnessMakesTheRestFeasibleWhenItIsAlone) {
  int contradictions = 0;
  for (const Problem& problem : generate("RI3", kCount, 6)) {
    const Proven proven = solve_certified(problem);
    ASSERT_EQ(proven.solution.status, Status::relaxed) << text_of(problem);
    ASSERT_LE(proven.certificate->contradiction.size(), 3u);
    ++contradictions;
    Problem fewer = problem;
    fewer.constraints.erase(fewer.constraints.begin() + proven.certificate->contradiction.front().binding.index);
    if (solve_certified(fewer).solution.status == Status::relaxed) {
      EXPECT_LT(solve_certified(fewer).solution.violation, proven.solution.violation) << text_of(problem);
    }
  }
  EXPECT_EQ(contradictions, static_cast<int>(kCount));
}

TEST(Properties, TheWitnessAloneContradicts) {
  std::size_t pairs = 0;
  for (const Problem& problem : generate("RI10", kCount, 6)) {
    const Proven proven = solve_certified(problem);
    Problem witness = problem;
    witness.constraints.clear();
    for (const Term& term : proven.certificate->contradiction)
      if (!is_speed_bound(term.binding)) witness.constraints.push_back(problem.constraints[term.binding.index]);
    EXPECT_EQ(solve_certified(witness).solution.status, Status::relaxed) << text_of(problem);
    if (witness.constraints.size() < 3) continue;
    for (std::size_t k = 0; k < 3; ++k) {  // three lines whose normals balance: any two of them leave room far away
      Problem pair = witness;
      pair.bound.disc = std::numeric_limits<double>::infinity();
      pair.constraints.erase(pair.constraints.begin() + static_cast<std::ptrdiff_t>(k));
            EXPECT_EQ(solve_certified(pair).solution.status, Status::optimal) << text_of(pair);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 100u);
}

TEST(Properties, AnswersHoldExactlyAndTwiceTheSame) {
  for (const Problem& problem : mixture()) {
    const Proven once = solve_certified(problem), again = solve_certified(problem);
    EXPECT_EQ(once.solution.velocity, again.solution.velocity);
    EXPECT_EQ(check(problem, *once.certificate), CertificateError::none) << text_of(problem);
  }
}

TEST(Properties, AMillionConstraintsEnd) {
  Problem problem;
  problem.bound.disc = 2.0;
  problem.preferred = {1.5, 0.5};
  constexpr int kMillion = 1000000;
  for (int k = 0; k < kMillion; ++k) {
    const double angle = 6.283185307179586 * k / kMillion;
    problem.constraints.push_back({{{std::cos(angle), std::sin(angle)}, -1.0}, Priority::soft, k});
  }
  const Proven proven = solve_certified(problem);  // tangents of the unit circle
  EXPECT_EQ(proven.solution.status, Status::optimal);
  EXPECT_NEAR(norm(proven.solution.velocity), 1.0, 1e-11);
}

}  // namespace
}  // namespace exactvo::lp
