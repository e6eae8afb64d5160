// SPDX-License-Identifier: GPL-3.0-or-later
// Points against polygon (+) disc: `locate` against the conic arrangement of CGAL's offset_polygon_2 (exact_offset.h).
#include "geometry/exact_offset.h"
#include "geometry/random_grown.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

using geometry::GrownShape;
using geometry::Place;
using geometry::Vec2;

std::string text_of(const GrownShape& s, Vec2 q) {
  using geometry::hex_text;
  return to_string(s.shape) + "  radius " + hex_text(s.radius) + "  point " + hex_text(q.x) + " " + hex_text(q.y);
}

constexpr int kPointsAShape = 50;  // building the arrangement costs as much as locating many points

/// A polygon on a grid that has an area.
geometry::ConvexPolygon grid_polygon(SeededRandom& random, int reach) {
  for (;;) {
    std::vector<Vec2> points;
    for (int k = 0; k < 5; ++k)
      points.push_back({1.0 * random.integer(-reach, reach), 1.0 * random.integer(-reach, reach)});
    geometry::ConvexPolygon hull = geometry::convex_hull(points);
    if (hull.vertices.size() > 2) return hull;
  }
}

}  // namespace

Tally compare_offsets(const Asked& asked) {
  Tally tally;
  SeededRandom random(asked.seed);
  while (tally.random_cases() < asked.random) {
    const GrownShape s{random_convex_polygon(random, {}, 1.0, random.integer(3, 5)), {}, random.uniform(0.05, 0.6)};
    const auto& polygon = std::get<geometry::ConvexPolygon>(s.shape);
    if (polygon.vertices.size() < 3) continue;
    const ExactOffset exact({polygon.vertices, {}}, s.radius);
    for (int k = 0; k < kPointsAShape; ++k) {
      const Vec2 q = k % 2 == 0 ? random.in_box(2.0) : support_point(s, random.direction());
      tally.random(exact.locate(q) == locate(s, q), text_of(s, q));
    }
  }
  while (tally.constructed_cases() < asked.constructed) {
    const Pythagorean n = random_pythagorean(random);
    const GrownShape s{grid_polygon(random, 30), {}, n.h};
    const auto& v = std::get<geometry::ConvexPolygon>(s.shape).vertices;
    const ExactOffset exact({v, {}}, s.radius);
    for (int k = 0; k < kPointsAShape; ++k) {  // on the circles round the corners: on the boundary or inside
      const Vec2 quarters[] = {{n.p, n.q}, {-n.q, n.p}, {-n.p, -n.q}, {n.q, -n.p}};
      const Vec2 turned = quarters[k % 4];
      Vec2 q = v[static_cast<std::size_t>(k) % v.size()] + turned;
      if (k % 3 == 0) q.x = std::nextafter(q.x, k % 2 == 0 ? -1e300 : 1e300);
      const Place place = exact.locate(q);
      if (place == Place::boundary) tally.at_a_contact();
      tally.constructed(place == locate(s, q), text_of(s, q));
    }
  }
  return tally;
}

}  // namespace exactvo::test
