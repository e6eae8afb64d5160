// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Convex hull, convex pieces, smallest circle and smallest ellipse: CGAL's algorithms behind plain types.

#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// The convex hull: a subset of the points, counter-clockwise, no three collinear. Exact (it only selects).
/// One point gives one vertex, collinear points two. REQUIRES: at least one point, all finite.
ConvexPolygon convex_hull(const std::vector<Vec2>& points);

/// Which CGAL partition to use; `automatic` takes the optimal one for n <= 32 and Greene's above.
enum class PartitionMethod { automatic, greene, approximate, optimal };

/// Splits a simple polygon without holes into convex pieces whose union is the polygon and whose interiors are
/// disjoint. Exact (it only selects vertices). REQUIRES: simple, counter-clockwise, at least three vertices, not
/// all collinear.
std::vector<ConvexPolygon> convex_pieces(const Ring& ring, PartitionMethod method = PartitionMethod::automatic);

/// The smallest enclosing circle, radius rounded up until every point is certified inside.
Disc smallest_circle(const std::vector<Vec2>& points);

/// The smallest-area enclosing ellipse by CGAL's exact Min_ellipse_2, centred first, rounded to doubles and inflated until every
/// point is certified inside. Collinear points give a segment-like ellipse (l22 = 0 rotated as needed, or tiny b).
Ellipse smallest_ellipse(const std::vector<Vec2>& points);

}  // namespace exactvo::geometry
