// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Convex pieces that can always be had: triangles, merged while they stay convex.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// Splits a valid polygon into convex pieces with vertices of its rings: the constrained Delaunay triangulation of the
/// edges (exact predicates, nothing constructed, and edges meet in vertices only, so no case is left out), whose
/// diagonals are then dropped wherever both ends stay convex: without holes at most four times the least number of
/// pieces (Hertel and Mehlhorn, Fast triangulation of simple polygons, 1983).
/// Deterministic. REQUIRES: rings[0] counter-clockwise, the others clockwise inside it; a ring that touches another has
/// a vertex there.
std::vector<ConvexPolygon> merged_triangles(const std::vector<Ring>& rings);

}  // namespace exactvo::geometry::detail
