// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/membership.h"

#include <optional>
#include <utility>

#include "exactvo/geometry/predicates.h"

namespace exactvo::vo {
namespace {

using geometry::GrownShape;
using geometry::kUnitRoundoff;

// A product n.v with |n.x|, |n.y| < 1 + 2^-20 errs by less than 3 u (|v.x| + |v.y|), that sum and its product with the
// band by 2 u of themselves, the sum with an offset by u of both (the offsets have room for theirs).
constexpr double kProduct = 8.0 * kUnitRoundoff;

// The quotient of something that is known up to a few u, moved up by more than all of it. 0 / infinity is 0.
double quotient_above(double x, double tau) {
  const double q = x / tau;
  return q + 16.0 * kUnitRoundoff * std::fabs(q) + 0x1p-1000;
}

// A point of S about where the tangent touches: as little as needed towards the middle. Exact.
std::optional<Vec2> point_near(const GrownShape& s, Vec2 touch, Vec2 middle) {
  for (const double share : {0x1p-40, 0x1p-30, 0x1p-20, 0x1p-10}) {
    const Vec2 x = touch + share * (middle - touch);
    if (locate(s, x) != geometry::Place::outside) return x;
  }
  return std::nullopt;
}

// Bounds the coordinates of normal - across / |across|.
double apart(Vec2 normal, Vec2 across) {
  const Vec2 gap = normal - geometry::normalized(across);
  return std::max(std::fabs(gap.x), std::fabs(gap.y)) + kProduct;
}

bool is_about_unit(Vec2 n) {
  return std::fabs(n.x) < 1.0 + 0x1p-20 && std::fabs(n.y) < 1.0 + 0x1p-20;
}

}  // namespace

Membership::Membership(VelocityObstacle obstacle) : obstacle_(std::move(obstacle)) {
  const std::optional<Legs> legs = obstacle_.legs();
  if (!legs || !is_about_unit(legs->left.normal) || !is_about_unit(legs->right.normal)) return;
  prepare_misses(*legs);
  // Of a polygonal robot `grown` may reach beyond S: who misses it misses S, but who meets it need not meet S.
  if (obstacle_.grown_error() == 0.0) prepare_meetings(*legs);
}

// h_S(n) <= 0 and t v in S, t > 0, give n.v <= 0; t <= tau and h_S(m) <= 0 give m.v <= h_S(m) / tau.
void Membership::prepare_misses(const Legs& legs) {
  band_ = kProduct;
  left_ = legs.left.normal;
  right_ = legs.right.normal;
  const Vec2 chord = geometry::normalized(perp(legs.left.touch - legs.right.touch));
  across_ = dot(chord, legs.left.touch) <= 0.0 ? chord : -chord;
  const double h = support_upper_bound(obstacle_.grown(), across_);
  if (h <= 0.0) before_ = quotient_above(h, obstacle_.time_horizon());
}

// v strictly between the rays through A and B is a sum of both, so its ray crosses their chord, at a t with
// m.(t v) >= least, the lesser of m.A and m.B; both are negative. If tau m.v < least, then t < tau.
void Membership::prepare_meetings(const Legs& legs) {
  const GrownShape& s = obstacle_.grown();
  const Vec2 far = support_point(s, -across_);
  const Vec2 middle = (legs.left.touch + legs.right.touch + far) / 3.0;
  const std::optional<Vec2> a = point_near(s, legs.left.touch, middle), b = point_near(s, legs.right.touch, middle);
  if (!a || !b || geometry::orientation({}, *b, *a) != geometry::Sign::positive) return;
  const double at_a = dot(across_, *a), at_b = dot(across_, *b);
  const double error = kProduct * (std::fabs(a->x) + std::fabs(a->y) + std::fabs(b->x) + std::fabs(b->y)) + kUnderflow;
  const double least = std::min(at_a, at_b) - error;
  if (!(std::max(at_a, at_b) + error < 0.0 && std::isfinite(least))) return;
  // Where v is this far beyond a leg it is beyond the ray near it, too.
  band_ = kProduct + std::max(apart(left_, perp(*a)), apart(right_, -perp(*b)));
  beyond_ = -quotient_above(-least, obstacle_.time_horizon());
}

}  // namespace exactvo::vo
