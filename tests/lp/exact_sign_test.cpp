// SPDX-License-Identifier: GPL-3.0-or-later
// Signs of violations and of excess speeds, against rationals: on the line and the circle, next to them, and where
// products leave the range in which they are sums of two doubles.
#include "lp/problem/exact_sign.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/seeded_random.h"

namespace exactvo::lp {
namespace {

int exact_violation(const HalfPlane& h, Vec2 v) {
  return sgn(
      mpq_class(mpq_class(h.offset) - mpq_class(h.normal.x) * mpq_class(v.x) - mpq_class(h.normal.y) * mpq_class(v.y)));
}

int exact_excess(Vec2 v, double radius) {
  return sgn(mpq_class(mpq_class(v.x) * mpq_class(v.x) + mpq_class(v.y) * mpq_class(v.y) -
                       mpq_class(radius) * mpq_class(radius)));
}

double nudged(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, std::numeric_limits<double>::infinity());
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -std::numeric_limits<double>::infinity());
  return x;
}

TEST(LpExactSign, NextToTheLineAndTheCircleItIsThatOfTheRationals) {
  test::SeededRandom random(test::seed_of_run(71));
  int ties = 0, close = 0;
  for (int k = 0; k < 200000; ++k) {
    // Short numbers make ties.
    const double unit = k % 2 == 0 ? 0.0 : std::ldexp(1.0, -random.integer(0, 20));
    const auto number = [&](double x) { return unit > 0.0 ? unit * std::nearbyint(x / unit) : x; };
    const double size = std::ldexp(1.0, random.integer(-3, 3) * (k % 5 == 0 ? 60 : 1));
    const Vec2 v = size * Vec2{number(random.uniform(-4.0, 4.0)), number(random.uniform(-4.0, 4.0))};
    const Vec2 normal{number(random.uniform(-1.0, 1.0)), number(random.uniform(-1.0, 1.0))};
    const HalfPlane h{normal, nudged(normal.x * v.x + normal.y * v.y, random.integer(-2, 2))};
    const int violation = exact_violation(h, v);
    ASSERT_EQ(sign_of_violation(h, v), violation)
        << std::hexfloat << normal.x << " " << normal.y << " " << h.offset << " " << v.x << " " << v.y;
    const double radius = std::fabs(nudged(norm(v), random.integer(-1, 1)));
    const int excess = exact_excess(v, radius);
    ASSERT_EQ(sign_of_excess_speed(v, radius), excess) << std::hexfloat << v.x << " " << v.y << " " << radius;
    ties += (violation == 0) + (excess == 0);
    close += violation != 0;
  }
  EXPECT_GT(ties, 1000);
  EXPECT_GT(close, 1000);
}

TEST(LpExactSign, IsRightAtTheEndsOfTheRangeOfDoubles) {
  test::SeededRandom random(test::seed_of_run(72));
  const auto number = [&] {
    const int kind = random.integer(0, 5);
    if (kind == 0) return 0.0;
    if (kind == 1) return std::numeric_limits<double>::denorm_min() * random.integer(-3, 3);
    return std::ldexp(random.uniform(-1.0, 1.0), random.integer(-540, 500));
  };
  for (int k = 0; k < 100000; ++k) {
    const Vec2 v{number(), number()}, normal{number(), number()};
    const HalfPlane h{normal, k % 2 == 0 ? number() : nudged(normal.x * v.x + normal.y * v.y, random.integer(-1, 1))};
    ASSERT_EQ(sign_of_violation(h, v), exact_violation(h, v))
        << std::hexfloat << normal.x << " " << normal.y << " " << h.offset << " " << v.x << " " << v.y;
    const double radius =
        k % 2 == 0 ? std::fabs(number()) : std::fabs(nudged(std::hypot(v.x, v.y), random.integer(-1, 1)));
    ASSERT_EQ(sign_of_excess_speed(v, radius), exact_excess(v, radius))
        << std::hexfloat << v.x << " " << v.y << " " << radius;
  }
}

}  // namespace
}  // namespace exactvo::lp
