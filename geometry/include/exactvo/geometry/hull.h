// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Convex hull, convex pieces, smallest circle and smallest ellipses, behind plain types.

#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// The convex hull: a subset of the points, counter-clockwise, no three collinear. Exact (it only selects).
/// One point gives one vertex, collinear points two. REQUIRES: at least one point, all finite.
ConvexPolygon convex_hull(const std::vector<Vec2>& points);

/// How to split a polygon.
enum class PartitionMethod {
  automatic,    ///< `optimal` for n <= 32, `triangles` above
  greene,       ///< CGAL's: at most four times as many pieces as needed
  approximate,  ///< CGAL's, by Hertel and Mehlhorn: the same bound
  optimal,      ///< CGAL's: the least number of pieces, O(n^4)
  triangles     ///< a constrained Delaunay triangulation merged after Hertel and Mehlhorn (1983): the same bound
};
/// "automatic", "greene", "approximate", "optimal", "triangles".
const char* name(PartitionMethod method);
/// False where the word names none.
bool parse(const std::string& text, PartitionMethod& out);
/// All, in the order of the enumeration.
std::vector<std::string> partition_method_names();

/// Splits a simple polygon without holes into convex pieces whose union is the polygon and whose interiors are
/// disjoint. Exact (it only selects vertices), and every answer is proved so before it is given. Never fails on a
/// simple polygon: where CGAL's partition does (Greene's does on some coastlines) or its pieces meet in T-junctions,
/// `triangles` answers instead. REQUIRES: simple, counter-clockwise, at least three vertices, not all collinear.
std::vector<ConvexPolygon> convex_pieces(const Ring& ring, PartitionMethod method = PartitionMethod::automatic);

/// The same for a polygon with holes, always by `triangles`; a piece may then have a vertex in the middle of a straight
/// side, where another ring touches. Exact and proved as above. REQUIRES: valid (validity.h).
std::vector<ConvexPolygon> convex_pieces(const Polygon& polygon, PartitionMethod method = PartitionMethod::automatic);

/// The smallest enclosing circle: the centre rounded, the radius grown until every point is certified inside; it is
/// within a relative 1e-12 of the least, unless rounding the centre's coordinates costs more. One point gives radius 0.
/// (CGAL's Min_sphere_of_spheres_d in doubles stopped short of the smallest circle in 0.5 % of small lattice clouds.)
/// REQUIRES: at least one point, all finite and below 2^1000.
Disc smallest_circle(const std::vector<Vec2>& points);

/// A certified ellipse and what it could at best be improved to.
struct FastEllipse {
  Ellipse ellipse;          ///< certified to contain the points
  double least_area = 0.0;  ///< m^2; no ellipse round the points is smaller: a dual value, certified
};

/// The ellipse of least area, by Newton's method on the dual, inflated until every point is certified inside. Its area
/// is within a relative 1e-10 of the least, unless rounding the coordinates of the centre costs more; `least_area`
/// shows how near it came. One point gives L = 0; collinear points give the segment itself (l22 = 0) or, where doubles
/// can't say it, a sliver of width 2^-36 of the coordinates. REQUIRES: as `smallest_circle`.
FastEllipse fast_smallest_ellipse(const std::vector<Vec2>& points);

}  // namespace exactvo::geometry
