// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the boundaries of two grown shapes that overlap cross, a robot meets a concave vertex of their union and can
/// come to rest:
///
///        A    \   / B        p: the crossing, n_A and n_B the outward normals there
///         ____ \ / ____      free velocities at p: { v : n_A . v >= 0, n_B . v >= 0 }
///               p            no free velocity has a component along w if  w = -(s n_A + t n_B),  s, t >= 0
///             robot
///
/// So a robot rests at p if what it prefers lies in this cone. It prefers the direction g - p to its goal g, turned
/// left by `kTieAngle` if it meets the boundary it violates most within that angle of head-on (steering.h). The turn
/// can lead into the cone, where the robot comes to rest, or out of it, where it slides away.
///
/// Heuristic: the crossings are found by subdivision with rounded distances. None is missed but a pair of them closer
/// together than a hundredth of the robot's radius, or where the boundaries run along each other.

#include <vector>

#include "exactvo/formation/trap.h"
#include "exactvo/geometry/support.h"

namespace exactvo::formation::detail {

/// m; from the boundary of a grown shape to p, negative inside. Rounded.
double distance_to(const geometry::GrownShape& shape, Vec2 p);

/// Whether the bounding boxes of the two shapes meet.
bool boxes_meet(const geometry::GrownShape& a, const geometry::GrownShape& b);

/// The boundary points that both shapes have in common, with the outward normals there.
struct Crossing {
  Vec2 position;  ///< m
  Vec2 normal_a;  ///< unit
  Vec2 normal_b;  ///< unit
};
std::vector<Crossing> crossings(const geometry::GrownShape& a, const geometry::GrownShape& b);

/// A robot at rest in a concave vertex.
struct VertexRest {
  Equilibrium equilibrium;
  /// Sine of the angle from the direction to the goal to the nearer edge of the cone; 0 if that direction is outside
  /// and only the tie-break turns it into the cone.
  double depth = 0.0;
};

/// The rest of a robot at the crossing that heads for `goal`; nothing if some free velocity has a component along what
/// the robot prefers.
std::optional<VertexRest> rest_at(const Crossing& crossing, Vec2 goal);

}  // namespace exactvo::formation::detail
