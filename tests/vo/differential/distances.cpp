// SPDX-License-Identifier: GPL-3.0-or-later
// Points and segments against discs, segments and polygons grown by discs: `locate` and `segment_meets` against squared
// distances in CGAL's exact kernel.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/squared_distance_2.h>

#include <algorithm>

#include "geometry/random_grown.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_2;
using geometry::GrownShape;
using geometry::Place;
using geometry::Vec2;

Point exact(Vec2 p) {
  return {Number(p.x), Number(p.y)};
}

std::vector<Point> exact_corners(const geometry::ConvexShape& shape) {
  if (const auto* d = std::get_if<geometry::Disc>(&shape)) return {exact(d->center)};
  if (const auto* s = std::get_if<geometry::Segment>(&shape)) return {exact(s->a), exact(s->b)};
  std::vector<Point> out;
  for (const Vec2 v : std::get<geometry::ConvexPolygon>(shape).vertices) out.push_back(exact(v));
  return out;
}

Number radius_of(const GrownShape& s) {
  const auto* d = std::get_if<geometry::Disc>(&s.shape);
  return Number(s.radius) + (d != nullptr ? Number(d->radius) : Number(0));
}

/// The squared distance between the hull of the corners and the segment; 0 where they meet.
Number squared_distance_to_hull(const std::vector<Point>& corners, const Point& a, const Point& b) {
  if (corners.size() > 2) {
    const CGAL::Polygon_2<Kernel> hull(corners.begin(), corners.end());
    if (!hull.has_on_unbounded_side(a)) return 0;
  }
  const Kernel::Segment_2 path(a, b);
  Number least = CGAL::squared_distance(path, corners.front());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Kernel::Segment_2 edge(corners[i], corners[(i + 1) % corners.size()]);
    const Number here = edge.is_degenerate()   ? CGAL::squared_distance(path, edge.source())
                        : path.is_degenerate() ? CGAL::squared_distance(a, edge)
                                               : CGAL::squared_distance(path, edge);
    least = std::min(least, here);
  }
  return least;
}

/// Where q (absolute) lies. Without a radius the boundary is where the hull's interior is not.
Place expected_place(const GrownShape& s, const Point& q) {
  const std::vector<Point> corners = exact_corners(s.shape);
  const Number r = radius_of(s), d2 = squared_distance_to_hull(corners, q, q);
  if (CGAL::is_zero(d2)) {
    if (!CGAL::is_zero(r)) return Place::inside;
    if (corners.size() < 3) return Place::boundary;
    const CGAL::Polygon_2<Kernel> hull(corners.begin(), corners.end());
    return hull.has_on_bounded_side(q) ? Place::inside : Place::boundary;
  }
  const auto sign = CGAL::compare(d2, r * r);
  return sign == CGAL::SMALLER ? Place::inside : sign == CGAL::EQUAL ? Place::boundary : Place::outside;
}

struct Case {
  GrownShape s;
  Vec2 v;  ///< q = v, seen from the robot; the path is [0, tau v]
  double tau;
};

std::string text_of(const Case& c) {
  using geometry::hex_text;
  return to_string(c.s.shape) + "  origin " + hex_text(c.s.origin.x) + " " + hex_text(c.s.origin.y) + "  radius " +
         hex_text(c.s.radius) + "  v " + hex_text(c.v.x) + " " + hex_text(c.v.y) + "  tau " + hex_text(c.tau);
}

bool agrees(const Case& c, Tally& tally) {
  const Point o = exact(c.s.origin);
  const Point q(o.x() + Number(c.v.x), o.y() + Number(c.v.y));
  const Point end(o.x() + Number(c.tau) * Number(c.v.x), o.y() + Number(c.tau) * Number(c.v.y));
  const Place place = expected_place(c.s, q);
  const Number r = radius_of(c.s);
  const auto met = CGAL::compare(squared_distance_to_hull(exact_corners(c.s.shape), o, end), r * r);
  if (place == Place::boundary || met == CGAL::EQUAL) tally.at_a_contact();
  return locate(c.s, c.v) == place && segment_meets(c.s, c.v, c.tau) == (met != CGAL::LARGER);
}

Case random_case(SeededRandom& random, long i) {
  const Kind kinds[] = {Kind::disc, Kind::segment, Kind::polygon};
  const RandomScene scene = random_scene(random, kinds[i % 3]);
  const double tau = random.uniform(0.1, 10.0);
  const Vec2 at = support_point(scene.s, random.direction());
  return {scene.s, random.uniform(0.0, 1.0) < 0.5 ? at / tau : random.uniform(0.5, 1.5) * at, tau};
}

/// Whole numbers times a power of two: a corner, a Pythagorean step from it, and a path through that point along the
/// disc's tangent there.
Case constructed_case(SeededRandom& random, long i) {
  const double unit = std::ldexp(1.0, random.integer(-30, 30));
  const auto whole = [&](int reach) {
    return unit * Vec2{1.0 * random.integer(-reach, reach), 1.0 * random.integer(-reach, reach)};
  };
  Case c{};
  std::vector<Vec2> points;
  for (int k = 0; k < 1 + i % 5; ++k) points.push_back(whole(20));
  const geometry::ConvexPolygon hull = geometry::convex_hull(points);
  const Pythagorean n = random_pythagorean(random);
  const double grown = random.integer(0, 4);
  c.s.radius = unit * n.h * grown;
  c.s.shape = hull;
  if (hull.vertices.size() == 1 && i % 2 == 0) c.s.shape = geometry::Disc{hull.vertices[0], unit * n.h};
  const double whole_radius = grown + (std::holds_alternative<geometry::Disc>(c.s.shape) ? 1.0 : 0.0);
  const Vec2 corner =
      hull.vertices[static_cast<std::size_t>(random.integer(0, static_cast<int>(hull.vertices.size()) - 1))];
  const Vec2 touch = corner + unit * whole_radius * Vec2{n.p, n.q};
  const Vec2 along = unit * Vec2{-n.q, n.p};
  const int kind = random.integer(0, 2);
  if (kind == 0) {  // the point itself, from anywhere
    c.s.origin = whole(50);
    c.v = touch - c.s.origin;
    c.tau = 1.0;
  } else {  // a path that passes or ends at it
    c.s.origin = touch - 1.0 * random.integer(0, 6) * along;
    c.v = along;
    c.tau = random.integer(1, 8);
  }
  if (kind == 2) c.s.radius = std::nextafter(c.s.radius, random.integer(0, 1) == 0 ? 0.0 : 1e300);
  return c;
}

}  // namespace

Tally compare_distances(const Asked& asked) {
  Tally tally;
  SeededRandom random(asked.seed);
  for (long i = 0; i < asked.random; ++i) {
    const Case c = random_case(random, i);
    tally.random(agrees(c, tally), text_of(c));
  }
  for (long i = 0; i < asked.constructed; ++i) {
    const Case c = constructed_case(random, i);
    tally.constructed(agrees(c, tally), text_of(c));
  }
  return tally;
}

}  // namespace exactvo::test
