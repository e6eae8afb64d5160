// SPDX-License-Identifier: GPL-3.0-or-later
// `check` accepts what is right and rejects what was tampered with.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/sets/generated_sets.h"
#include "problem_text.h"
#include "support/seeded_random.h"

namespace exactvo::lp {
namespace {

std::vector<Problem> problems() {
  std::vector<Problem> all = generate("RF10", 2500, 11);
  const std::vector<Problem> infeasible = generate("RI10", 2500, 12);
  all.insert(all.end(), infeasible.begin(), infeasible.end());
  for (std::size_t k = 1; k < all.size(); k += 2)
    for (Constraint& c : all[k].constraints) c.priority = Priority::hard;
  return all;
}

/// Corruptions that must void any certificate they apply to; false where one does not apply.
using Corruption = bool (*)(const Problem&, Certificate&);

bool velocity_beyond_the_disc(const Problem& problem, Certificate& c) {
  c.velocity = c.velocity + Vec2{3.0 * problem.bound.disc, 0.0};
  return true;
}

bool velocity_worse_than_claimed(const Problem& problem, Certificate& c) {
  const Vec2 centre = {0.01, -0.02};
  if (norm(c.velocity - centre) < 1e-3 || (c.status == Status::optimal && c.bound.empty())) return false;
  c.velocity = c.velocity + 1e-3 * perp(c.velocity - problem.preferred);
  return c.status == Status::optimal && norm(c.velocity - problem.preferred) > 1e-3;
}

bool violation_understated(const Problem&, Certificate& c) {
  c.violation *= 0.5;
  return c.violation > 1e-9;
}

bool violation_overstated(const Problem&, Certificate& c) {
  c.violation += 1e-3;
  return c.status == Status::relaxed || c.status == Status::infeasible;
}

bool multiplier_negative(const Problem&, Certificate& c) {
  if (c.bound.empty()) return false;
  for (double& part : c.bound.front().multiplier) part = -part;
  return true;
}

bool multiplier_enlarged(const Problem&, Certificate& c) {
  if (c.bound.size() < 2) return false;
  for (double& part : c.bound.front().multiplier) part *= 4.0;
  return true;
}

bool multiplier_not_a_number(const Problem&, Certificate& c) {
  if (c.bound.empty()) return false;
  c.bound.front().multiplier = {std::nan("")};
  return true;
}

bool constraint_out_of_range(const Problem& problem, Certificate& c) {
  if (c.bound.empty()) return false;
  c.bound.front().binding = constraint_at(problem.constraints.size());
  return true;
}

bool bound_forgotten(const Problem&, Certificate& c) {
  if (c.bound.empty()) return false;
  c.bound.clear();
  return true;
}

bool contradiction_forgotten(const Problem&, Certificate& c) {
  if (c.contradiction.empty()) return false;
  c.contradiction.clear();
  return true;
}

bool status_embellished(const Problem&, Certificate& c) {
  if (c.status == Status::optimal) return false;
  c.status = Status::optimal;
  return true;
}

bool status_blackened(const Problem&, Certificate& c) {
  if (c.status != Status::optimal) return false;
  c.status = Status::relaxed;
  return true;
}

bool gap_negative(const Problem&, Certificate& c) {
  c.gap = -1e-3;
  return true;
}

constexpr std::array<Corruption, 13> kCorruptions = {velocity_beyond_the_disc,
                                                     velocity_worse_than_claimed,
                                                     violation_understated,
                                                     violation_overstated,
                                                     multiplier_negative,
                                                     multiplier_enlarged,
                                                     multiplier_not_a_number,
                                                     constraint_out_of_range,
                                                     bound_forgotten,
                                                     contradiction_forgotten,
                                                     status_embellished,
                                                     status_blackened,
                                                     gap_negative};

TEST(Certificate, EveryAnswerOfEverySolverIsAccepted) {
  for (const Problem& problem : problems()) {
    for (const Proven& proven : {solve_certified(problem), solve_exact(problem)}) {
      ASSERT_TRUE(proven.certificate.has_value()) << text_of(problem);
      EXPECT_EQ(check(problem, *proven.certificate), CertificateError::none) << text_of(problem);
      EXPECT_EQ(proven.certificate->status, proven.solution.status);
    }
  }
}

TEST(Certificate, EveryCorruptedOneIsRejected) {
  int corrupted = 0;
  for (const Problem& problem : problems()) {
    const Certificate sound = *solve_certified(problem).certificate;
    for (std::size_t k = 0; k < kCorruptions.size(); ++k) {
      Certificate c = sound;
      if (!kCorruptions[k](problem, c)) continue;
      ++corrupted;
      EXPECT_NE(check(problem, c), CertificateError::none) << "corruption " << k << '\n' << text_of(problem);
    }
  }
  EXPECT_GE(corrupted, 10000);
}

TEST(Certificate, AWrongVerdictCannotBeCertified) {
  for (const Problem& problem : generate("RI10", 200, 13)) {
    Solution lie = solve(problem);
    lie.status = Status::optimal;
    EXPECT_FALSE(certify(problem, lie).has_value());
    lie.status = Status::infeasible;  // there are no hard ones
    EXPECT_FALSE(certify(problem, lie).has_value());
  }
}

TEST(Certificate, ARegionWithoutInteriorIsProvenByItsVertex) {
  // x >= 1/3 and x <= 1/3 as 3x >= 1 and -3x >= -1: no double lies between, yet (1/3, 0) does.
  Problem problem;
  problem.bound.disc = 2.0;
  problem.preferred = {1.0, 0.0};
  problem.constraints = {{{{3.0, 0.0}, 1.0}, Priority::hard, 0}, {{{-3.0, 0.0}, -1.0}, Priority::hard, 1}};
  const Proven proven = solve_certified(problem);
  EXPECT_STREQ(name(proven.solution.status), "no-interior");
  EXPECT_TRUE(proven.exact_stage);
  EXPECT_NEAR(proven.solution.velocity.x, 1.0 / 3.0, 1e-15);
  ASSERT_TRUE(proven.certificate.has_value());
  EXPECT_EQ(check(problem, *proven.certificate), CertificateError::none);
  Certificate moved = *proven.certificate;
  moved.vertex = {};
  EXPECT_EQ(check(problem, moved), CertificateError::vertex);
}

Constraint constraint(Priority priority, Vec2 normal, double offset) {
  return {{normal, offset}, priority, -1};
}

bool is_proven_or_silent(const Problem& problem, const Proven& answer) {
  return is_finite(answer.solution.velocity) &&
         (!answer.certificate || check(problem, *answer.certificate) == CertificateError::none);
}

TEST(Certificate, NumbersFarApartGiveAProofOrNone) {
  Problem huge;  // a violation of inf - inf
  huge.objective = Objective::farthest;
  huge.bound.disc = 0x1.43fd02a309972p+564;
  huge.preferred = {0x1.d673761be27a2p+571, -0x1.65fd71901455cp-631};
  const Vec2 small = {-0x1.5045367855924p-728, -0x1.0e1509644a1ep-631};
  huge.constraints = {
      constraint(Priority::soft, small, -0x1.f761fe8addca2p+883),
      constraint(Priority::soft, -small, 0x1.f761fe8addca2p+883),
      constraint(Priority::soft, {0x1.f151cfed201a9p+777, 0x1.42dc79a18fcdap+642}, -0x1.8cfd75533f242p+475)};
  Problem apart;  // a crossing that is no double
  apart.preferred = {-28417566.017225374, 2.335975029368789e-49};
  const Vec2 steep = {-1.762205533793969e+75, -1.0129675143987567e-21};
  apart.constraints = {
      constraint(Priority::hard, steep, 6.994755766765499e+49),
      constraint(Priority::soft, {1.9406754535027833e-72, -1.914446205474168e-73}, 1.3162748800126783e+83),
      constraint(Priority::soft, -steep, -6.994755766765499e+49)};
  for (const Problem& problem : {huge, apart}) {
    EXPECT_TRUE(is_finite(solve(problem).velocity));
    EXPECT_TRUE(is_proven_or_silent(problem, solve_certified(problem)));
    EXPECT_TRUE(is_proven_or_silent(problem, solve_exact(problem)));
  }
}

TEST(Certificate, AnInfiniteViolationIsNotProven) {
  Problem problem;
  problem.bound.disc = 1.0;
  for (const double side : {1.0, -1.0})
    problem.constraints.push_back(constraint(Priority::soft, {side, 0.0}, std::numeric_limits<double>::max()));
  const std::array<ActiveConstraint, 3> both = {{{constraint_at(0), 1.0}, {constraint_at(1), 1.0}, {}}};
  EXPECT_FALSE(certify(problem, {{0.0, 0.0}, Status::relaxed, both, 2, 0.0}));
  EXPECT_FALSE(certify(problem, {{std::nan(""), 0.0}, Status::relaxed, both, 2, 0.0}));
}

// The exact multipliers left a gap of 7.1e-12 below the widest, 1.4e-11: 1.7e-15 times 4, 4 and so on stepped over it,
// and the bound that remained was 30 wide.
TEST(Certificate, OfALeastViolationWhereHardLinesCrossFarAwayIsTight) {
  Problem problem;
  problem.preferred = {2.2067721694595904, 2.416043541523261};
  problem.constraints = {constraint(Priority::hard, {0.9571279813485627, 0.28966537128145875}, 0.2998870687176116),
                         constraint(Priority::hard, {-0.9543472416109954, -0.2986994181940844}, -0.15717084720552843),
                         constraint(Priority::soft, {-0.2124139349107307, 0.9771797788819312}, -0.23601460684345743)};
  for (const Proven& answer : {solve_certified(problem), solve_exact(problem)}) {
    EXPECT_STREQ(name(answer.solution.status), "relaxed");
    ASSERT_TRUE(answer.certificate.has_value());
    EXPECT_EQ(check(problem, *answer.certificate), CertificateError::none);
    EXPECT_LE(answer.certificate->gap, 1e-11);
    EXPECT_TRUE(is_tight(problem, *answer.certificate));
  }
}

// Two hard lines cross at an angle of 2 to 2e-4 and are the only bound; what a soft line asks for lies beyond. The
// velocity lay farther from where they cross than it had to, and below an angle of 5e-3 the gap showed it.
TEST(Certificate, OfALeastViolationInANeedleIsTight) {
  test::SeededRandom random(test::seed_of_run(83));
  for (int k = 0; k < 2000; ++k) {
    const double along = random.uniform(-3.2, 3.2), half = std::pow(10.0, random.uniform(-4.0, 0.0));
    const auto line = [&](Priority priority, double angle) {
      return constraint(priority, {std::cos(angle), std::sin(angle)}, random.uniform(-1.0, 1.0));
    };
    constexpr double kRight = 1.5707963267948966;
    Problem problem;
    problem.preferred = {random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)};
    problem.constraints = {line(Priority::hard, along + kRight - half), line(Priority::hard, along - kRight + half),
                           line(Priority::soft, along + 3.1415926 + random.uniform(-0.9, 0.9) * half)};
    for (const Proven& answer : {solve_certified(problem), solve_exact(problem)}) {
      ASSERT_TRUE(answer.certificate.has_value()) << text_of(problem);
      EXPECT_EQ(check(problem, *answer.certificate), CertificateError::none) << text_of(problem);
      EXPECT_TRUE(is_tight(problem, *answer.certificate))
          << half << ' ' << answer.certificate->gap << ' ' << answer.certificate->violation << text_of(problem);
    }
  }
}

TEST(Certificate, FlawsHaveNames) {
  EXPECT_STREQ(name(CertificateError::contradiction), "contradiction");
}

TEST(Certificate, APreferenceWhoseSquareOverflowsIsAimedAt) {
  Problem p;
  p.bound.disc = 1.0;
  p.preferred = {1e200, 1e200};
  p.constraints.push_back({{{1.0, 0.0}, -0.9}, Priority::soft, -1});
  for (const Proven& answer : {solve_certified(p), solve_exact(p)}) {
    EXPECT_STREQ(name(answer.solution.status), "optimal");
    EXPECT_NEAR(answer.solution.velocity.x, std::sqrt(0.5), 1e-14);
    EXPECT_NEAR(answer.solution.velocity.y, std::sqrt(0.5), 1e-14);
    EXPECT_TRUE(!answer.certificate || check(p, *answer.certificate) == CertificateError::none);
  }
}

}  // namespace
}  // namespace exactvo::lp
