// SPDX-License-Identifier: GPL-3.0-or-later
// Predicate F (the trap test) against 600-bit roots, and orientation against rationals.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <stdexcept>

#include "geometry/exact_oracle.h"
#include "geometry/random_grown.h"

namespace exactvo::test {
namespace {

using geometry::Ellipse;
using geometry::goal_outside_evolute;
using geometry::orientation;
using geometry::Sign;
using geometry::Vec2;

constexpr mpfr_prec_t kBits = 600;

/// A number of 600 bits; enough of MPFR for one formula.
class Wide {
 public:
  Wide(double v = 0.0) {  // NOLINT(google-explicit-constructor): a double is exact
    mpfr_init2(x_, kBits);
    mpfr_set_d(x_, v, MPFR_RNDN);
  }
  Wide(const Wide& o) {
    mpfr_init2(x_, kBits);
    mpfr_set(x_, o.x_, MPFR_RNDN);
  }
  Wide& operator=(const Wide& o) {
    mpfr_set(x_, o.x_, MPFR_RNDN);
    return *this;
  }
  ~Wide() { mpfr_clear(x_); }
  friend Wide operator+(const Wide& a, const Wide& b) { return with(mpfr_add, a, b); }
  friend Wide operator-(const Wide& a, const Wide& b) { return with(mpfr_sub, a, b); }
  friend Wide operator*(const Wide& a, const Wide& b) { return with(mpfr_mul, a, b); }
  friend Wide operator/(const Wide& a, const Wide& b) { return with(mpfr_div, a, b); }
  Wide root() const {
    Wide r;
    mpfr_sqrt(r.x_, x_, MPFR_RNDN);
    return r;
  }
  /// |x|^(2/3)
  Wide two_thirds() const {
    const Wide s = *this * *this;
    Wide r;
    mpfr_cbrt(r.x_, s.x_, MPFR_RNDN);
    return r;
  }
  double rounded() const { return mpfr_get_d(x_, MPFR_RNDN); }

 private:
  static Wide with(int (*f)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t), const Wide& a, const Wide& b) {
    Wide r;
    f(r.x_, a.x_, b.x_, MPFR_RNDN);
    return r;
  }
  mpfr_t x_;
};

/// (a|gx|)^(2/3) + (b|gy|)^(2/3) - (1 + slack) (a^2 - b^2)^(2/3) by the eigenvectors of Sigma; (1 + slack)^3 rounded as
/// the header says. Relative to the last term.
double margin_of_test(const Ellipse& e, Vec2 goal, double slack) {
  const Wide l11(e.l11), l21(e.l21), l22(e.l22);
  const Wide s11 = l11 * l11, s12 = l11 * l21, s22 = l21 * l21 + l22 * l22;
  const Wide half(0.5), gap = half * (s11 - s22), mean = half * (s11 + s22);
  const Wide root = (gap * gap + s12 * s12).root();
  const Wide a2 = mean + root, b2 = mean - root;
  Wide vx = s12, vy = a2 - s11;
  if (gap.rounded() >= 0.0) {
    vx = a2 - s22;
    vy = s12;
  }
  const Wide length = (vx * vx + vy * vy).root();
  const Wide ux = Wide(goal.x) - Wide(e.center.x), uy = Wide(goal.y) - Wide(e.center.y);
  const Wide gx = (ux * vx + uy * vy) / length, gy = (uy * vx - ux * vy) / length;
  const double factor = (1.0 + slack) * (1.0 + slack) * (1.0 + slack);
  Wide f;
  {
    const Wide cube(factor);
    f = cube.root().two_thirds();  // factor^(1/3)
  }
  const Wide right = f * (a2 - b2).two_thirds();
  const Wide left = (a2.root() * gx).two_thirds() + (b2.root() * gy).two_thirds();
  return ((left - right) / right).rounded();
}

TEST(GoalOutsideEvolute, AgreesWithRootsOf600Bits) {
  SeededRandom random(seed_of_run(31));
  int outside = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec2 centre = random.in_box(i % 3 == 0 ? 1e5 : 2.0);
    const Ellipse e = geometry::ellipse_from_axes(
        centre, {random.uniform(0.5, 3.0), random.uniform(0.01, 0.5), random.uniform(-1.5, 1.5)});
    const Vec2 goal = centre + random.in_box(8.0);
    const double slack = i % 2 == 0 ? 0.0 : random.uniform(0.0, 0.6);
    const double margin = margin_of_test(e, goal, slack);
    ASSERT_GT(std::fabs(margin), 1e-100) << "random input does not hit the evolute";
    ASSERT_EQ(goal_outside_evolute(e, goal, slack), margin > 0.0) << geometry::to_string(geometry::ConvexShape{e});
    outside += margin > 0.0;
  }
  EXPECT_GT(outside, 10000);
  EXPECT_LT(outside, 90000);
}

