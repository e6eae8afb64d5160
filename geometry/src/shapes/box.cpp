// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/box.h"

#include <cmath>

#include "exactvo/geometry/rounding.h"

namespace exactvo::geometry {
namespace {

/// Half a box's side, moved up past the roundings of a root of two squares, and centre -+ it past that of the sum.
Box round(Vec2 centre, Vec2 half) {
  constexpr double kUp = 1.0 + 8.0 * kUnitRoundoff;
  const Vec2 sides{half.x * kUp + 4.0 * kUnitRoundoff * std::fabs(centre.x),
                   half.y * kUp + 4.0 * kUnitRoundoff * std::fabs(centre.y)};
  return {centre - sides, centre + sides};
}

struct BoxOf {
  Box operator()(const Disc& d) const { return round(d.center, {d.radius, d.radius}); }
  Box operator()(const Segment& s) const {
    Box box;
    box.add(s.a);
    box.add(s.b);
    return box;
  }
  Box operator()(const ConvexPolygon& p) const {
    Box box;
    for (const Vec2 v : p.vertices) box.add(v);
    return box;
  }
  /// h(e_x) = |l11|, h(e_y) = |(l21, l22)|.
  Box operator()(const Ellipse& e) const { return round(e.center, {std::fabs(e.l11), std::hypot(e.l21, e.l22)}); }
};

}  // namespace

Box box_of(const ConvexShape& shape) {
  return std::visit(BoxOf{}, shape);
}

double distance_below(const Box& box, Vec2 x) {
  const double dx = std::max({box.low.x - x.x, x.x - box.high.x, 0.0});
  const double dy = std::max({box.low.y - x.y, x.y - box.high.y, 0.0});
  return std::sqrt(dx * dx + dy * dy) * (1.0 - 8.0 * kUnitRoundoff);
}

}  // namespace exactvo::geometry
