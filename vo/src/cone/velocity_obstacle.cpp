// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/velocity_obstacle.h"

#include <cmath>
#include <string>
#include <utility>

#include "cone/separation.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::vo {
namespace {

std::optional<Leg> leg_of(const geometry::GrownShape& s, const detail::Tangent& tangent, double side) {
  const std::optional<Vec2> inside = detail::certified_inside(s, tangent.normal);
  const std::optional<Vec2> outside = detail::certified_outside(s, tangent.normal);
  if (!inside || !outside) return std::nullopt;
  return Leg{*inside, *outside, -side * perp(tangent.normal), tangent.touch};
}

}  // namespace

const char* name(BoundaryPart part) {
  constexpr const char* kNames[] = {"left leg", "right leg", "cut-off", "apex"};
  return kNames[static_cast<int>(part)];
}

VelocityObstacle::VelocityObstacle(geometry::ConvexShape obstacle, Vec2 robot_position, double robot_radius,
                                   double time_horizon)
    : grown_{std::move(obstacle), robot_position, robot_radius}, tau_(time_horizon) {
  EXACTVO_REQUIRE(geometry::is_valid(grown_.shape), geometry::excerpt(grown_.shape));
  EXACTVO_REQUIRE(geometry::is_finite(robot_position), "a robot position that is not finite");
  EXACTVO_REQUIRE(robot_radius >= 0.0 && std::isfinite(robot_radius), std::to_string(robot_radius));
  EXACTVO_REQUIRE(time_horizon > 0.0, std::to_string(time_horizon));
}

VelocityObstacle::VelocityObstacle(geometry::ConvexShape obstacle, Vec2 robot_position, geometry::ConvexPolygon robot,
                                   double time_horizon)
    : tau_(time_horizon) {
  EXACTVO_REQUIRE(time_horizon > 0.0, std::to_string(time_horizon));
  geometry::OuterShape outer = geometry::grown_by_polygon(obstacle, robot, robot_position);
  grown_ = std::move(outer.shape);
  polygonal_ = std::make_shared<const Polygonal>(Polygonal{std::move(obstacle), std::move(robot), outer.error});
}

bool VelocityObstacle::overlaps() const {
  if (polygonal_) return sweep_meets(polygonal_->obstacle, polygonal_->robot, grown_.origin, {}, 0.0);
  return locate(grown_, Vec2{}) != geometry::Place::outside;
}

bool VelocityObstacle::contains(Vec2 v) const {
  if (polygonal_ || !std::isfinite(tau_)) return contains_sum({{v}});
  return segment_meets(grown_, v, tau_);
}

bool VelocityObstacle::contains_sum(const geometry::VectorSum& v) const {
  if (polygonal_) return sweep_meets(polygonal_->obstacle, polygonal_->robot, grown_.origin, v, tau_);
  return segment_meets(grown_, v, tau_);
}

VelocityObstacle::Nearest VelocityObstacle::nearest() const {
  return detail::nearest_to(grown_, Vec2{});
}

std::optional<Legs> VelocityObstacle::legs() const {
  const std::optional<detail::Tangents> found = detail::tangents(grown_);
  if (!found || !(nearest().distance > 0.0)) return std::nullopt;
  const std::optional<Leg> left = leg_of(grown_, found->left, 1.0);
  const std::optional<Leg> right = leg_of(grown_, found->right, -1.0);
  if (!left || !right) return std::nullopt;
  return Legs{*left, *right};
}

NearestBoundary VelocityObstacle::nearest_boundary(Vec2 v) const {
  EXACTVO_REQUIRE(geometry::is_finite(v), "a velocity that is not finite");
  const std::optional<detail::Direction> best = detail::best_direction(grown_, tau_, v);
  if (!best) {  // a few ulps from contact: the half-plane away from it is all that is left of the free side
    const Nearest away = nearest();
    return {away.normal, dot(away.normal, v), -dot(away.normal, v) * away.normal, BoundaryPart::cut_off};
  }
  const double f = std::isfinite(tau_) ? best->f / tau_ : best->f;
  return {best->normal, -f, f * best->normal, best->part};
}

std::optional<HalfPlane> half_plane(const geometry::GrownShape& s, double time_horizon, Vec2 v) {
  EXACTVO_REQUIRE(geometry::is_finite(v), "a velocity that is not finite");
  EXACTVO_REQUIRE(time_horizon > 0.0, std::to_string(time_horizon));
  return detail::separating_half_plane(s, time_horizon, v);
}

std::optional<HalfPlane> VelocityObstacle::half_plane(Vec2 v, double responsibility) const {
  EXACTVO_REQUIRE(geometry::is_finite(v), "a velocity that is not finite");
  EXACTVO_REQUIRE(responsibility > 0.0 && responsibility <= 1.0, std::to_string(responsibility));
  const std::optional<HalfPlane> full = detail::separating_half_plane(grown_, tau_, v);
  if (!full || responsibility == 1.0) return full;
  const double at_v = dot(full->normal, v);
  return HalfPlane{full->normal, at_v + responsibility * (full->offset - at_v)};
}

std::optional<HalfPlane> VelocityObstacle::contact_half_plane() const {
  const std::optional<Vec2> n = detail::contact_normal(grown_);
  if (!n) return std::nullopt;
  return HalfPlane{*n, 0.0};
}

}  // namespace exactvo::vo
