// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/round_polygon.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry {
namespace {

/// Share of the coordinates: smaller discs are refused.
constexpr double kLeastShare = 0x1p-40;

/// cos and sin of pi / 32 and pi / 16: by half angles from pi / 2, with square roots and products alone, so that every
/// machine has the same polygon.
struct Turns {
  Vec2 half{0.0, 1.0}, whole{};
  Turns() {
    for (int halvings = 0; halvings < 4; ++halvings) {
      whole = half;
      half = {std::sqrt(0.5 * (1.0 + whole.x)), std::sqrt(0.5 * (1.0 - whole.x))};
    }
  }
};

Polygon regular(Vec2 center, double to_corner, const Turns& turns) {
  Polygon polygon;
  Vec2 w = turns.half;
  for (int k = 0; k < kRoundCorners; ++k) {
    polygon.outer.push_back(center + to_corner * w);
    w = {turns.whole.x * w.x - turns.whole.y * w.y, turns.whole.x * w.y + turns.whole.y * w.x};
  }
  return polygon;
}

}  // namespace

bool holds_disc(const Polygon& polygon, const Disc& disc) {
  const Ring& ring = polygon.outer;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Segment edge{ring[k], ring[(k + 1) % ring.size()]};
    if (orientation(edge.a, edge.b, disc.center) != Sign::positive) return false;
    if (locate({edge, {}, disc.radius}, disc.center) == Place::inside) return false;
  }
  return ring.size() > 2;
}

Polygon polygon_round(const Disc& disc) {
  const double size = std::max(std::fabs(disc.center.x), std::fabs(disc.center.y)) + disc.radius;
  if (!std::isfinite(size) || !(disc.radius > 0.0) || !(disc.radius >= kLeastShare * size))
    throw std::invalid_argument("polygon_round: " + to_string(ConvexShape{disc}));
  const Turns turns;
  for (double more = 0x1p-50 * size; more <= 0x1p-46 * size; more *= 2.0) {
    Polygon polygon = regular(disc.center, disc.radius / turns.half.x + more, turns);
    if (holds_disc(polygon, disc)) return polygon;
  }
  throw std::logic_error("polygon_round: no polygon round " + to_string(ConvexShape{disc}));
}

}  // namespace exactvo::geometry
