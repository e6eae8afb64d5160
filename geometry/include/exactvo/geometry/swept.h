// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact questions about robots in straight motion: along directions that no double holds (a difference or a mean of
/// velocities), for ever (t_max infinite), and for robots that are convex polygons.
///
/// Exact throughout. No filter, except in calls of predicates.h: microseconds, for study and not for loops.

#include <array>

#include "exactvo/geometry/support.h"

namespace exactvo::geometry {

/// The exact sum of its terms: v - w, or v - a/2 - b/2 (halving is exact above 2^-1022).
struct VectorSum {
  std::array<Vec2, 3> terms{};  ///< those not in use are (0, 0)
};

/// The sum, rounded.
Vec2 rounded(const VectorSum& sum);

/// Whether t * direction lies in S for some 0 <= t <= t_max, t finite. Exact. REQUIRES: finite terms, t_max >= 0 or
/// infinite, s valid.
bool segment_meets(const GrownShape& s, const VectorSum& direction, double t_max);

/// Whether a robot that is a convex polygon (vertices relative to its reference point, which starts at `position`)
/// touches the obstacle at some time 0 <= t <= t_max, t finite, when it moves by t * direction. Exact: two convex sets
/// are apart iff a line across one of finitely many directions separates them or, against a disc or an ellipse, seen
/// from the robot: iff the centre neither begins nor ends in the robot, and its way comes nowhere within the radius of
/// an edge (the ellipse mapped to a disc). REQUIRES: valid shapes, finite numbers, t_max >= 0 or infinite.
bool sweep_meets(const ConvexShape& obstacle, const ConvexPolygon& robot, Vec2 position, const VectorSum& direction,
                 double t_max);

}  // namespace exactvo::geometry
