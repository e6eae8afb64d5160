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

}  // namespace

Box box_of(const ConvexShape& shape) {
  if (const auto* d = std::get_if<Disc>(&shape)) return round(d->center, {d->radius, d->radius});
  // h(e_x) = |l11|, h(e_y) = |(l21, l22)|.
  if (const auto* e = std::get_if<Ellipse>(&shape))
    return round(e->center, {std::fabs(e->l11), std::hypot(e->l21, e->l22)});
  if (const auto* s = std::get_if<Segment>(&shape))
    return {{std::min(s->a.x, s->b.x), std::min(s->a.y, s->b.y)}, {std::max(s->a.x, s->b.x), std::max(s->a.y, s->b.y)}};
  Box box;
  for (const Vec2 v : std::get<ConvexPolygon>(shape).vertices) box.add(v);
  return box;
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
