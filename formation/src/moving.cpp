// SPDX-License-Identifier: GPL-3.0-or-later
#include "moving.h"

#include <cmath>

#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "leader.h"

namespace exactvo::formation::detail {
namespace {

/// offset + n.u, rounded up past the error of a dot product and two sums, the bound's own rounding included.
double shifted_up(const geometry::HalfPlane& h, Vec2 u) {
  constexpr double kRoundings = 8.0;
  const double terms = std::fabs(h.offset) + std::fabs(h.normal.x * u.x) + std::fabs(h.normal.y * u.y);
  return h.offset + dot(h.normal, u) + kRoundings * geometry::kUnitRoundoff * terms;
}

RobotConstraint against(const MovingObstacle& obstacle, std::size_t index, const Scenario& scenario,
                        const Viewpoint& from, double time) {
  const double tau = scenario.horizons.robots;
  const Vec2 u = leader_at(obstacle.motion, time).velocity;
  const geometry::ConvexShape shape = shape_at(obstacle, time);
  const vo::VelocityObstacle bare(shape, from.position, from.radius, tau);
  const vo::VelocityObstacle kept_off(shape, from.position, from.radius + scenario.margins.robot, tau);
  const vo::VelocityObstacle::Nearest nearest = bare.nearest();
  std::optional<geometry::HalfPlane> h;
  if (!kept_off.overlaps()) h = kept_off.half_plane(from.velocity - u);
  if (!h && !bare.overlaps()) h = bare.contact_half_plane();
  RobotConstraint c;
  c.distance = nearest.distance + from.radius;
  RecordedConstraint& r = c.recorded;
  r.certified = h.has_value();
  if (!h) h = geometry::HalfPlane{nearest.normal, -nearest.distance / contact_time(scenario)};
  r.half_plane = {h->normal, shifted_up(*h, u)};
  r.source = ConstraintSource::moving_obstacle;
  r.index = index;
  r.hard = false;
  r.shape = shape;
  r.position = from.position;
  r.radius = from.radius;
  r.tau = tau;
  r.shape_velocity = u;
  return c;
}

}  // namespace

geometry::ConvexShape shape_at(const MovingObstacle& obstacle, double time) {
  const Vec2 moved = displacement_at(obstacle, time);
  std::vector<Vec2> points = geometry::vertices_of(obstacle.shape);
  for (Vec2& p : points) p += moved;
  return geometry::convex_hull(points);
}

std::vector<RobotConstraint> moving_constraints(const Scenario& scenario, const Viewpoint& from, double time) {
  std::vector<RobotConstraint> out;
  for (std::size_t k = 0; k < scenario.moving_obstacles.size(); ++k) {
    RobotConstraint c = against(scenario.moving_obstacles[k], k, scenario, from, time);
    if (c.distance - from.radius <= scenario.neighbour_distance) out.push_back(std::move(c));
  }
  return out;
}

}  // namespace exactvo::formation::detail

namespace exactvo::formation {

Vec2 displacement_at(const MovingObstacle& obstacle, double time) {
  return detail::leader_at(obstacle.motion, time).position - obstacle.motion.path.front();
}

}  // namespace exactvo::formation
