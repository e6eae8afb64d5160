// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/box.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// A difference of doubles carries u and never underflows. Where the sum of squares is neither tiny nor infinite, what
// underflows in it is less than u of it: squares and sum carry 4 u, the root 3 u, the last product and its factor 2 u.
double distance_below(const Box& box, Vec2 x) {
  constexpr double kDown = 1.0 - 10.0 * kUnitRoundoff;
  constexpr double kTiny = 0x1p-900, kMost = std::numeric_limits<double>::max();
  const double dx = std::max({box.low.x - x.x, x.x - box.high.x, 0.0});
  const double dy = std::max({box.low.y - x.y, x.y - box.high.y, 0.0});
  const double squares = dx * dx + dy * dy;
  if (squares > kTiny && squares <= kMost) return std::sqrt(squares) * kDown;
  if (!(squares > 1.0)) return std::max(dx, dy) * kDown;
  return box.is_empty() ? squares : std::min(std::hypot(dx, dy), kMost) * kDown;
}

}  // namespace exactvo::geometry
