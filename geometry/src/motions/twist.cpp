// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/twist.h"

#include <cmath>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {
namespace {

/// sin h / h.
double sine_share(double h, double sine) {
  return h == 0.0 ? 1.0 : sine / h;
}

/// Up by more than the few roundings of a product.
constexpr double kUp = 1.0 + 0x1p-49;

}  // namespace

Displacement displacement_after(const Twist& twist, double time) {
  const double angle = twist.turn * time, half = 0.5 * angle;
  if (angle == 0.0) return {time * twist.velocity, 1.0, 0.0};
  const double c = std::cos(half), s = std::sin(half);
  const double along = time * sine_share(half, s);
  const Vec2 chord{c * twist.velocity.x - s * twist.velocity.y, s * twist.velocity.x + c * twist.velocity.y};
  return {along * chord, std::cos(angle), std::sin(angle)};
}

Pose pose_after(const Pose& pose, const Twist& in_body_axes, double time) {
  const Displacement d = displacement_after(in_body_axes, time);
  return {pose.at + rotated(d.by, pose.heading), pose.heading + in_body_axes.turn * time};
}

Twist twist_between(const Pose& from, const Pose& to, double time) {
  EXACTVO_REQUIRE(time > 0.0 && std::isfinite(time), hex_text(time));
  const double angle = std::remainder(to.heading - from.heading, 2.0 * kPi), half = 0.5 * angle;
  const Vec2 chord = rotated(to.at - from.at, -from.heading - half);
  return {chord / (time * sine_share(half, std::sin(half))), angle / time};
}

double speed_of(const Twist& twist, Vec2 q) {
  return norm(twist.velocity + twist.turn * perp(q));
}

double stray_of(const Twist& twist, Vec2 q, double time) {
  // The sum in `speed_of` may cancel: its rounding counts by the sizes of its terms.
  const double cancelled = 0x1p-51 * (norm(twist.velocity) + std::fabs(twist.turn) * norm(q));
  return 0.125 * std::fabs(twist.turn) * (speed_of(twist, q) + cancelled) * time * time * kUp;
}

double twist_rounding(const Twist& twist, Vec2 q, double time) {
  // Of the angle a: one rounding, a u. Of c, s: one ulp each, 2 u, and a u. Of the chord: 2 products, a sum, the
  // quotient s / h and the products with it: 10 u. Both coordinates: 3/2. In all below (16 + 2 |a|) u |v| t, and of the
  // turned point, with its sum, no more than as much of |q|.
  const double angle = std::fabs(twist.turn * time);
  return (16.0 + 2.0 * angle) * 0x1p-53 * (norm(twist.velocity) * std::fabs(time) + norm(q)) * kUp;
}

ReferenceTwist reference_twist(Vec2 velocity, double ahead, double time) {
  const Vec2 way = time * velocity;
  EXACTVO_REQUIRE(time > 0.0 && squared_norm(way) < 4.0 * ahead * ahead, hex_text(ahead) + " " + hex_text(time));
  const double t = way.y / (2.0 * ahead + way.x), half = std::atan(t);
  const double share = t == 0.0 ? 1.0 : half / t;
  return {(way.x + way.y * t) * share / time, 2.0 * half / time, t};
}

}  // namespace exactvo::geometry
