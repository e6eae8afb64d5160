// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Minkowski sums A (+) B = { a + b : a in A, b in B }: obstacles grown by a robot.
///
///   convex (+) convex       merge of edges, exact up to one rounding a vertex          here
///   polygon (+) polygon     CGAL's minkowski_sum_2 over exact numbers, then rounded     here
///   polygon (+) disc        polygons from outside and from inside, certified            here
///                           with its arcs, unrounded, as a handle                       exact_offset.h
///   any convex (+) polygon  a grown shape round it, for polygonal robots                here
///   any convex (+) disc     never built for a velocity obstacle: see support.h; `outline` draws it
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
/// The same into `sum`, whose memory is used again. REQUIRES: `sum.polygon` is neither a nor b.
void minkowski_sum(const ConvexPolygon& a, const ConvexPolygon& b, ConvexSum& sum);

/// How CGAL goes about it; the sum is the same.
enum class SumMethod {
  convolution,   ///< of both boundaries
  decomposition  ///< into convex pieces: the slower, independent check
};

/// A sum with its rounding error.
struct PolygonSum {
  Polygon polygon;     ///< outer ring counter-clockwise, holes clockwise; rounding may let rings touch
  double error = 0.0;  ///< m; each vertex was moved by at most this: certified
};

/// The sum of two polygons with holes, by CGAL's minkowski_sum_2, each vertex rounded. Only holes that the sum leaves
/// open stay. REQUIRES: both valid (see `normalize`).
PolygonSum minkowski_sum(const Polygon& a, const Polygon& b, SumMethod method = SumMethod::convolution);

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

/// On which side of the true curve a polygon lies.
enum class Side {
  inside,  ///< within the true curve
  outside  ///< round it
};

/// A polygon that lies within polygon (+) D(0, radius) (`inside`) or contains it (`outside`), and is within `tolerance`
/// of it. Certified: the disc's polygon is checked exactly and leaves room for the rounding of the sum. `error` of the
/// answer is the certified distance, at most `tolerance`. REQUIRES: polygon valid; with M the largest coordinate plus
/// the radius: radius > 0 and >= 2^-44 M, tolerance >= 2^-40 M and >= 2^-30 radius.
PolygonSum offset_polygon(const Polygon& polygon, double radius, Side side, double tolerance);

/// A polygon for drawing.
struct Outline {
  Ring ring;           ///< counter-clockwise points of the boundary, to rounding; at least one
  double error = 0.0;  ///< m; the boundary is within this of the ring
};

/// The boundary of a grown convex shape as a ring of its points for drawing, refined until it is within `tolerance`
/// of the boundary or the directions are 2^-22 rad apart. Rounded (the points), with a bound (the rest): between two
/// points with normals theta apart the boundary stays in the triangle of chord and tangents, of height at
/// most tan(theta/2) chord/2.  REQUIRES: tolerance > 0.
Outline outline(const GrownShape& shape, double tolerance);

}  // namespace exactvo::geometry
