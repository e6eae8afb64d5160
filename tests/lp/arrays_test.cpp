// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "decision/feasible.h"
#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/sets/generated_sets.h"
#include "lp/sets/target.h"
#include "problem_text.h"

namespace exactvo::lp {
namespace {

using bench::keeps;
using bench::solve_feasible;

/// A problem as arrays; what stands beyond its lines would forbid everything, if it were looked at.
class Arrays {
 public:
  explicit Arrays(const Problem& p) : disc_(p.bound.disc), preferred_(p.preferred), count_(p.constraints.size()) {
    const std::size_t padded = (count_ + kSinglePadding - 1) / kSinglePadding * kSinglePadding;
    x_.assign(padded, 1.0);
    y_.assign(padded, 0.0);
    offset_.assign(padded, 100.0);
    for (std::size_t k = 0; k < count_; ++k) {
      x_[k] = p.constraints[k].half_plane.normal.x;
      y_[k] = p.constraints[k].half_plane.normal.y;
      offset_[k] = p.constraints[k].half_plane.offset;
      hard_ += p.constraints[k].priority == Priority::hard;
    }
  }
  SingleProblem problem() const { return {x_.data(), y_.data(), offset_.data(), count_, hard_, preferred_, disc_}; }
  Solution solve() const {
    Solution answer;
    lp::solve(problem(), answer);
    return answer;
  }

