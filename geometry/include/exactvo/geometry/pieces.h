// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Decomposes any obstacle into convex shapes whose union it is, for functions that take convex shapes only.
///
/// Exact: no point is added and none is lost. See also: hull.h (the partition of a polygon, proved before it is
/// given), obstacle_shapes.h (the same with facades, enclosures and verdicts), enclosure.h (`parts_of`).

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// Whether the obstacle is a convex set: a polygon without holes that turns one way, a wall on one line. Exact.
/// REQUIRES: valid (validity.h).
bool is_convex(const Obstacle& obstacle);

/// A convex obstacle as one shape, its hull; another polygon as `convex_pieces`, disjoint inside; another wall as its
/// edges, straight runs merged. Exact. REQUIRES: valid (validity.h).
std::vector<ConvexShape> convex_cover(const Obstacle& obstacle);

/// The convex hull, as a segment where it is flat. Exact. REQUIRES: at least one point, all finite.
ConvexShape hull_shape(const std::vector<Vec2>& points);

}  // namespace exactvo::geometry
