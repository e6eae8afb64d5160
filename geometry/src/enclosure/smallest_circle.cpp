// SPDX-License-Identifier: GPL-3.0-or-later
// `smallest_circle` of hull.h. The search rounds; what it returns is certified to contain the points.
#include <algorithm>
#include <cmath>
#include <limits>

#include "enclosure/ellipse_solver.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

double reach(Vec2 center, const std::vector<Vec2>& points) {
  double farthest = 0.0;
  for (const Vec2 p : points) farthest = std::max(farthest, std::hypot(p.x - center.x, p.y - center.y));
  return farthest;
}

Vec2 farthest_from(Vec2 center, const std::vector<Vec2>& points) {
  const auto nearer = [&](Vec2 a, Vec2 b) { return squared_norm(a - center) < squared_norm(b - center); };
  return *std::max_element(points.begin(), points.end(), nearer);
}

Vec2 circumcenter(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 u = b - a;
  const Vec2 v = c - a;
  const Vec2 w = squared_norm(u) * v - squared_norm(v) * u;
  return a - perp(w) / (2.0 * cross(u, v));
}

// A circle and the two or three points that hold it.
struct HeldCircle {
  Vec2 center;
  double radius = std::numeric_limits<double>::infinity();
  std::vector<Vec2> holders;
};

void take_if_smaller(Vec2 center, const std::vector<Vec2>& points, std::vector<Vec2> holders, HeldCircle& best) {
  const double radius = reach(center, points);
  if (radius < best.radius) best = {center, radius, std::move(holders)};  // false for the NaN of a flat triangle
}

// At most four points: the smallest circle is centred between two of them or at a circumcentre.
HeldCircle smallest_of_few(const std::vector<Vec2>& points) {
  HeldCircle best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      take_if_smaller(0.5 * (points[i] + points[j]), points, {points[i], points[j]}, best);
      for (std::size_t k = 0; k < j; ++k) {
        const Vec2 center = circumcenter(points[i], points[j], points[k]);
        take_if_smaller(center, points, {points[i], points[j], points[k]}, best);
      }
    }
  }
  return best;
}

// The farthest outsider joins the holders until there is none. The radius grows in every round, so no set of holders
// comes back.
Vec2 center_in_unit_scale(const std::vector<Vec2>& points) {
  constexpr double kRoundingOfARadius = 8.0 * kUnitRoundoff;
  const Vec2 first = farthest_from(points.front(), points);
  HeldCircle circle = smallest_of_few({first, farthest_from(first, points)});
  for (;;) {
    const Vec2 outsider = farthest_from(circle.center, points);
    if (norm(outsider - circle.center) <= circle.radius * (1.0 + kRoundingOfARadius)) return circle.center;
    std::vector<Vec2> few = circle.holders;
    few.push_back(outsider);
    HeldCircle next = smallest_of_few(few);
    if (!(next.radius > circle.radius)) return circle.center;
    circle = std::move(next);
  }
}

// Seen from one of the points and scaled to unit size, so that squares neither overflow nor drown in an offset.
Vec2 center_of_smallest_circle(const std::vector<Vec2>& points) {
  const Vec2 origin = points.front();
  const double scale = reach(origin, points);
  std::vector<Vec2> unit;
  unit.reserve(points.size());
  for (const Vec2 p : points) unit.push_back((p - origin) / scale);
  return origin + scale * center_in_unit_scale(unit);
}

bool contains_all(const Disc& disc, const std::vector<Vec2>& points) {
  const GrownShape shape = {disc, {}, 0.0};
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) { return locate(shape, p) != Place::outside; });
}

// hypot and the subtraction are off by 3 u; 4 u grows past that in one step almost always.
Disc certified_circle(Vec2 center, const std::vector<Vec2>& points) {
  double radius = reach(center, points);
  for (double growth = 4.0 * kUnitRoundoff;; growth *= 2.0) {
    if (contains_all({center, radius}, points)) return {center, radius};
    radius *= 1.0 + growth;
  }
}

}  // namespace

Disc smallest_circle(const std::vector<Vec2>& points) {
  detail::require_places(points);
  const std::vector<Vec2> hull = convex_hull(points).vertices;
  if (hull.size() == 1) return {hull.front(), 0.0};
  return certified_circle(center_of_smallest_circle(hull), hull);
}

}  // namespace exactvo::geometry
