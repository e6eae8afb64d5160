// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of 106 bits and what certificates leave open in them, held against integers of any length.
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/proof/double_double.h"
#include "lp/proof/exact_points.h"
#include "lp/proof/rounded_gap.h"
#include "lp/sets/generated_sets.h"
#include "problem_text.h"
#include "support/seeded_random.h"

namespace exactvo::lp {
namespace {

using geometry::kInfinity;

Exact exact(const DoubleDouble& x) {
  return Exact(x.high) + Exact(x.low);
}

Exact magnitude(const Exact& x) {
  return sign_of(x) < 0 ? -x : x;
}

/// Whether `rounded` is within 16 u^2 of the exact result.
bool is_close(const DoubleDouble& rounded, const Exact& result) {
  return sign_of(magnitude(exact(rounded) - result) - Exact(0x1p-102) * magnitude(result)) <= 0;
}

DoubleDouble random_twofold(test::SeededRandom& random) {
  const double high = std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.uniform(-60.0, 60.0)));
  return sum_of_ordered(high, high * random.uniform(-1.0, 1.0) * 0x1p-53);
}

TEST(DoubleDouble, OperationsKeepTheirErrorBounds) {
  test::SeededRandom random(test::seed_of_run(20261));
  for (int k = 0; k < 100000; ++k) {
    const DoubleDouble a = random_twofold(random);
    // Every fourth nearly cancels.
    const DoubleDouble b =
        k % 4 ? random_twofold(random) : DoubleDouble(-a.high * (1.0 + random.uniform(-4.0, 4.0) * 0x1p-52));
    ASSERT_TRUE(is_close(a + b, exact(a) + exact(b))) << std::hexfloat << a.high << ' ' << a.low << ' ' << b.high;
    ASSERT_TRUE(is_close(a - b, exact(a) - exact(b))) << std::hexfloat << a.high << ' ' << a.low << ' ' << b.high;
    ASSERT_TRUE(is_close(a * b, exact(a) * exact(b))) << std::hexfloat << a.high << ' ' << a.low << ' ' << b.high;
  }
}

TEST(DoubleDouble, SumsAndProductsOfDoublesAreExact) {
  test::SeededRandom random(test::seed_of_run(20262));
  for (int k = 0; k < 100000; ++k) {
    const double a = random_twofold(random).high, b = random_twofold(random).high;
    ASSERT_EQ(sign_of(exact(two_sum(a, b)) - Exact(a) - Exact(b)), 0) << std::hexfloat << a << ' ' << b;
    ASSERT_EQ(sign_of(exact(two_product(a, b)) - Exact(a) * Exact(b)), 0) << std::hexfloat << a << ' ' << b;
  }
}

/// What proves an answer, as numbers to be varied.
struct Case {
  Problem problem;
  Multipliers multipliers;
  Scope scope = Scope::all_must_hold;
  Claim claim;
};

/// Multipliers of several parts cannot be said here.
bool is_plain(const Certificate& c) {
  bool plain = c.status != Status::no_interior;
  for (const Term& term : c.bound) plain = plain && term.multiplier.size() == 1;
  return plain;
}

Problem varied(Problem problem, std::size_t k) {
  if (k % 3 == 1) problem.bound.box_x = problem.bound.box_y = problem.bound.disc;
  if (k % 6 == 4) problem.bound.disc = kInfinity;
  if (k % 5 == 2 && problem.preferred != Vec2{}) problem.objective = Objective::farthest;
  if (k % 7 == 3)
    for (Constraint& c : problem.constraints) c.priority = Priority::hard;
  return problem;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  std::size_t k = 0;
  for (const char* set : {"RF10", "RI10", "corridor:1e-9", "concurrent:1e-15", "tangent:1e-12", "far:1e-7"}) {
    for (const Problem& given : generate(set, 1500, 5)) {
      const Problem problem = varied(given, k++);
      const auto certificate = solve_certified(problem).certificate;
      if (!certificate || !is_plain(*certificate)) continue;
      Case c{problem, {}, scope_of(certificate->status), {certificate->velocity, certificate->violation}};
      for (const Term& term : certificate->bound) c.multipliers.add(term.binding, term.multiplier.front());
      all.push_back(c);
    }
  }
  return all;
}

Combination combination_of(const Case& c) {
  std::vector<Term> terms;
  for (std::size_t k = 0; k < c.multipliers.count; ++k)
    terms.push_back({c.multipliers.binding[k], {c.multipliers.value[k]}});
  return combine(c.problem, terms, c.scope);
}