 private:
  double disc_;
  Vec2 preferred_;
  std::size_t count_, hard_ = 0;
  std::vector<double> x_, y_, offset_;
};

std::vector<Problem> mixture() {
  std::vector<Problem> problems;
  for (const char* set : {"RF10", "RI10", "RF3", "RI20", "RF0", "RI3", "RF17", "RF60", "RI60", "RF63", "RF64"}) {
    const auto more = generate(set, 500, 31);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  for (std::size_t k = 0; k < problems.size(); k += 5)
    for (std::size_t j = 0; j < problems[k].constraints.size() / 3; ++j)
      problems[k].constraints[j].priority = Priority::hard;
  return problems;
}

TEST(Single, VerdictsAndCertificatesAreThoseOfTheCertifiedSolver) {
  for (const Problem& problem : mixture()) {
    const Solution s = Arrays(problem).solve();
    ASSERT_STREQ(name(s.status), name(solve_certified(problem).solution.status)) << text_of(problem);
    const auto certificate = certify(problem, s);
    ASSERT_TRUE(certificate.has_value()) << text_of(problem);
    ASSERT_EQ(check(problem, *certificate), CertificateError::none) << text_of(problem);
  }
}

/// Contradictions of which up to four lines are hard, as obstacles in a crowd are, and feasible problems with as many.
std::vector<Problem> among_walls() {
  std::vector<Problem> problems = generate("RI10", 1500, 33);
  for (const Problem& p : generate("RF10", 500, 34)) problems.push_back(p);
  for (std::size_t k = 0; k < problems.size(); ++k)
    for (std::size_t j = 0; j < k % 5; ++j) problems[k].constraints[j].priority = Priority::hard;
  return problems;
}

TEST(Single, AmongWallsNothingViolatesTheSoftLinesLess) {
  std::size_t relaxed = 0;
  for (const Problem& problem : among_walls()) {
    const Solution s = Arrays(problem).solve(), right = solve_certified(problem).solution;
    ASSERT_STREQ(name(s.status), name(right.status)) << text_of(problem);
    ASSERT_TRUE(certify(problem, s).has_value()) << text_of(problem);
    if (s.status != Status::relaxed) continue;
    ++relaxed;
    ASSERT_NEAR(s.violation, right.violation, 1e-11) << text_of(problem);
  }
  EXPECT_GT(relaxed, 1000U);
}

TEST(SingleCertified, AnswersAreProvenAndCarryTheirProof) {
  std::vector<Problem> problems = mixture();
  for (const Problem& p : among_walls()) problems.push_back(p);
  std::size_t by_own_multipliers = 0;
  for (const Problem& problem : problems) {
    const Arrays arrays(problem);
    Solution s;
    ASSERT_TRUE(solve_certified(arrays.problem(), s)) << text_of(problem);
    ASSERT_STREQ(name(s.status), name(solve_exact(problem).solution.status)) << text_of(problem);
    ASSERT_TRUE(s.status != Status::optimal || keeps(arrays.problem(), s.velocity)) << text_of(problem);
    by_own_multipliers += check(problem, claim_of(problem, s)) == CertificateError::none;
  }
  EXPECT_GE(1000 * by_own_multipliers, 999 * problems.size());
}

TEST(SingleCertified, OfEveryNumberOfLinesGivesTheBitsOfTheProblem) {
  std::size_t optimal = 0, relaxed = 0;
  for (std::size_t lines = 0; lines <= 65; ++lines)
    for (const char* family : {"RF", lines < 3 ? "RF" : "RI"})
      for (Problem& problem : generate(family + std::to_string(lines), 30, 7)) {
        for (std::size_t k = 0; k < lines / 3; ++k) problem.constraints[k].priority = Priority::hard;
        const Solution whole = solve(problem);
        Solution of_arrays;
        ASSERT_TRUE(solve_certified(Arrays(problem).problem(), of_arrays)) << text_of(problem);
        EXPECT_EQ(whole.velocity, of_arrays.velocity) << text_of(problem);
        EXPECT_EQ(whole.status, of_arrays.status) << text_of(problem);
        EXPECT_EQ(whole.violation, of_arrays.violation) << text_of(problem);
        optimal += whole.status == Status::optimal;
        relaxed += whole.status == Status::relaxed;
      }
  EXPECT_GT(optimal, 1000u);
  EXPECT_GT(relaxed, 500u);
}

TEST(SingleCertified, AdversarialVerdictsAreRight) {
  for (const std::string& family : adversarial_families()) {
    for (const char* perturbation : {"1e-6", "1e-9", "1e-12", "1e-15", "1e-17", "0"}) {
      for (const Problem& problem : generate(family + ":" + perturbation, 100, 8)) {
        Solution s;
        ASSERT_TRUE(solve_certified(Arrays(problem).problem(), s)) << text_of(problem);
        EXPECT_EQ(s.status == Status::relaxed, solve_exact(problem).solution.status == Status::relaxed)
            << text_of(problem);  // all soft: optimal and no_interior both say feasible
      }
    }
  }
}

TEST(Single, EveryTargetGivesTheSameBits) {
  std::vector<Solution> widest;
  for (const Problem& problem : mixture()) widest.push_back(Arrays(problem).solve());
  for (const char* target : {"AVX2", "SSE4", "SSE2"}) {
    if (!limit_batch_target(target)) continue;
    std::size_t i = 0;
    for (const Problem& problem : mixture()) {
      const Solution s = Arrays(problem).solve();
      EXPECT_EQ(s.velocity, widest[i].velocity) << target << text_of(problem);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(s.active[k].binding, widest[i].active[k].binding) << target;
        EXPECT_EQ(s.active[k].multiplier, widest[i].active[k].multiplier) << target;
      }
      EXPECT_EQ(s.violation, widest[i++].violation) << target;
    }
  }
  ASSERT_TRUE(limit_batch_target(""));
}

TEST(Single, SpeedsWhoseSquaresLeaveTheRangeOfANumberAreAnswered) {
  for (const auto& [preferred, disc] : {std::pair(1e200, 1.0), std::pair(1e-60, 1e-70)}) {
    Problem p;
    p.bound.disc = disc;
    p.preferred = {preferred, preferred};
    p.constraints.push_back({{{1.0, 0.0}, -0.9 * disc}, Priority::soft, -1});
    const Solution s = Arrays(p).solve();
    EXPECT_EQ(s.status, Status::optimal);
    EXPECT_NEAR(s.velocity.x / disc, std::sqrt(0.5), 1e-14);
    EXPECT_NEAR(s.velocity.y / disc, std::sqrt(0.5), 1e-14);
  }
}

TEST(Single, AnswersHoldExactlyWhereTheRegionIsNotThin) {
  for (const Problem& problem : generate("RF10", 2000, 32)) {
    const Solution s = Arrays(problem).solve();
    ASSERT_EQ(s.status, Status::optimal);
    EXPECT_LE(squared_norm(s.velocity), problem.bound.disc * problem.bound.disc);
    for (const Constraint& c : problem.constraints) EXPECT_LE(geometry::violation(c.half_plane, s.velocity), 0.0);
  }
}

TEST(Keeps, IsExactOnALineAndOneUlpBesideIt) {
  // Twelve lines: a whole register and a part of one. The last is the one that v lies on.
  for (const Vec2 v : {Vec2{0.1, 0.7}, Vec2{-1e-3, 0x1p-40}, Vec2{3.0, -4.0}}) {
    Problem p;
    p.bound.disc = 5.0;
    for (int k = 0; k < 11; ++k) p.constraints.push_back({{{1.0, 0.0}, -6.0 - k}, Priority::hard, -1});
    p.constraints.push_back({{{0.5, 1.0}, 0.5 * v.x + v.y}, Priority::hard, -1});
    const double rounded = p.constraints.back().half_plane.offset;
    // The products are exact; what their sum lost in rounding says on which side of the line v lies (Knuth's two-sum).
    const double y = rounded - 0.5 * v.x;
    const double lost = (0.5 * v.x - (rounded - y)) + (v.y - y);
    EXPECT_EQ(keeps(Arrays(p).problem(), v), lost >= 0.0);
    p.constraints.back().half_plane.offset = std::nextafter(rounded, 10.0);
    EXPECT_FALSE(keeps(Arrays(p).problem(), v));
    p.constraints.back().half_plane.offset = std::nextafter(rounded, -10.0);
    EXPECT_TRUE(keeps(Arrays(p).problem(), v));
  }
}

TEST(Keeps, IsExactOnTheDisc) {
  Problem p;
  p.bound.disc = 5.0;
  EXPECT_TRUE(keeps(Arrays(p).problem(), {3.0, -4.0}));
  EXPECT_FALSE(keeps(Arrays(p).problem(), {std::nextafter(3.0, 4.0), -4.0}));
  p.bound.disc = std::nextafter(5.0, 0.0);
  EXPECT_FALSE(keeps(Arrays(p).problem(), {3.0, -4.0}));
}

TEST(Keeps, HoldsOfEveryOptimumAndOfNoRelaxedAnswer) {
  for (const Problem& problem : mixture()) {
    const Arrays arrays(problem);
    const Solution s = arrays.solve();
    if (s.status == Status::no_interior) continue;
    ASSERT_EQ(keeps(arrays.problem(), s.velocity), s.status == Status::optimal) << text_of(problem);
  }
}

TEST(SolveKeeping, FindsTheOptimumOrNothing) {
  constexpr double kSame = 1e-9;  // m/s: slacks are of the order of 1e-15, corners magnify them
  std::size_t optimal = 0, missed = 0;
  for (const Problem& problem : mixture()) {
    const Arrays arrays(problem);
    const Solution s = arrays.solve();
    Vec2 v;
    const bool is_found = solve_feasible(arrays.problem(), v);
    optimal += s.status == Status::optimal;
    missed += s.status == Status::optimal && !is_found;
    if (!is_found) continue;
    ASSERT_EQ(s.status, Status::optimal) << text_of(problem);
    ASSERT_TRUE(keeps(arrays.problem(), v)) << text_of(problem);
    ASSERT_NEAR(norm(v - problem.preferred), norm(s.velocity - problem.preferred), kSame) << text_of(problem);
  }
  EXPECT_LE(1000 * missed, optimal) << missed << " of " << optimal;
}

TEST(SolveKeeping, SaysNoWhereNothingKeepsAll) {
  Vec2 v;
  for (const double gap : {0.5, 0.0}) {  // of the two walls
    Problem p;
    p.bound.disc = 2.0;
    p.preferred = {1.0, 0.0};
    p.constraints.push_back({{{1.0, 0.0}, gap}, Priority::hard, -1});
    p.constraints.push_back({{{-1.0, 0.0}, 0.0}, Priority::hard, -1});
    EXPECT_FALSE(solve_feasible(Arrays(p).problem(), v)) << gap;
    p.constraints.assign(20, p.constraints.front());
    p.constraints.push_back({{{-1.0, 0.0}, 0.0}, Priority::hard, -1});
    EXPECT_EQ(solve_feasible(Arrays(p).problem(), v), gap == 0.0) << "many lines: exact arithmetic finds the point";
  }
}

TEST(SolveKeeping, SquaresBeyondDoublesTakeTheLongWay) {
  Problem p;
  p.bound.disc = 2.0;
  p.preferred = {1e160, 0.0};
  Vec2 v;
  ASSERT_TRUE(solve_feasible(Arrays(p).problem(), v));
  EXPECT_NEAR(v.x, 2.0, 1e-12);
  p.bound.disc = 1e160;
  p.preferred = {0.0, 0.0};
  p.constraints.push_back({{{1.0, 0.0}, 1e157}, Priority::hard, -1});
  ASSERT_TRUE(solve_feasible(Arrays(p).problem(), v));
  EXPECT_NEAR(v.x, 1e157, 1e146);
}

}  // namespace
}  // namespace exactvo::lp
