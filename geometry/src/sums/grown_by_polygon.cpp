// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles grown by a robot that is a convex polygon, rounded outward.
#include <algorithm>
#include <cmath>

#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

ConvexPolygon mirrored(const ConvexPolygon& polygon) {
  ConvexPolygon out;
  for (const Vec2 v : polygon.vertices) out.vertices.push_back(-v);
  return out;
}

/// A polygon and how far beyond it its original may reach.
struct Rounded {
  ConvexPolygon polygon;
  double radius = 0.0;  ///< within the polygon grown by this lies the original
  double error = 0.0;   ///< and that is within this of the original
};

/// A point of the boundary and the direction (angle of the normal) in which it is outermost.
struct Contact {
  double angle = 0.0;
  Vec2 point;
};

Contact contact_at(const Ellipse& e, double angle) {
  return {angle, support_point({e, {}, 0.0}, {std::cos(angle), std::sin(angle)})};
}

/// Adds points of the boundary from a, left out, to b, until the triangle of chord and tangents between neighbours is
/// lower than the tolerance or the directions are 2^-22 of a quarter turn apart. Returns the height of the highest one.
///
///          . apex                   angle theta = b.angle - a.angle
///      .       .                    height <= chord/2 tan(theta/2): it is largest when isosceles
///  a ------------- b
double trace(const Ellipse& e, const Contact& a, const Contact& b, double tolerance, int halvings,
             std::vector<Vec2>& points) {
  const double height = 0.5 * norm(b.point - a.point) * std::tan(0.5 * (b.angle - a.angle));
  if (height <= tolerance || halvings == 0) {
    points.push_back(b.point);
    return height;
  }
  const Contact middle = contact_at(e, 0.5 * (a.angle + b.angle));
  const double before = trace(e, a, middle, tolerance, halvings - 1, points);
  return std::max(before, trace(e, middle, b, tolerance, halvings - 1, points));
}

/// The points are on the boundary but for the rounding of a support point: one product, a sum and a division by a root
/// a coordinate, less than 16 u of the sizes; 32 u leaves room.
Rounded rounded(const Ellipse& e) {
  constexpr double kFineness = 0x1p-12;
  constexpr int kMostHalvings = 22;
  const double size = std::fabs(e.l11) + std::fabs(e.l21) + std::fabs(e.l22);
  if (!(size > 0.0)) return {{{e.center}}, 0.0, 0.0};
  double height = 0.0;
  std::vector<Vec2> points;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Contact from = contact_at(e, quarter * 0.5 * kPi), to = contact_at(e, (quarter + 1) * 0.5 * kPi);
    height = std::max(height, trace(e, from, to, kFineness * size, kMostHalvings, points));
  }
  const double off = height + 32.0 * kUnitRoundoff * (std::fabs(e.center.x) + std::fabs(e.center.y) + size);
  return {convex_hull(points), off, 2.0 * off};
}

Rounded rounded(const ConvexShape& shape) {
  if (const auto* d = std::get_if<Disc>(&shape)) return {{{d->center}}, d->radius, 0.0};
  if (const auto* e = std::get_if<Ellipse>(&shape)) return rounded(*e);
  return {convex_hull(corners_of(shape)), 0.0, 0.0};
}

}  // namespace

OuterShape grown_by_polygon(const ConvexShape& obstacle, const ConvexPolygon& robot, Vec2 position) {
  EXACTVO_REQUIRE(is_valid(obstacle), excerpt(obstacle));
  EXACTVO_REQUIRE(is_valid(ConvexShape{robot}) && is_finite(position), excerpt(robot.vertices));
  const Rounded whole = rounded(obstacle);
  const ConvexSum sum = minkowski_sum(whole.polygon, mirrored(convex_hull(robot.vertices)));
  constexpr double kRoundUp = 1.0 + 4.0 * kUnitRoundoff;  // of one sum of two lengths
  const double radius = sum.error > 0.0 ? (whole.radius + sum.error) * kRoundUp : whole.radius;
  const double error = whole.error + 2.0 * sum.error;
  return {{sum.polygon, position, radius}, error * kRoundUp};
}

}  // namespace exactvo::geometry
