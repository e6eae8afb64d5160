// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/family.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"

namespace exactvo::vo {
namespace {

using geometry::VectorSum;

VelocityObstacle cone_round(const geometry::ConvexShape& shape, const Encounter& e, double time_horizon) {
  if (e.robot) return {shape, e.position, *e.robot, time_horizon};
  return {shape, e.position, e.radius, time_horizon};
}

ShiftedCone cone_of_rvo(const Encounter& e) {
  const Vec2 half_v = 0.5 * e.velocity, half_u = 0.5 * e.obstacle_velocity;
  return {cone_round(e.obstacle, e, 2.0 * e.time_horizon), VectorSum{{-half_v, -half_u}}, half_v + half_u};
}

/// Where the lines p + s a and q + t b meet; nothing where doubles find them parallel.
std::optional<Vec2> crossing(Vec2 p, Vec2 a, Vec2 q, Vec2 b) {
  const double s = cross(q - p, b) / cross(a, b);
  if (!std::isfinite(s)) return std::nullopt;
  return p + s * a;
}

/// The robot's own side of the middle of RVO keeps RVO's leg; the other is the VO's, so that changing sides does not
/// pay.
///
///        VO's left leg \   / RVO's right leg      v lies right of the middle
///                       \ /
std::optional<ShiftedCone> cone_of_hrvo(const Encounter& e) {
  ShiftedCone cone = cone_of_rvo(e);
  const std::optional<Legs> legs = cone.cone.legs();
  if (!legs) return std::nullopt;
  const Vec2 left = legs->left.direction, right = legs->right.direction;
  const bool keeps_left = cross(left + right, e.velocity - e.obstacle_velocity) >= 0.0;
  const std::optional<Vec2> apex = keeps_left ? crossing(cone.apex, left, e.obstacle_velocity, right)
                                              : crossing(cone.apex, right, e.obstacle_velocity, left);
  if (!apex) return cone;
  cone.apex = *apex;
  cone.minus_apex = {{-*apex}};
  return cone;
}

/// n.v' >= n.v + responsibility (c - n.(v - u)), rounded up: a term passes at most 8 roundings.
std::optional<HalfPlane> half_plane_of(const VelocityObstacle& obstacle, const Encounter& e) {
  const std::optional<HalfPlane> relative = obstacle.half_plane(e.velocity - e.obstacle_velocity);
  if (!relative || (e.obstacle_velocity == Vec2{} && e.responsibility == 1.0)) return relative;
  const Vec2 n = relative->normal;
  const double at_v = dot(n, e.velocity), at_u = dot(n, e.obstacle_velocity);
  const double value = (1.0 - e.responsibility) * at_v + e.responsibility * (relative->offset + at_u);
  const double magnitude = geometry::dot_magnitude(n, e.velocity) + geometry::dot_magnitude(n, e.obstacle_velocity) +
                           geometry::product_magnitude(1.0, relative->offset);
  return HalfPlane{n, geometry::rounded_up_sum(value, magnitude, 8.0)};
}

double distance_ahead(const VelocityObstacle& obstacle) {
  return obstacle.overlaps() ? 0.0 : std::max(obstacle.nearest().distance, 0.0);
}

}  // namespace

VelocityObstacle cone_of(const Encounter& e) {
  return cone_round(e.obstacle, e, e.time_horizon);
}

bool ShiftedCone::contains(Vec2 v) const {
  return cone.contains_sum(VectorSum{{v, minus_apex.terms[0], minus_apex.terms[1]}});
}

Member family_member(Variant variant, const Encounter& e) {
  EXACTVO_REQUIRE(geometry::is_finite(e.velocity) && geometry::is_finite(e.obstacle_velocity),
                  "a velocity that is not finite");
  EXACTVO_REQUIRE(e.responsibility >= 0.0 && e.responsibility <= 1.0, std::to_string(e.responsibility));
  Member member{variant, std::nullopt, std::nullopt};
  const VelocityObstacle obstacle = cone_of(e);
  if (obstacle.overlaps()) return member;
  if (variant == Variant::vo) member.cone = {obstacle, VectorSum{{-e.obstacle_velocity}}, e.obstacle_velocity};
  if (variant == Variant::rvo) member.cone = cone_of_rvo(e);
  if (variant == Variant::hrvo) member.cone = cone_of_hrvo(e);
  if (variant == Variant::orca) member.half_plane = half_plane_of(obstacle, e);
  return member;
}

double paper_time_horizon(const VelocityObstacle& obstacle, Vec2 velocity) {
  const double distance = distance_ahead(obstacle);
  const double speed = norm(velocity);
  if (speed == 0.0) return distance > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  return distance / speed;
}

double clamped_time_horizon(const VelocityObstacle& obstacle, Vec2 velocity) {
  constexpr double kLeast = 0.3, kMost = 3.0, kLeastSpeed = 0.5;
  return std::clamp(distance_ahead(obstacle) / std::max(norm(velocity), kLeastSpeed), kLeast, kMost);
}

}  // namespace exactvo::vo
