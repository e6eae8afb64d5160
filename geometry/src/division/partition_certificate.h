// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The proof that some polygons are a partition of a ring into convex pieces.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// True proves that the pieces are convex, cover the polygon of the rings (outer counter-clockwise, holes clockwise,
/// a valid polygon) and nothing else, and overlap nowhere. Exact, O(n log n).
///
/// Why: each piece runs once round counter-clockwise, so its winding number is 1 inside and 0 outside. Where every
/// directed edge of the pieces is an edge of a ring, once, or meets its own reverse in another piece, the pieces'
/// boundaries add up to the rings'; so do the winding numbers, and the rings' is 1 inside and 0 outside as well.
///
/// False for a true partition whose pieces meet in T-junctions (a vertex of one inside an edge of the next).
bool is_convex_partition(const std::vector<Ring>& rings, const std::vector<ConvexPolygon>& pieces);

}  // namespace exactvo::geometry::detail
