// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The shapes of the project: plain values of doubles in metres. All are closed sets. `is_valid` functions say whether
/// a value is one that the other headers accept; nothing here rounds.
///
/// See also: support.h (support functions), predicates.h (exact questions), enclosure.h (ellipses round facades).

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry {

/// { x : |x - center| <= radius }, radius >= 0.
struct Disc {
  Vec2 center;          ///< m
  double radius = 0.0;  ///< m, >= 0
};

/// The segment from `a` to `b`; `a == b` is a point.
struct Segment {
  Vec2 a;  ///< m, where it begins
  Vec2 b;  ///< m, where it ends
};

/// The convex hull of its vertices, listed counter-clockwise, at least one; collinear vertices are tolerated.
struct ConvexPolygon {
  std::vector<Vec2> vertices;  ///< m
};

/// { center + L w : |w| <= 1 } with L = [l11 0; l21 l22]. L is the truth (it is exact whatever its entries);
/// Sigma = L L^T, axes and angle are derived and rounded. l22 = 0 is a segment, all zero a point.
struct Ellipse {
  Vec2 center;       ///< m, c
  double l11 = 0.0;  ///< m, first row of L
  double l21 = 0.0;  ///< m, second row of L
  double l22 = 0.0;  ///< m, second row of L
};

/// A compact convex obstacle, the only kind a velocity obstacle is built of.
using ConvexShape = std::variant<Disc, Segment, ConvexPolygon, Ellipse>;

/// An open chain of segments: a wall seen from both sides. At least two points.
struct Polyline {
  std::vector<Vec2> points;  ///< m, in order
};

/// A closed ring without repetition of its first vertex.
using Ring = std::vector<Vec2>;

/// A polygon with holes; `outer` counter-clockwise, holes clockwise, all simple.
struct Polygon {
  Ring outer;               ///< m
  std::vector<Ring> holes;  ///< m
};

/// An obstacle as it stands in a scene.
using Obstacle = std::variant<Polyline, Polygon>;

/// Rounded axes of an ellipse: semi-axes a >= b >= 0 (m) and the angle of the a axis (rad, in (-pi/2, pi/2]).
struct EllipseAxes {
  double a = 0.0;      ///< m, the longer semi-axis
  double b = 0.0;      ///< m, the shorter semi-axis
  double angle = 0.0;  ///< rad, of the longer axis against x
};

/// Rounded: the returned L is within a few ulps of the ellipse asked for.
/// REQUIRES: a >= b >= 0, finite.
Ellipse ellipse_from_axes(Vec2 center, EllipseAxes axes);

/// Rounded.
EllipseAxes axes_of(const Ellipse& ellipse);

/// Area pi |det L|, rounded.
double area(const Ellipse& ellipse);

/// Whether every number is finite, the radius of a disc is non-negative, and a convex polygon has a vertex and either
/// lies on one line or runs once round counter-clockwise and never turns right. Repeated and collinear vertices are
/// tolerated. Exact; O(n) orientation tests for a polygon.
bool is_valid(const ConvexShape& shape);

/// The ends of a segment or the vertices of a polygon; none of a disc or an ellipse.
std::vector<Vec2> corners_of(const ConvexShape& shape);

/// Every edge of the obstacle: a polyline's segments; a polygon's outer ring, then its holes.
std::vector<Segment> edges_of(const Obstacle& obstacle);

/// Every vertex of the obstacle, in the order of `edges_of`.
std::vector<Vec2> vertices_of(const Obstacle& obstacle);

/// Adds `by` to every vertex. Rounded.
void shift(Obstacle& obstacle, Vec2 by);

/// Whether the obstacle has an inside (a polygon) or is a bare wall.
inline bool has_interior(const Obstacle& obstacle) {
  return std::holds_alternative<Polygon>(obstacle);
}

/// The number as a hex float ("%a"): reads back losslessly.
std::string hex_text(double value);

/// "n x1 y1 ... xn yn", hex floats: reads back losslessly.
std::string to_string(const std::vector<Vec2>& points);

/// The same for error messages: at most `kVerticesShown` points, then "...".
std::string excerpt(const std::vector<Vec2>& points);
/// How many points an excerpt shows.
inline constexpr std::size_t kVerticesShown = 4;

/// The shape in one line for messages, hex floats: reads back losslessly. `disc cx cy r`, `segment ax ay bx by`,
/// `convex_polygon n x1 y1 ...`, `ellipse cx cy l11 l21 l22`.
std::string to_string(const ConvexShape& shape);

}  // namespace exactvo::geometry
