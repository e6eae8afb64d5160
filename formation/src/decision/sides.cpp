// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/sides.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/vo/family.h"

namespace exactvo::formation::detail {
namespace {

/// What keeps robot i from another robot, as a cone.
struct Cone {
  Constraint* constraint;
  vo::ShiftedCone shifted;
  std::optional<vo::Legs> legs;

  double depth_of(Vec2 v) const { return -shifted.cone.nearest_boundary(v - shifted.apex).signed_distance; }
  Vec2 nearest_outside(Vec2 v) const {
    const vo::NearestBoundary nearest = shifted.cone.nearest_boundary(v - shifted.apex);
    return nearest.signed_distance < 0.0 ? v + nearest.u : v;
  }
};

std::vector<Cone> cones_of(const RobotsAt& now, std::size_t i, std::vector<Constraint>& others) {
  const Robot& self = now.robots[i];
  const Anchor& here = now.anchors[i];
  std::vector<Cone> cones;
  for (Constraint& c : others) {
    if (!is_of_robot(now.scene, c) || !now.robots[c.index].cooperates) continue;
    c.proof = vo::Proof::none;  // of the pair
    vo::Encounter pair;
    pair.obstacle = geometry::Disc{now.anchors[c.index].position, now.robots[c.index].radius};
    pair.obstacle_velocity = now.anchors[c.index].velocity;
    pair.position = here.position;
    pair.velocity = here.velocity;
    pair.radius = self.radius;
    pair.time_horizon = now.rules.horizons.orca;
    const vo::Variant variant = now.rules.method == Method::rvo ? vo::Variant::rvo : vo::Variant::hrvo;
    if (auto cone = vo::family_member(variant, pair).cone) {
      std::optional<vo::Legs> legs = cone->cone.legs();
      cones.push_back({&c, std::move(*cone), std::move(legs)});
    }
  }
  return cones;
}

/// A ray of velocities: a leg of a cone.
struct Ray {
  Vec2 from, along;
};

std::vector<Ray> rays_of(const std::vector<Cone>& cones) {
  std::vector<Ray> rays;
  for (const Cone& c : cones) {
    if (!c.legs) continue;
    rays.push_back({c.shifted.apex, c.legs->left.direction});
    rays.push_back({c.shifted.apex, c.legs->right.direction});
  }
  return rays;
}

/// Where a velocity nearest to the preferred one can lie: there, nearest to it on a cone, where two legs cross, and
/// where a leg reaches the greatest speed.
std::vector<Vec2> candidates(const std::vector<Cone>& cones, Vec2 preferred, double max_speed) {
  std::vector<Vec2> found{preferred};
  for (const Cone& c : cones) found.push_back(c.nearest_outside(preferred));
  const std::vector<Ray> rays = rays_of(cones);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const auto& [from, along] = rays[k];
    const double middle = dot(from, along), square = middle * middle + max_speed * max_speed - squared_norm(from);
    if (square >= 0.0)
      for (const double s : {-middle - std::sqrt(square), -middle + std::sqrt(square)})
        if (s >= 0.0) found.push_back(from + s * along);
    for (std::size_t l = k + 1; l < rays.size(); ++l) {
      const double turn = cross(along, rays[l].along);
      const double s = cross(rays[l].from - from, rays[l].along) / turn, t = cross(rays[l].from - from, along) / turn;
      if (std::isfinite(s) && std::isfinite(t) && s >= 0.0 && t >= 0.0) found.push_back(from + s * along);
    }
  }
  return found;
}

/// The free candidate nearest to the preferred velocity; that itself where none is free.
Vec2 free_velocity(const std::vector<Cone>& cones, Vec2 preferred, double max_speed) {
  constexpr double kRounding = 1e-9;  // of the greatest speed: candidates lie on boundaries
  std::vector<Vec2> all = candidates(cones, preferred, max_speed);
  const auto order = [&](Vec2 a, Vec2 b) { return squared_norm(a - preferred) < squared_norm(b - preferred); };
  std::stable_sort(all.begin(), all.end(), order);
  const auto is_free = [&](Vec2 v) {
    return norm(v) <= (1.0 + kRounding) * max_speed && std::none_of(cones.begin(), cones.end(), [&](const Cone& c) {
             return c.depth_of(v) > kRounding * max_speed;
           });
  };
  const auto found = std::find_if(all.begin(), all.end(), is_free);
  return found == all.end() ? preferred : *found;
}

}  // namespace

void take_sides(const RobotsAt& now, std::size_t i, Vec2 preferred, std::vector<Constraint>& others) {
  const std::vector<Cone> cones = cones_of(now, i, others);
  const Vec2 beside = free_velocity(cones, preferred, now.robots[i].max_speed);
  for (const Cone& c : cones) {
    const auto half_plane = c.shifted.cone.half_plane(beside - c.shifted.apex);
    if (!half_plane) continue;
    c.constraint->half_plane = vo::shifted_by(*half_plane, c.shifted.apex);
    c.constraint->time_horizon = c.shifted.cone.time_horizon();
  }
}

}  // namespace exactvo::formation::detail
