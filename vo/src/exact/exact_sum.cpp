// SPDX-License-Identifier: GPL-3.0-or-later
// S in rationals, and its exact legs: `legs_of` finds them for `VelocityObstacle::exact_legs`. The equations are those
// of algebraic_direction.h; algebraic_root.h isolates their roots.
#include "exact/exact_sum.h"

namespace exactvo::vo::detail {
namespace {

using geometry::detail::make;
using geometry::detail::squared;

ExactSum sum_of(const geometry::ConvexShape& shape) {
  const auto disc = [](double radius) { return Body{0, 0, 0, abs(Rational(radius))}; };
  if (const auto* d = std::get_if<geometry::Disc>(&shape)) return {{make<Rational>(d->center)}, disc(d->radius)};
  if (const auto* e = std::get_if<geometry::Ellipse>(&shape)) {
    const RationalVector c = make<Rational>(e->center);
    const Rational l11(e->l11), l21(e->l21), l22(e->l22);
    if (sgn(l22) == 0) return {{{c.x - l11, c.y - l21}, {c.x + l11, c.y + l21}}, {}};
    if (sgn(l21) == 0 && abs(l11) == abs(l22)) return {{c}, disc(e->l11)};
    return {{c}, {squared(l11), l11 * l21, squared(l21) + squared(l22), 0}};
  }
  ExactSum out;
  for (const Vec2 v : corners_of(shape)) out.centres.push_back(make<Rational>(v));
  return out;
}

// --- Polynomials in the slope ---

using Coefficients = std::vector<Rational>;

Coefficients product(const Coefficients& a, const Coefficients& b) {
  Coefficients out(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  return out;
}

Coefficients difference(Coefficients a, const Coefficients& b, const Rational& times = 1) {
  for (std::size_t i = 0; i < b.size(); ++i) a[i] -= times * b[i];
  return a;
}

/// One body at one place, turned back by some quarter turns, and its tangents along (1, t): the equations of
/// algebraic_direction.h.
class Tangency {
 public:
  Tangency(const RationalVector& centre, const Body& body, int quarter_turns)
      : p_(turned(centre, -quarter_turns)),
        b_{body.s22, Rational(-2 * body.s12), body.s11},
        d_{squared(body.radius), 0, squared(body.radius)} {
    if (quarter_turns % 2 != 0) b_ = {body.s11, Rational(2 * body.s12), body.s22};
  }

  Polynomial polynomial() const {
    const Coefficients line{p_.y, Rational(-p_.x)};
    const Coefficients rest = difference(difference(product(line, line), b_), d_);
    const bool two_roots = !is_nothing(b_) && !is_nothing(d_);
    return square_free(primitive(two_roots ? difference(product(rest, rest), product(b_, d_), 4) : rest));
  }

  /// The sign of h at side * (-t, 1): positive where the line along (1, t) passes through or on the inner side.
  int support_sign(const Rational& t, int side) const {
    return sign_with_roots(side * (p_.y - p_.x * t), at(b_, t), at(d_, t));
  }

 private:
  static bool is_nothing(const Coefficients& c) { return sgn(c[0]) == 0 && sgn(c[2]) == 0; }
  static Rational at(const Coefficients& c, const Rational& t) { return (c[2] * t + c[1]) * t + c[0]; }

  RationalVector p_;
  Coefficients b_, d_;
};

/// Which way a support changes across a root, with rising slope: h of the left side falls at the left leg and rises at
/// the opposite of the right one, h of the right side rises at the right leg and falls at the opposite of the left one.
int change(const Tangency& tangency, const Root& root, int side) {
  const int low = tangency.support_sign(root.low, side), high = tangency.support_sign(root.high, side);
  return low == high ? 0 : high > low ? 1 : -1;
}

/// The legs of one body, or nothing yet.
struct Found {
  std::optional<AlgebraicDirection> left, right;

  void look_at(const Tangency& tangency, const Root& root, int quarter_turns) {
    const auto at = [&](int turns) { return direction_of(settled(root), turns); };
    const int on_left = change(tangency, root, 1), on_right = change(tangency, root, -1);
    if (on_left < 0) left = at(quarter_turns);
    if (on_left > 0) right = at(quarter_turns + 2);
    if (on_right > 0) right = at(quarter_turns);
    if (on_right < 0) left = at(quarter_turns + 2);
  }
};

/// A body with its mirror image in 0 has the same polynomial: two quarters of the four will do.
ExactLegs legs_of(const RationalVector& centre, const Body& body) {
  Found found;
  for (int k = 0; k < 2; ++k) {
    const Tangency tangency(centre, body, k);
    for (const Root& root : isolate(tangency.polynomial(), -1, 1)) found.look_at(tangency, root, k);
  }
  return {*found.left, *found.right};
}

/// The legs of a cone round points, none of which needs algebra.
ExactLegs legs_of_points(const std::vector<RationalVector>& points) {
  const RationalVector *left = &points.front(), *right = left;
  for (const RationalVector& p : points) {
    if (sgn(cross(*left, p)) > 0) left = &p;
    if (sgn(cross(*right, p)) < 0) right = &p;
  }
  return {direction_of(*left), direction_of(*right)};
}

}  // namespace

UnroundedInput unrounded_input(const VelocityObstacle& obstacle) {
  const geometry::GrownShape& s = obstacle.grown_;
  if (!obstacle.polygonal_) return {s.shape, nullptr, s.origin, s.radius};
  return {obstacle.polygonal_->obstacle, &obstacle.polygonal_->robot, s.origin, 0.0};
}

ExactSum exact_sum(const VelocityObstacle& obstacle) {
  const UnroundedInput input = unrounded_input(obstacle);
  ExactSum alone = sum_of(input.obstacle);
  for (RationalVector& c : alone.centres) c = c - make<Rational>(input.position);
  alone.body.radius += Rational(input.radius);
  if (!input.robot) return alone;
  ExactSum out{{}, alone.body};
  for (const RationalVector& c : alone.centres)
    for (const Vec2 v : input.robot->vertices) out.centres.push_back(c - make<Rational>(v));
  return out;
}

// 0 is not in S, so that all of S lies less than half a turn wide: `turn` orders the legs of its bodies.
ExactLegs legs_of(const ExactSum& s) {
  if (s.body.is_disc() && sgn(s.body.radius) == 0) return legs_of_points(s.centres);
  ExactLegs legs = legs_of(s.centres.front(), s.body);
  for (std::size_t i = 1; i < s.centres.size(); ++i) {
    const ExactLegs other = legs_of(s.centres[i], s.body);
    if (turn(legs.left, other.left) == geometry::Sign::positive) legs.left = other.left;
    if (turn(legs.right, other.right) == geometry::Sign::negative) legs.right = other.right;
  }
  return legs;
}

}  // namespace exactvo::vo::detail

namespace exactvo::vo {

std::optional<ExactLegs> VelocityObstacle::exact_legs() const {
  if (overlaps()) return std::nullopt;
  return detail::legs_of(detail::exact_sum(*this));
}

}  // namespace exactvo::vo
