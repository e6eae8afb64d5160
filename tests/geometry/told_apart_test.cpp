// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/told_apart.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

using Words = std::pair<std::string, std::string>;

TEST(ToldApart, HasTheFewestDigitsThatShowTheDifference) {
  EXPECT_EQ(told_apart(0.25, 0.4), (Words{"0.25", "0.4"}));
  EXPECT_EQ(told_apart(0.9999, 1.0), (Words{"0.9999", "1"}));
  EXPECT_EQ(told_apart(7.0, 7.00000001, 6), (Words{"7", "7.00000001"}));
  EXPECT_EQ(told_apart(1.0, std::nextafter(1.0, 2.0)), (Words{"1", "1.0000000000000002"}));
}

TEST(ToldApart, SaysNoDifferenceThatRoundingHasTurnedRound) {
  EXPECT_EQ(told_apart(2.0, 2.0), (Words{"less than 2", "2"}));
  EXPECT_EQ(told_apart(10.2298659060, 10.2298659056), (Words{"less than 10.2298659056", "10.2298659056"}));
  EXPECT_EQ(told_apart(std::nan(""), 1.0), (Words{"less than 1", "1"}));
}

TEST(ToldApart, TheWordsAreAsDifferentAsTheNumbersAtEveryScale) {
  test::SeededRandom random(test::seed_of_run(7));
  int judged = 0;
  for (int k = 0; k < 3000; ++k) {
    const double scale = std::pow(10.0, random.uniform(-9.0, 9.0));
    const double less = scale * random.uniform(-1.0, 1.0);
    const double more = less + scale * std::pow(10.0, random.uniform(-17.0, 0.0));
    const auto [a, b] = told_apart(less, more);
    if (!(less < more)) continue;
    ++judged;
    EXPECT_LT(std::stod(a), std::stod(b)) << a << " and " << b;
    EXPECT_NEAR(std::stod(a), less, 0.01 * std::fabs(less));
    EXPECT_NEAR(std::stod(b), more, 0.01 * std::fabs(more));
  }
  EXPECT_GT(judged, 2000);
}

TEST(Lossless, ReadsBackToTheSameDouble) {
  EXPECT_EQ(lossless(0.1), "0.1");
  EXPECT_EQ(lossless(1e6), "1000000");
  EXPECT_EQ(lossless(-1e-10), "-1e-10");
  test::SeededRandom random(test::seed_of_run(8));
  for (int k = 0; k < 1000; ++k) {
    const double x = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-12.0, 12.0));
    EXPECT_EQ(std::stod(lossless(x)), x);
  }
}

}  // namespace
}  // namespace exactvo::geometry
