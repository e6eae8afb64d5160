// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Convex pieces that can always be had: triangles, merged while they stay convex.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// Splits a simple counter-clockwise ring into convex pieces with vertices of the ring: the constrained Delaunay
/// triangulation of its edges (exact predicates, nothing constructed, and no edge meets another, so no case is left
/// out), whose diagonals are then dropped wherever both ends stay convex: at most four times the least number of pieces
/// (Hertel and Mehlhorn, Fast triangulation of simple polygons, 1983). Deterministic.
std::vector<ConvexPolygon> merged_triangles(const Ring& ring);

}  // namespace exactvo::geometry::detail