TEST(GoalOutsideEvolute, GoalsOnTheEvoluteAreNotOutsideAndAnUlpDecides) {
  SeededRandom random(seed_of_run(32));
  for (int i = 0; i < 10000; ++i) {
    // On it at ((a^2 - b^2)/a cos^3, (a^2 - b^2)/b sin^3) for a = 2 h^3 u, b = h^3 u.
    const Pythagorean n = random_pythagorean(random);
    const double unit = std::ldexp(1.0, random.integer(-40, 10));
    const double h3 = n.h * n.h * n.h;
    const Vec2 goal{1.5 * n.p * n.p * n.p * unit, 3.0 * n.q * n.q * n.q * unit};
    const Ellipse flat{{0, 0}, 2.0 * h3 * unit, 0.0, h3 * unit};
    ASSERT_FALSE(goal_outside_evolute(flat, goal)) << n.p << " " << n.q;
    ASSERT_TRUE(goal_outside_evolute(flat, {goal.x + std::copysign(0x1p-52 * std::fabs(goal.x), goal.x), goal.y}));
    ASSERT_FALSE(goal_outside_evolute(flat, {std::nextafter(goal.x, 0.0), goal.y}));
    const Ellipse upright{{0, 0}, h3 * unit, 0.0, 2.0 * h3 * unit};
    ASSERT_FALSE(goal_outside_evolute(upright, {goal.y, goal.x}));
  }
}

TEST(GoalOutsideEvolute, CirclesHaveNone) {
  EXPECT_TRUE(goal_outside_evolute({{1, 2}, 3, 0, 3}, {1, 2.0000000001}));
  EXPECT_FALSE(goal_outside_evolute({{1, 2}, 3, 0, 3}, {1, 2})) << "the centre is the evolute";
}

TEST(GoalOutsideEvolute, RequiresFiniteNumbers) {
  const Ellipse e{{0, 0}, 2, 0, 1};
  EXPECT_THROW(goal_outside_evolute(e, {std::nan(""), 0}), std::logic_error);
  EXPECT_THROW(goal_outside_evolute(e, {1, 0}, -0.1), std::logic_error);
  EXPECT_THROW(goal_outside_evolute({{std::nan(""), 0}, 2, 0, 1}, {1, 0}), std::logic_error);
}

Sign turn_of(Vec2 a, Vec2 b, Vec2 c) {
  return static_cast<Sign>(sgn(cross(minus(exactly(b), exactly(a)), minus(exactly(c), exactly(a)))));
}

TEST(Orientation, AgreesWithRationalsNearLines) {
  SeededRandom random(seed_of_run(33));
  for (int i = 0; i < 100000; ++i) {
    const Vec2 a = random.in_box(i % 2 == 0 ? 1.0 : 1e7), b = a + random.in_box(1.0);
    const Vec2 c =
        a + random.uniform(-2.0, 2.0) * (b - a) + std::pow(10.0, random.uniform(-18, 0)) * random.direction();
    ASSERT_EQ(orientation(a, b, c), turn_of(a, b, c));
  }
}

TEST(Orientation, CollinearGridPointsAreZero) {
  SeededRandom random(seed_of_run(34));
  for (int i = 0; i < 10000; ++i) {
    const double unit = std::ldexp(1.0, random.integer(-500, 300));
    const Vec2 d{static_cast<double>(random.integer(-99, 99)), static_cast<double>(random.integer(-99, 99))};
    const auto at = [&](int k) { return unit * (static_cast<double>(k) * d + Vec2{7, -3}); };
    ASSERT_EQ(orientation(at(random.integer(-9, 9)), at(random.integer(-9, 9)), at(random.integer(-9, 9))), Sign::zero);
  }
}

TEST(Orientation, Property4_CyclicAndAntisymmetric) {
  SeededRandom random(seed_of_run(35));
  for (int i = 0; i < 10000; ++i) {
    const Vec2 a = random.in_box(1.0), b = random.in_box(1.0), c = a + random.uniform(0, 1) * (b - a);
    const Sign s = orientation(a, b, c);
    ASSERT_EQ(orientation(b, c, a), s);
    ASSERT_EQ(static_cast<int>(orientation(c, b, a)), -static_cast<int>(s));
  }
}

TEST(Orientation, StagesAreCounted) {
  geometry::reset_stage_counts();
  orientation({0, 0}, {1, 0}, {0, 1});
  EXPECT_EQ(geometry::stage_counts().filter, 1u);
  orientation({0, 0}, {0.1, 0.1}, {0.3, 0.3});
  EXPECT_EQ(geometry::stage_counts().exact, 1u);
  EXPECT_THROW(orientation({std::nan(""), 0}, {1, 0}, {0, 1}), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
