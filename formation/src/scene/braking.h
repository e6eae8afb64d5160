// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Half-planes for robots whose velocity changes by A dt at most (A: `DecisionRules::acceleration`).
///
/// tau: braking time. A robot that brakes keeps the share lambda = 1 - T / tau of its velocity in each step of T, so
/// that its way from x on is [x, x + tau v]. Lemma: if the ways of two robots, which shrink alike, keep clear of each
/// other, so do those from x + T v on at lambda v, since x + T v + [0, tau] lambda v = x + [T, tau] v. Half-planes with
/// horizon tau that are made at lambda v, of both robots, therefore hold for lambda v, whatever else there is, and any
/// velocities that satisfy them have such ways again. With tau >= V / A the change |lambda v - v| is within A T.
///
/// Half-planes are built with `kContactSkin` of room and certified without. Roundings use the skin up; then as much
/// room is asked for as lambda v leaves, so that it satisfies the half-plane.
///
/// While a robot moves, it keeps clear of bodies that move in any way no faster than U (passive safety). From u it
/// stands after k steps, the first at u included, if |u| <= k A T: it drives T u, and then u (1 - j / k) T. With the
/// way (k + 1) / 2 T u for all that, and c for how far along n the body grown by the robot reaches, the half-plane says
///
///     n.x >= c   and   n.(x + (k + 1) / 2 T u) >= c + U k T
///
/// Lemma 8: then n.x(t) >= c + U t all the while, since n.x(t) - U t falls, or is concave. So the same n shows the same
/// for u (1 - 1 / k), k - 1 and the next step, wherever the body has gone. A robot that stands is promised nothing.

#include <vector>

#include "exactvo/vo/constraint.h"
#include "exactvo/vo/reciprocal.h"
#include "scene/decision_rules.h"

namespace exactvo::formation::detail {

/// Sides of the polygon that stands for the disc |u - v| <= A T.
inline constexpr int kSidesOfLimit = 24;

/// Appends the polygon inside the disc |u - velocity| <= A T as half-planes, with a corner where braking leads.
/// Whatever satisfies them is within the disc.
void add_acceleration_limits(const DecisionRules& rules, Vec2 velocity, std::vector<geometry::HalfPlane>& out);

/// The half-plane against what stands still, made at `braked` with horizon `braking_time`. `seen`: the body grown by
/// the bare robot, and so again afterwards; `nearest` its `clearance_of`.
vo::ProvenHalfPlane braking_half_plane(geometry::GrownShape& seen, const vo::VelocityObstacle::Nearest& nearest,
                                       Vec2 braked, double braking_time);

/// What moves in any way, no faster than `speed` (m/s), seen by a robot that can stand after `steps` steps.
struct Mover {
  geometry::Disc disc;  ///< m, of both, where it is
  double speed = 0.0;   ///< m/s
  std::size_t steps = 1;
};

/// s: u times this is the way until the robot stands.
inline double way_time(double time_step, std::size_t steps) {
  return 0.5 * static_cast<double>(steps + 1) * time_step;
}

/// The half-plane of lemma 8, with the normal that leaves `velocity` the most room. Without a proof where the robot
/// touches it. Where `velocity` satisfies one, it satisfies this one.
vo::ProvenHalfPlane mover_half_plane(double time_step, Vec2 position, Vec2 velocity, const Mover& mover);

/// Both halves of a pair, made at their braked velocities: half of the slack for each.
vo::ReciprocalHalfPlanes braking_half_planes(const vo::MovingDisc& a, const vo::MovingDisc& b, double braking_time);

}  // namespace exactvo::formation::detail