bool proves(const Case& c, double gap) {
  const Combination sum = combination_of(c);
  return c.scope == Scope::all_must_hold ? bounds_objective(c.problem, sum, c.claim.velocity, gap)
                                         : bounds_violation(c.problem, sum, c.claim.violation, gap);
}

/// Multipliers and claim, each a little off: by 1e-16 to 1e-1.
Case shaken(Case c, test::SeededRandom& random) {
  const double by = std::pow(10.0, random.uniform(-16.0, -1.0));
  const auto shake = [&](double x) { return x * (1.0 + by * random.uniform(-1.0, 1.0)); };
  for (std::size_t k = 0; k < c.multipliers.count; ++k) c.multipliers.value[k] = shake(c.multipliers.value[k]);
  c.claim = {{shake(c.claim.velocity.x), shake(c.claim.velocity.y)}, shake(c.claim.violation)};
  return c;
}

TEST(RoundedGap, EnclosesTheLeastGapThatProves) {
  test::SeededRandom random(test::seed_of_run(20263));
  std::size_t told = 0, asked = 0;
  for (const Case& right : cases()) {
    for (const Case& c : {right, shaken(right, random), shaken(right, random)}) {
      for (const Digits digits : {Digits::of_double, Digits::twice}) {
        const auto gap = rounded_gap(c.problem, c.multipliers, c.scope, c.claim, digits);
        ++asked;
        if (!gap) continue;
        ++told;
        ASSERT_LE(gap->low, gap->high);
        ASSERT_TRUE(proves(c, std::max(0.0, gap->high))) << text_of(c.problem) << gap->high;
        const double below = std::nextafter(gap->low, -kInfinity);
        const bool gives_way = c.scope != Scope::all_must_hold && below >= c.claim.violation;
        if (below >= 0.0 && !gives_way) {
          ASSERT_FALSE(proves(c, below)) << text_of(c.problem) << below;
        }
      }
    }
  }
  EXPECT_GT(asked, 50000u);
  EXPECT_GT(told, asked * 99 / 100);
}

TEST(RoundedGap, TwiceTheDigitsSettleWhatDoublesCannot) {
  std::size_t tight = 0, all = 0;
  for (const Case& c : cases()) {
    const auto rough = rounded_gap(c.problem, c.multipliers, c.scope, c.claim, Digits::of_double);
    const auto fine = rounded_gap(c.problem, c.multipliers, c.scope, c.claim, Digits::twice);
    if (!rough || !fine) continue;
    ++all;
    tight += fine->high - fine->low <= 0.5 * (rough->high - rough->low);
  }
  EXPECT_GT(all, 5000u);
  EXPECT_GT(tight, all * 9 / 10);
}

TEST(RoundedSurplus, EnclosesWhatContradicts) {
  test::SeededRandom random(test::seed_of_run(20264));
  std::size_t positive = 0, negative = 0;
  for (const Case& right : cases()) {
    if (right.scope == Scope::all_must_hold) continue;
    for (const Case& c : {right, shaken(right, random)}) {
      const auto surplus = rounded_surplus(c.problem, c.multipliers, c.scope);
      if (!surplus) continue;
      const bool contradicting = contradicts(c.problem, combination_of(c));
      if (surplus->low > 0.0) {
        ASSERT_TRUE(contradicting) << text_of(c.problem);
      }
      if (surplus->high <= 0.0) {
        ASSERT_FALSE(contradicting) << text_of(c.problem);
      }
      positive += surplus->low > 0.0;
      negative += surplus->high <= 0.0;
    }
  }
  EXPECT_GT(positive, 1000u);
  EXPECT_GT(negative, 10u);
}

TEST(RoundedGap, SaysNothingOfNumbersOutOfRange) {
  Case c{generate("RF10", 1, 1).front(), {}, Scope::all_must_hold, {}};
  c.claim.velocity = c.problem.preferred;
  ASSERT_TRUE(rounded_gap(c.problem, c.multipliers, c.scope, c.claim, Digits::twice));
  for (const double odd : {0x1p-151, -0x1p151, 1e300, 5e-324}) {
    Case other = c;
    other.claim.velocity.x = odd;
    EXPECT_FALSE(rounded_gap(other.problem, other.multipliers, other.scope, other.claim, Digits::twice)) << odd;
    other = c;
    other.problem.constraints[3].half_plane.offset = odd;
    other.multipliers.add(constraint_at(3), 1.0);
    EXPECT_FALSE(rounded_gap(other.problem, other.multipliers, other.scope, other.claim, Digits::twice)) << odd;
  }
}

}  // namespace
}  // namespace exactvo::lp
