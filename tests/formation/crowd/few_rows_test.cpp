// SPDX-License-Identifier: GPL-3.0-or-later
// The motion nearest to a wish where one row binds or two, against the linear program and in whole numbers.
#include "crowd/few_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactvo/vo/lp/solve.h"
#include "lp/sets/target.h"
#include "support/seeded_random.h"

namespace exactvo::formation::crowd {
namespace {

using test::SeededRandom;

constexpr double kNormal = 0x1p20, kFar = 1e5;

std::int32_t whole_in(SeededRandom& random, double most) {
  return static_cast<std::int32_t>(std::lround(random.uniform(-most, most)));
}

/// Rows that rest satisfies; some twice, some opposite to another.
FewRows random_rows(SeededRandom& random) {
  FewRows rows;
  rows.wish = {whole_in(random, 0.7 * kFar), whole_in(random, 0.7 * kFar)};
  rows.squared_disc = kFar * kFar;
  rows.squared_way = kFar * kFar * (random.integer(0, 3) == 0 ? 0.25 : 1.0);
  const int count = random.integer(1, 16);
  for (int k = 0; k < count; ++k) {
    if (k > 0 && random.integer(0, 7) == 0) {
      rows.add(random.integer(0, 1) == 0 ? 1.0 : -1.0, rows.x[0], rows.y[0], rows.least[0]);
      continue;
    }
    const double angle = random.uniform(0.0, 6.2831853);
    rows.add(random.integer(0, 1) == 0 ? 1.0 : -1.0, std::round(kNormal * std::cos(angle)),
             std::round(kNormal * std::sin(angle)), -std::round(random.uniform(0.0, 0.8 * kFar) * kNormal));
  }
  return rows;
}

bool all_allow(const FewRows& rows, Motion m) {
  bool all = true;
  for (std::size_t k = 0; k < rows.count; ++k)
    all &= MotionRow{static_cast<std::int64_t>(rows.x[k]), static_cast<std::int64_t>(rows.y[k]),
                     static_cast<std::int64_t>(rows.least[k])}
               .allows(m);
  return all;
}

double distance(Motion m, double x, double y) {
  return std::hypot(m.x - x, m.y - y);
}

/// How far the linear program's answer for the rows, moved inward, is from the wish; negative: it has none.
double distance_of_program(const FewRows& rows) {
  lp::Problem problem;
  problem.bound.disc = kFar;
  problem.preferred = {static_cast<double>(rows.wish.x), static_cast<double>(rows.wish.y)};
  for (std::size_t k = 0; k < rows.count; ++k) {
    const double length = std::hypot(rows.x[k], rows.y[k]);
    problem.constraints.push_back(
        {{{rows.x[k] / length, rows.y[k] / length}, rows.least[k] / length + kHalfDiagonal}, lp::Priority::hard, -1});
  }
  const lp::Solution s = lp::solve(problem);
  return s.status == lp::Status::optimal ? distance(rows.wish, s.velocity.x, s.velocity.y) : -1.0;
}

TEST(FewRows, AllowedMotionsSatisfyAllRowsAndAreAsNearAsTheLinearProgramsOnEveryTarget) {
  SeededRandom random(test::seed_of_run(81));
  std::size_t allowed = 0, moved = 0, too_far = 0, not_found = 0, targets = 0;
  for (int k = 0; k < 20000; ++k) {
    const FewRows given = random_rows(random);
    FewRows rows = given;
    Motion m;
    const Few found = nearest_of_few(rows, m);
    for (const char* target : {"AVX3", "AVX2", "SSE4", "SSE2"}) {
      if (!lp::limit_batch_target(target)) continue;  // not on this machine
      targets += k == 0;
      FewRows again = given;
      Motion its;
      ASSERT_EQ(nearest_of_few(again, its), found) << k << ' ' << target;
      if (found != Few::not_found) {
        ASSERT_TRUE(its == m) << k << ' ' << target;
      }
    }
    lp::limit_batch_target("");
    too_far += found == Few::not_allowed;
    not_found += found == Few::not_found;
    if (found != Few::allowed) continue;
    ++allowed;
    ASSERT_TRUE(all_allow(given, m)) << k;
    if (m == given.wish) continue;
    ++moved;
    ASSERT_FALSE(all_allow(given, given.wish)) << k;
    ASSERT_LE(1.0 * m.x * m.x + 1.0 * m.y * m.y, given.squared_way) << k;
    const double best = distance_of_program(given);
    ASSERT_GE(best, 0.0) << k;
    ASSERT_NEAR(distance(m, given.wish.x, given.wish.y), best, 1.0) << k;
  }
  EXPECT_GT(allowed, 8000U);
  EXPECT_GT(moved, 4000U);
  EXPECT_GT(too_far, 100U);
  EXPECT_GT(not_found, 300U);
  EXPECT_GT(targets, 1U);
}

/// Which robots come first in a list of pairs depends on how robots are divided among threads.
TEST(FewRows, TheOrderOfRowsChangesNothing) {
  SeededRandom random(test::seed_of_run(82));
  std::size_t changed = 0;
  for (int k = 0; k < 20000; ++k) {
    FewRows rows = random_rows(random), other = rows;
    std::reverse(other.x, other.x + other.count);
    std::reverse(other.y, other.y + other.count);
    std::reverse(other.least, other.least + other.count);
    Motion m, its;
    const Few found = nearest_of_few(rows, m);
    ASSERT_EQ(nearest_of_few(other, its), found) << k;
    if (found == Few::not_found) continue;
    ASSERT_TRUE(m == its) << k;
    changed += m != rows.wish;
  }
  EXPECT_GT(changed, 4000U);
}

}  // namespace
}  // namespace exactvo::formation::crowd
