// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The baseline's half-planes of a static polygon or wall (van den Berg et al. 2011, Section 5 and the usual practice):
/// one for each edge, built on the truncated velocity obstacle of the edge grown by the robot, with the foreign-leg
/// rule: a leg that would point into the neighbouring edge is replaced by that edge, and gives no half-plane of its
/// own. Nearly collinear neighbours may leave an edge to each other, so that none has a half-plane. A caller that needs
/// one must check what the half-planes exclude.
///
/// It makes a robot stop before a wall, not go round it: that is what the paper improves upon.
/// Certified: each half-plane is disjoint from the velocity obstacle of its own edge.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::vo {

using geometry::HalfPlane;
using geometry::Vec2;

/// A closed chain of vertices with free space on the right of every edge: a polygon's outer ring counter-clockwise, a
/// hole clockwise, a wall walked there and back.
struct OrcaChain {
  std::vector<Vec2> vertices;    ///< m, in order
  std::vector<bool> convex;      ///< whether the chain turns left (or straight back) at the vertex
  std::vector<Vec2> directions;  ///< unit, of the edge that begins at the vertex
};

/// The chains of an obstacle.
std::vector<OrcaChain> orca_chains(const geometry::Obstacle& obstacle);

/// A half-plane, and the edge it is for.
struct OrcaHalfPlane {
  HalfPlane half_plane;    ///< of allowed velocities
  std::size_t edge = 0;    ///< from vertex `edge` to the next
  bool certified = false;  ///< false only where the robot overlaps the edge
};

/// The half-planes of the edges that are listed, by number, ascending. No edge is covered by a farther one, so that the
/// edges within d of the robot give the same half-planes nearer than d as all edges would.
/// REQUIRES: radius >= 0, time_horizon > 0, finite numbers.
std::vector<OrcaHalfPlane> orca_half_planes(const OrcaChain& chain, const std::vector<std::size_t>& edges,
                                            Vec2 position, Vec2 velocity, double radius, double time_horizon);

}  // namespace exactvo::vo
