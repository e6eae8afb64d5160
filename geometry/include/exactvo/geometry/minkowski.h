// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Minkowski sums A (+) B = { a + b : a in A, b in B }: obstacles grown by a robot.
///
///   convex (+) convex       merge of edges, exact up to one rounding a vertex
///   any convex (+) polygon  a grown shape round it, for polygonal robots
///   any convex (+) disc     never built: see support.h
///
/// Every rounded result says by how much. "Within e" is the Hausdorff distance: no point of either set is farther than
/// e from the other.

#include "exactvo/geometry/support.h"

namespace exactvo::geometry {

/// A convex sum with its rounding error.
struct ConvexSum {
  ConvexPolygon polygon;  ///< counter-clockwise
  double error = 0.0;     ///< m; the exact sum is within this of `polygon`: certified; 0 if no vertex was rounded
};

/// The sum of two convex polygons. The edges are merged by exact comparison of their directions; each vertex a_i + b_j
/// is rounded to nearest. O(n + m). One or two vertices (points, segments) are convex polygons too. REQUIRES: vertices
/// finite, below 2^1000, listed counter-clockwise.
///
/// Properties: (1) commutes; (2) adding a point moves; (3) h of the sum is the sum of the h's, within `error`.
ConvexSum minkowski_sum(const ConvexPolygon& a, const ConvexPolygon& b);

/// A shape round a sum that is not built.
struct OuterShape {
  GrownShape shape;    ///< contains S
  double error = 0.0;  ///< m; no point of it is farther than this from S: certified
};

/// S = (obstacle - position) (+) (-robot): the obstacle grown by a robot that is a convex polygon, its vertices
/// relative to `position`. Rounded outward: where vertices of the sum were rounded, a radius makes up for it; an
/// ellipse is replaced by a polygon round it, within 2^-12 of its larger entry. Exact questions: swept.h. REQUIRES:
/// valid shapes, finite and below 2^900.
OuterShape grown_by_polygon(const ConvexShape& obstacle, const ConvexPolygon& robot, Vec2 position);

}  // namespace exactvo::geometry
