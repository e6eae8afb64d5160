// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the boundaries of two grown shapes that overlap cross, a robot meets a concave vertex of their union and can
/// come to rest:
///
///        A    \   / B        p: the crossing, n_A and n_B the outward normals there
///         ____ \ / ____      free velocities at p: { v : n_A . v >= 0, n_B . v >= 0 }
///               p            a robot heading for g rests exactly where  g - p = -(s n_A + t n_B),  s, t >= 0
///             robot
///
/// A robot that meets one of the two boundaries within `kTieAngle` of head-on turns left by that angle (steering.h),
/// which can turn it into the cone: so it rests there as well where g - p turned so lies in the cone.
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
  /// Sine of the angle from the way to the goal to the nearer edge of the cone of rest; 0 where it lies outside by less
  /// than the tie-break turns.
  double depth = 0.0;
};

/// The rest of a robot at the crossing that heads for `goal`; nothing where some free velocity leads towards it.
std::optional<VertexRest> rest_at(const Crossing& crossing, Vec2 goal);

}  // namespace exactvo::formation::detail
