// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/moving.h"

#include <algorithm>
#include <string>

#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/require.h"
#include "motion/leader.h"
#include "scene/braking.h"
#include "scene/static_field.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {

void move_obstacles(const std::vector<MovingObstacle>& obstacles, double time, Scene& scene,
                    std::vector<MovedObstacle>& moved) {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const MovedObstacle& at = moved.emplace_back(
        MovedObstacle{displacement_at(obstacles[k], time), leader_at(obstacles[k].motion, time).velocity});
    scene.bodies().move(scene.moving_obstacle(k), hull_of(obstacles[k], at.displacement), at.velocity);
  }
}

void add_moving_constraint(const DecisionRules& rules, const Viewpoint& from, vo::BodyTable& bodies,
                           vo::BodyTable::Number body, std::size_t index, std::vector<Constraint>& out) {
  const Vec2 u = bodies[body].velocity;
  geometry::GrownShape& seen = bodies.seen(body, from.position, from.radius);
  const vo::VelocityObstacle::Nearest nearest = vo::clearance_of(seen);
  if (nearest.distance > sight_of(rules, from.radius, from.max_speed + norm(u))) return;
  vo::ClearancePolicy policy;
  policy.time_horizon = rules.horizons.robots;
  policy.room = std::max(kContactSkin, rules.margins.robot);
  policy.push_out_time = contact_time(rules.time_step, rules.horizons);
  const vo::ProvenHalfPlane found = vo::half_plane_against(seen, nearest, from.velocity - u, policy);
  Constraint& c = out.emplace_back();
  c.half_plane = vo::shifted_by(found.half_plane, u);
  c.proof = found.proof;
  c.priority = lp::Priority::soft;
  c.body = body;
  c.clearance = nearest.distance;
  c.normal = nearest.normal;
  c.time_horizon = policy.time_horizon;
  c.index = index;
  c.speed = norm(u);
}

void add_moving_constraints(const DecisionRules& rules, const Viewpoint& from, Scene& scene,
                            std::vector<Constraint>& out) {
  for (std::size_t k = 0; k < scene.moving_obstacles(); ++k)
    add_moving_constraint(rules, from, scene.bodies(), scene.moving_obstacle(k), k, out);
}

bool add_mover_constraint(const DecisionRules& rules, const Viewpoint& from, double speed, std::size_t steps,
                          Vec2 velocity, Scene& scene, std::size_t index, std::vector<Constraint>& out) {
  const vo::BodyTable::Number body = scene.moving_obstacle(index);
  const geometry::Disc disc = std::get<geometry::Disc>(scene.bodies()[body].shape);
  const double tau = way_time(rules.time_step, steps), most = kBoxDiagonal * from.max_speed;
  const double reached = speed * static_cast<double>(steps) * rules.time_step;
  const Vec2 apart = from.position - disc.center;
  const double clearance = norm(apart) - disc.radius - from.radius;
  constexpr double kSpare = 1.001;
  if (clearance > kSpare * (reached + tau * most) + kContactSkin) return true;
  const Mover mover{{disc.center, disc.radius + from.radius}, speed, steps};
  const vo::ProvenHalfPlane found = mover_half_plane(rules.time_step, from.position, velocity, mover);
  if (found.proof == vo::Proof::none) return false;
  Constraint& c = out.emplace_back();
  c.half_plane = found.half_plane;
  c.proof = found.proof;
  c.body = body;
  c.clearance = clearance;
  c.normal = geometry::normalized(apart);
  c.time_horizon = tau;
  c.index = index;
  c.speed = kSpare * (reached + tau * most) / rules.time_step;  // recorded wherever it was needed
  return true;
}

}  // namespace exactvo::formation::detail

namespace exactvo::formation {

geometry::ConvexShape hull_of(const MovingObstacle& obstacle, Vec2 displacement) {
  if (obstacle.disc) return geometry::Disc{obstacle.disc->center + displacement, obstacle.disc->radius};
  std::vector<Vec2> points = geometry::vertices_of(obstacle.shape);
  for (Vec2& p : points) p += displacement;
  return geometry::convex_hull(points);
}

SeenBody seen_body(const Scenario& scenario, const std::vector<vo::Body>& bodies, const Step& row, std::size_t robot,
                   const DecisionConstraint& constraint) {
  EXACTVO_REQUIRE(constraint.body < bodies.size(), "body " + std::to_string(constraint.body));
  const vo::Body& body = bodies[constraint.body];
  SeenBody seen{body.shape, row.robots[robot].anchor, obstacle_radius(scenario.robots[robot]), {}};
  if (body.kind == vo::BodyKind::robot) {
    seen.radius = scenario.robots[robot].radius;
    const RobotStep& other = row.robots[body.owners.front()];
    seen.shape = geometry::Disc{other.anchor, scenario.robots[body.owners.front()].radius};
    seen.velocity = other.anchor_velocity;
  } else if (body.kind == vo::BodyKind::moving_obstacle) {
    EXACTVO_REQUIRE(body.owners.front() < row.moving.size(), "a row with the places of moving obstacles");
    const MovedObstacle& moved = row.moving[body.owners.front()];
    const MovingObstacle& obstacle = scenario.moving_obstacles[body.owners.front()];
    seen.shape = hull_of(obstacle, moved.displacement);
    if (obstacle.max_speed)
      seen.radius += *obstacle.max_speed * static_cast<double>(row.robots[robot].stopping_steps) * scenario.time_step;
    else
      seen.velocity = moved.velocity;
  }
  return seen;
}

Vec2 displacement_at(const MovingObstacle& obstacle, double time) {
  return detail::leader_at(obstacle.motion, time).position - obstacle.motion.path.front();
}

}  // namespace exactvo::formation
