// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// From a velocity to a half-plane that separates it from the velocity obstacle: first the best direction in plain
/// doubles, then one certification of that direction alone.

#include <optional>

#include "cone/seen_segment.h"
#include "cone/tangents.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo::detail {

/// The minimum of f(n) = h_S(n) - n.(tau v) over h_S(n) <= 0; with tau infinite, of f(n) = -n.v. Rounded.
struct Direction {
  Vec2 normal;
  double f = 0.0;
  double h = 0.0;          ///< fl(h_S(normal)) on the cut-off
  double magnitude = 0.0;  ///< of h, for its error bound
  BoundaryPart part = BoundaryPart::cut_off;
};

/// Nothing where the robot lies in S or so near that neither a leg nor an inner minimum was found.
std::optional<Direction> best_direction(const GrownShape& s, double tau, Vec2 v);

/// The first n + kappa m, kappa = `first`, twice that, ... below 1, whose h_S is certified <= 0. REQUIRES: first >= 0.
std::optional<Vec2> tilted_inside(const GrownShape& s, Vec2 n, Vec2 m, double first);

/// n tilted as little as needed for a certified h_S <= 0: n + kappa m for an m with h_S(m) < 0 (h_S is sublinear).
/// Nothing where no such m is found: overlap, or a few ulps from it.
std::optional<Vec2> certified_inside(const GrownShape& s, Vec2 n);
/// The other way: certified h_S > 0.
std::optional<Vec2> certified_outside(const GrownShape& s, Vec2 n);

/// A normal n of the half-plane { v : n.v >= 0 } that a robot in contact may use, by an exact predicate: the unit
/// normal of the nearest point as it is rounded, or one of exactly its direction, whose length is between sqrt(1/2) and
/// sqrt(2). Nothing where none of them is safe.
std::optional<Vec2> contact_normal(const GrownShape& s);

// For any shape, and for a segment (seen_segment.h): the same bits in about half the time.

/// The certified half-plane of VO nearest to v (responsibility 1). Nothing where none could be certified.
std::optional<HalfPlane> separating_half_plane(const GrownShape& s, double tau, Vec2 v);
std::optional<HalfPlane> separating_half_plane(const SeenSegment& s, double tau, Vec2 v);

/// The outward normal of S at the point nearest to y, and how far y lies outside (negative: the depth).
VelocityObstacle::Nearest nearest_to(const GrownShape& s, Vec2 y);
VelocityObstacle::Nearest nearest_to(const SeenSegment& s, Vec2 y);

}  // namespace exactvo::vo::detail
