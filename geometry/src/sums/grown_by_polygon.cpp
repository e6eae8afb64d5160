// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/minkowski.h"
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

struct RoundedShape {
  Rounded operator()(const Disc& d) const { return {{{d.center}}, d.radius, 0.0}; }
  Rounded operator()(const Segment& s) const { return {convex_hull({s.a, s.b}), 0.0, 0.0}; }
  Rounded operator()(const ConvexPolygon& p) const { return {convex_hull(p.vertices), 0.0, 0.0}; }
  /// The outline's points are on the boundary but for the rounding of a support point: one product, a sum and a
  /// division by a root a coordinate, less than 16 u of the sizes; 32 u leaves room.
  Rounded operator()(const Ellipse& e) const {
    constexpr double kFineness = 0x1p-12;
    const double size = std::fabs(e.l11) + std::fabs(e.l21) + std::fabs(e.l22);
    if (!(size > 0.0)) return {{{e.center}}, 0.0, 0.0};
    const Outline ring = outline({e, {}, 0.0}, kFineness * size);
    const double off = ring.error + 32.0 * kUnitRoundoff * (std::fabs(e.center.x) + std::fabs(e.center.y) + size);
    return {convex_hull(ring.ring), off, 2.0 * off};
  }
};

}  // namespace

OuterShape grown_by_polygon(const ConvexShape& obstacle, const ConvexPolygon& robot, Vec2 position) {
  EXACTVO_REQUIRE(is_valid(obstacle), excerpt(obstacle));
  EXACTVO_REQUIRE(is_valid(ConvexShape{robot}) && is_finite(position), excerpt(robot.vertices));
  Rounded whole = std::visit(RoundedShape{}, obstacle);
  const ConvexSum sum = minkowski_sum(whole.polygon, mirrored(convex_hull(robot.vertices)));
  constexpr double kRoundUp = 1.0 + 4.0 * kUnitRoundoff;  // of one sum of two lengths
  const double radius = sum.error > 0.0 ? (whole.radius + sum.error) * kRoundUp : whole.radius;
  const double error = whole.error + 2.0 * sum.error;
  return {{sum.polygon, position, radius}, error * kRoundUp};
}

}  // namespace exactvo::geometry
