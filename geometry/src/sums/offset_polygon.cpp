// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/exact_number.h"
#include "exactvo/geometry/minkowski.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

/// Below this part of the radius a tolerance asks for more than 10^5 corners.
constexpr double kFinestOfRadius = 0x1p-30;
/// Below these parts of the coordinates the rounding of the sum would show.
constexpr double kFinestOfReach = 0x1p-40;
constexpr double kLeastRadiusOfReach = 0x1p-44;

double largest_coordinate(const Polygon& polygon) {
  double largest = 0.0;
  for (const Vec2 p : vertices_of(polygon)) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

// Corners so that the polygon stays within half the tolerance of the circle: r (1/cos(pi/k) - 1) <= tolerance / 2.
int corners_for(double radius, double tolerance) {
  const double half_angle = std::acos(1.0 / (1.0 + 0.5 * tolerance / radius));
  return static_cast<int>(std::max(4.0, std::ceil(kPi / half_angle)));
}

Ring regular_ring(double radius, int corners) {
  Ring ring;
  ring.reserve(static_cast<std::size_t>(corners));
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPi * i / corners;
    ring.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return ring;
}

bool lies_in_disc(const Ring& ring, double radius) {
  const GrownShape disc = {Disc{{}, radius}, {}, 0.0};
  return std::all_of(ring.begin(), ring.end(), [&](Vec2 p) { return locate(disc, p) != Place::outside; });
}

// Whether the line through a and b, seen from the origin on its left, keeps `radius` off it. Exact.
bool clears(Vec2 a, Vec2 b, double radius) {
  using detail::Exact;
  const Exact ax(a.x), ay(a.y), bx(b.x), by(b.y), r(radius);
  const Exact area = ax * by - ay * bx;
  const Exact dx = bx - ax, dy = by - ay;
  return detail::sign_of(area) == Sign::positive &&
         detail::sign_of(area * area - r * r * (dx * dx + dy * dy)) != Sign::negative;
}

bool contains_disc(const Ring& ring, double radius) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!clears(ring[i], ring[(i + 1) % ring.size()], radius)) return false;
  }
  return true;
}

// A polygon of the disc of `radius`, within or around it: checked exactly, moved until it passes.
Ring polygon_of_disc(double radius, int corners, Side side) {
  const double ring_radius = side == Side::inside ? radius : radius / std::cos(kPi / corners);
  for (double growth = 4.0 * kUnitRoundoff;; growth *= 2.0) {
    const double factor = side == Side::inside ? 1.0 - growth : 1.0 + growth;
    Ring ring = regular_ring(ring_radius * factor, corners);
    if (side == Side::inside ? lies_in_disc(ring, radius) : contains_disc(ring, radius)) return ring;
  }
}

bool is_valid_request(double radius, double tolerance, double reach) {
  return std::isfinite(reach) && radius > 0.0 && radius >= kLeastRadiusOfReach * reach && std::isfinite(tolerance) &&
         tolerance >= kFinestOfReach * reach && tolerance >= kFinestOfRadius * radius;
}

}  // namespace

// Rounding moves the boundary of the sum by at most e, so the rounded set lies within the exact sum grown by e and
// contains whatever of it lies deeper than e. A disc of radius r -+ 2 e therefore leaves room for it.
PolygonSum offset_polygon(const Polygon& polygon, double radius, Side side, double tolerance) {
  const double reach = largest_coordinate(polygon) + radius;
  EXACTVO_REQUIRE(is_valid_request(radius, tolerance, reach),
                  "radius " + hex_text(radius) + ", tolerance " + hex_text(tolerance));
  double room = 16.0 * kUnitRoundoff * reach;  // one ulp a coordinate is expected
  for (;; room *= 2.0) {
    const double own = side == Side::inside ? radius - room : radius + room;
    const Ring disc = polygon_of_disc(std::max(own, 0.5 * radius), corners_for(radius, 0.5 * tolerance), side);
    PolygonSum sum = minkowski_sum(polygon, Polygon{disc, {}});
    if (2.0 * sum.error > room) continue;
    // Half the tolerance went to the corners, the rest bounds room, growth and rounding many times over.
    sum.error = tolerance;
    return sum;
  }
}

}  // namespace exactvo::geometry
