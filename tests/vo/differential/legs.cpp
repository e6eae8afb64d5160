// SPDX-License-Identifier: GPL-3.0-or-later
// The certified brackets of an ellipse's legs, and the legs as algebraic numbers, against the roots of their quartic,
// isolated by CGAL's Algebraic_kernel_d_1; and the order of two cones' legs against the kernel's.
#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>
#include <CGAL/CORE_BigRat.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
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

/// Whether the normal (-1, 0) is a leg's, s = infinity: the leading coefficient C^2 - l11^2 is nothing, and C < 0.
bool has_leg_at_infinity(const IntegerCase& c) {
  const Integer C(c.r - c.px), l11(c.l11);
  return C < Integer(0) && C * C - l11 * l11 == Integer(0);
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
    if (has_leg_at_infinity(c) && std::fabs(leg.normal.y) < kWidth && leg.normal.x < 0.0) continue;
    double nearest = 1.0;
    for (const double s : roots) nearest = std::min(nearest, angle_between(leg.normal, s));
    if (!(nearest < kWidth)) return false;
  }
  return true;
}

// --- The algebraic numbers themselves ---

using Real = Kernel::Algebraic_real_1;

/// The kernel's root for the leg's slope: of the leg's own polynomial, the only one in its interval. Nothing where the
/// kernel finds another number of them.
std::optional<Real> slope_of(const vo::AlgebraicDirection& leg) {
  std::vector<Integer> f;
  for (const std::string& c : leg.polynomial()) f.emplace_back(c);
  const Kernel kernel;
  std::vector<Real> all, inside;
  kernel.solve_1_object()(Kernel::Polynomial_1(f.begin(), f.end()), true, std::back_inserter(all));
  const auto side = [&](const Real& root, const std::string& bound) {
    return kernel.compare_1_object()(root, Kernel::Bound(bound.c_str()));
  };
  for (const Real& root : all)
    if (side(root, leg.low()) != CGAL::SMALLER && side(root, leg.high()) != CGAL::LARGER) inside.push_back(root);
  if (inside.size() != 1) return std::nullopt;
  return inside.front();
}

/// Whether an outward normal, of the half-angle formula, is that of the leg; of both of them one must be.
bool is_among(Vec2 normal, const std::vector<double>& roots, bool also_at_infinity) {
  constexpr double kRounded = 1e-14;  // both sides are doubles of numbers that are known exactly
  if (also_at_infinity && std::fabs(normal.y) < kRounded && normal.x < 0.0) return true;
  return std::any_of(roots.begin(), roots.end(), [&](double s) { return angle_between(normal, s) < kRounded; });
}

bool has_same_exact_legs(const IntegerCase& c) {
  const auto legs = obstacle_of(c).exact_legs();
  const std::vector<double> roots = algebraic_legs(c);
  if (!legs || !slope_of(legs->left) || !slope_of(legs->right)) return false;
  const bool at_infinity = has_leg_at_infinity(c);
  return is_among(perp(legs->left.rounded()), roots, at_infinity) &&
         is_among(-perp(legs->right.rounded()), roots, at_infinity);
}

/// Any two legs within a quarter are ordered as their slopes.
bool has_same_order(const IntegerCase& a, const IntegerCase& b, Tally& tally) {
  const auto of_a = obstacle_of(a).exact_legs(), of_b = obstacle_of(b).exact_legs();
  if (!of_a || !of_b) return false;
  for (const vo::AlgebraicDirection& p : {of_a->left, of_a->right}) {
    for (const vo::AlgebraicDirection& q : {of_b->left, of_b->right}) {
      if (p.quarter_turns() != q.quarter_turns()) continue;
      const auto slope_p = slope_of(p), slope_q = slope_of(q);
      if (!slope_p || !slope_q) return false;
      const auto theirs = Kernel().compare_1_object()(*slope_p, *slope_q);
      if (theirs == CGAL::EQUAL) tally.at_a_contact();
      if (static_cast<int>(turn(q, p)) != static_cast<int>(theirs)) return false;
    }
  }
  return true;
}

bool agrees(const IntegerCase& c, const IntegerCase& other, Tally& tally) {
  return has_same_legs(c) && has_same_exact_legs(c) &&
         (obstacle_of(other).overlaps() || has_same_order(c, other, tally));
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

/// A case that shares something with another: the same from twice as far, the mirror image, the same but for a radius.
IntegerCase related(IntegerCase c, SeededRandom& random) {
  const int kind = random.integer(0, 3);
  if (kind == 0) return {2 * c.px, 2 * c.py, 2 * c.l11, 2 * c.l21, 2 * c.l22, 2 * c.r};
  if (kind == 1) return {-c.px, -c.py, c.l11, c.l21, c.l22, c.r};
  if (kind == 2) return {3 * c.px, 3 * c.py, 3 * c.l11, 3 * c.l21, 3 * c.l22, 3 * c.r};
  c.r += 1;
  return c;
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
    if (!obstacle_of(c).overlaps()) tally.random(agrees(c, random_case(random, i), tally), text_of(c));
  }
  while (tally.constructed_cases() < asked.constructed) {
    const IntegerCase c = constructed_case(random);
    if (!obstacle_of(c).overlaps()) tally.constructed(agrees(c, related(c, random), tally), text_of(c));
  }
  return tally;
}

}  // namespace exactvo::test
