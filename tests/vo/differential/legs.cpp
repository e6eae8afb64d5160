// SPDX-License-Identifier: GPL-3.0-or-later
// The certified brackets of an ellipse's legs against the roots of their quartic, isolated by CGAL's
// Algebraic_kernel_d_1.
#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>
#include <CGAL/CORE_BigRat.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "exactvo/vo/velocity_obstacle.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

using geometry::Ellipse;
using geometry::Vec2;
using Integer = CORE::BigInt;
using Kernel = CGAL::Algebraic_kernel_d_1<Integer>;

/// An ellipse (+) disc around the origin's neighbourhood, all integers: S is exact for the kernel and for doubles.
struct IntegerCase {
  int px, py, l11, l21, l22, r;
};

double value(int i) {
  return static_cast<double>(i);
}

vo::VelocityObstacle obstacle_of(const IntegerCase& c) {
  const Ellipse e{{value(c.px), value(c.py)}, value(c.l11), value(c.l21), value(c.l22)};
  return {e, {}, value(c.r), 1.0};
}

/// The half-angle tangents of the legs' normals, ascending: with n = (1 - s^2, 2 s), the roots of
/// (A + 2 B s + C s^2)^2 = |L^T n|^2 where A + 2 B s + C s^2 <= 0. A normal (-1, 0) is s = infinity.
std::vector<double> algebraic_legs(const IntegerCase& c) {
  const Integer A(c.px + c.r), B(c.py), C(c.r - c.px), two(2), four(4);
  const Integer l11(c.l11), l21(c.l21), l22(c.l22);
  const Integer s11 = l11 * l11, s12 = l11 * l21, s22 = l21 * l21 + l22 * l22;
  const Integer quartic[5] = {A * A - s11, four * (A * B - s12), four * B * B + two * A * C + two * s11 - four * s22,
                              four * (B * C + s12), C * C - s11};
  const Kernel kernel;
  std::vector<Kernel::Algebraic_real_1> roots;
  // Double roots occur (a leg through both conics' tangent), so the polynomial is not promised to be square-free.
  kernel.solve_1_object()(Kernel::Polynomial_1(quartic, quartic + 5), false, std::back_inserter(roots));
  std::vector<double> legs;
  // The side's absolute value is |L^T n| > 0, so its sign is plain in doubles. (The kernel's own sign_at breaks its
  // precondition low < high at rational roots in CGAL 5.5.)
  for (const Kernel::Algebraic_real_1& root : roots) {
    const double s = CGAL::to_double(root);
    if (value(c.px + c.r) + s * (2.0 * c.py + s * value(c.r - c.px)) < 0.0) legs.push_back(s);
  }
  return legs;
}

double angle_between(Vec2 n, double s) {
  const Vec2 m{1.0 - s * s, 2.0 * s};
  return std::fabs(std::atan2(cross(n, m), dot(n, m)));
}

bool has_same_legs(const IntegerCase& c) {
  const auto legs = obstacle_of(c).legs();
  const std::vector<double> roots = algebraic_legs(c);
  if (!legs || roots.empty() || roots.size() > 2) return false;
  // A bracket is some 100 u H / |h_S(m)| wide, m the direction of the tilt: below this until the robot is nearer to
  // contact than a hundred-thousandth of its distance, which integers of this size are not.
  constexpr double kWidth = 1e-9;
  for (const vo::Leg& leg : {legs->left, legs->right}) {
    if (roots.size() == 1 && std::fabs(leg.normal.y) < kWidth && leg.normal.x < 0.0) continue;  // s = infinity
    double nearest = 1.0;
    for (const double s : roots) nearest = std::min(nearest, angle_between(leg.normal, s));
    if (!(nearest < kWidth)) return false;
  }
  return true;
}

std::string text_of(const IntegerCase& c) {
  std::string text = "p, L, r of an ellipse in whole numbers:";
  for (const int x : {c.px, c.py, c.l11, c.l21, c.l22, c.r}) text += " " + std::to_string(x);
  return text;
}

IntegerCase random_case(SeededRandom& random, long i) {
  const int size = i % 2 == 0 ? 100 : 30000;
  return {random.integer(-4 * size, 4 * size),
          random.integer(-4 * size, 4 * size),
          random.integer(1, size),
          random.integer(-size, size),
          random.integer(1, size),
          random.integer(0, size)};
}

/// Small numbers: legs along the axes, double roots, a root at infinity.
IntegerCase constructed_case(SeededRandom& random) {
  return {random.integer(-9, 9), random.integer(-9, 9), random.integer(1, 4),
          random.integer(-2, 2), random.integer(1, 4),  random.integer(0, 3)};
}

}  // namespace

Tally compare_legs(const Asked& asked) {
  Tally tally;
  SeededRandom random(asked.seed);
  for (long i = 0; tally.random_cases() < asked.random; ++i) {
    const IntegerCase c = random_case(random, i);
    if (!obstacle_of(c).overlaps()) tally.random(has_same_legs(c), text_of(c));
  }
  while (tally.constructed_cases() < asked.constructed) {
    const IntegerCase c = constructed_case(random);
    if (!obstacle_of(c).overlaps()) tally.constructed(has_same_legs(c), text_of(c));
  }
  return tally;
}

}  // namespace exactvo::test
