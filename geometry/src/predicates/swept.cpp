// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/swept.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exact/stages.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "predicates/exact_sweep.h"

namespace exactvo::geometry {
namespace {

using detail::difference;
using detail::Exact;
using detail::make;
using detail::sign_of;
using detail::squared;
using Point = detail::Vector<Exact>;

Point exact_sum(const VectorSum& sum) {
  Point total{Exact(0), Exact(0)};
  for (const Vec2 term : sum.terms) {
    total.x = total.x + Exact(term.x);
    total.y = total.y + Exact(term.y);
  }
  return total;
}

bool is_zero(const Point& p) {
  return sign_of(p.x) == Sign::zero && sign_of(p.y) == Sign::zero;
}

void require_motion(const VectorSum& direction, double t_max) {
  for (const Vec2 term : direction.terms) EXACTVO_REQUIRE(is_finite(term), hex_text(term.x) + " " + hex_text(term.y));
  EXACTVO_REQUIRE(t_max >= 0.0, hex_text(t_max));
}

double size_of(Vec2 v) {
  return std::fabs(v.x) + std::fabs(v.y);
}

/// No point of the shape has a larger coordinate, up to rounding.
double extent_of(const ConvexShape& shape) {
  if (const auto* d = std::get_if<Disc>(&shape)) return size_of(d->center) + d->radius;
  if (const auto* e = std::get_if<Ellipse>(&shape))
    return size_of(e->center) + std::fabs(e->l11) + std::fabs(e->l21) + std::fabs(e->l22);
  if (const auto* s = std::get_if<Segment>(&shape)) return size_of(s->a) + size_of(s->b);
  double largest = 0.0;
  for (const Vec2 v : std::get<ConvexPolygon>(shape).vertices) largest = std::max(largest, size_of(v));
  return largest;
}

/// A time after which t v lies beyond S, if a double can say it: the fast predicate then does for ever, too.
double time_beyond(double t_max, Vec2 v, double extent) {
  if (std::isfinite(t_max)) return t_max;
  return std::exp2(std::ceil(std::log2(4.0 * extent / std::max(std::fabs(v.x), std::fabs(v.y)))));
}

Exact finite_time(double t_max, const Point& d, double extent) {
  if (std::isfinite(t_max)) return Exact(t_max);
  return is_zero(d) ? Exact(0) : detail::beyond(d, extent);
}

// --- A polygonal robot ---

/// The corners of the robot at both ends of its way; their hull is the swept robot.
struct Sweep {
  std::vector<Point> start, end;
  Point step;
};

Sweep sweep_of(const ConvexPolygon& robot, const Point& position, const Point& step) {
  Sweep sweep{{}, {}, step};
  for (const Vec2 b : robot.vertices) {
    const Point corner{Exact(b.x) + position.x, Exact(b.y) + position.y};
    sweep.start.push_back(corner);
    sweep.end.push_back({corner.x + step.x, corner.y + step.y});
  }
  return sweep;
}

/// The hull of the vertices and, for an ellipse of no width along x, half a vertical segment of squared length `tall`
/// to both sides of its centre.
struct Flat {
  std::vector<Point> vertices;
  Exact tall{0};
};

void add_edges(const std::vector<Point>& v, std::vector<Point>& out) {
  for (std::size_t i = 0; i < v.size(); ++i) out.push_back(v[(i + 1) % v.size()] - v[i]);
}

/// Whether all of `a` has a smaller n.x than all of the sweep.
bool lies_before(const Flat& a, const Sweep& b, const Point& n) {
  Exact most = dot(n, a.vertices.front());
  for (const Point& v : a.vertices) most = std::max(most, dot(n, v));
  Exact least = dot(n, b.start.front());
  for (const Point& v : b.start) least = std::min(least, dot(n, v));
  const Exact along = dot(n, b.step);
  if (sign_of(along) == Sign::negative) least = least + along;
  return detail::sign_with_two_roots(most - least, squared(n.y) * a.tall, Exact(0)) == Sign::negative;
}

/// Convex sets with finitely many edges are apart iff a line along one of the edges separates them; where all edges are
/// parallel, iff one across does; where there are none, iff their coordinates differ.
bool apart(const Flat& a, const Sweep& b) {
  std::vector<Point> along;
  add_edges(a.vertices, along);
  add_edges(b.start, along);
  along.push_back(b.step);
  along.push_back({Exact(0), Exact(1)});
  along.push_back({Exact(1), Exact(0)});
  for (const Point& e : along) {
    const Point across{Exact(0) - e.y, e.x}, back{e.y, Exact(0) - e.x}, against{Exact(0) - e.x, Exact(0) - e.y};
    if (lies_before(a, b, across) || lies_before(a, b, back) || lies_before(a, b, e) || lies_before(a, b, against))
      return true;
  }
  return false;
}

/// The plane mapped so that the ellipse becomes a disc of radius |det L| round 0: x -> adj(L) (x - centre).
Point mapped(const Ellipse& e, const Point& x) {
  const Point u = x - make<Exact>(e.center);
  return {Exact(e.l22) * u.x, Exact(e.l11) * u.y - Exact(e.l21) * u.x};
}

/// Whether the disc round 0 meets the sweep: 0 lies in it or an edge comes within the radius.
bool disc_meets(const Sweep& b, const Exact& radius) {
  const Point zero{Exact(0), Exact(0)};
  if (!apart({{zero}, Exact(0)}, b)) return true;
  const auto near = [&](const Point& p, const Point& q) {
    return detail::distance_sign(zero, p, q, radius) != Sign::positive;
  };
  for (std::size_t i = 0; i < b.start.size(); ++i) {
    const std::size_t next = (i + 1) % b.start.size();
    if (near(b.start[i], b.start[next]) || near(b.end[i], b.end[next]) || near(b.start[i], b.end[i])) return true;
  }
  return false;
}

bool meets(const Disc& d, Sweep seen) {
  const Point c = make<Exact>(d.center);
  for (auto* corners : {&seen.start, &seen.end})
    for (Point& p : *corners) p = p - c;
  return disc_meets(seen, Exact(d.radius));
}

/// With a width and a height.
bool meets(const Ellipse& e, const Sweep& sweep) {
  Sweep seen;
  for (const Point& p : sweep.start) seen.start.push_back(mapped(e, p));
  for (const Point& p : sweep.end) seen.end.push_back(mapped(e, p));
  seen.step = seen.end.front() - seen.start.front();
  const Exact det = Exact(e.l11) * Exact(e.l22);
  return disc_meets(seen, sign_of(det) == Sign::negative ? Exact(0) - det : det);
}

Flat flat_of(const Ellipse& e) {
  if (e.l11 == 0.0) return {{make<Exact>(e.center)}, squared(Exact(e.l21)) + squared(Exact(e.l22))};
  const auto tip = [&](double side) {
    return Point{Exact(e.center.x) + Exact(side * e.l11), Exact(e.center.y) + Exact(side * e.l21)};
  };
  return {{tip(1.0), tip(-1.0)}, Exact(0)};
}

bool meets(const ConvexShape& shape, const Sweep& sweep) {
  if (const auto* d = std::get_if<Disc>(&shape)) return meets(*d, sweep);
  if (const auto* e = std::get_if<Ellipse>(&shape))
    return e->l11 == 0.0 || e->l22 == 0.0 ? !apart(flat_of(*e), sweep) : meets(*e, sweep);
  Flat flat;
  for (const Vec2 v : corners_of(shape)) flat.vertices.push_back(make<Exact>(v));
  return !apart(flat, sweep);
}

}  // namespace

Vec2 rounded(const VectorSum& sum) {
  const Point total = exact_sum(sum);
  return {CGAL::to_double(total.x), CGAL::to_double(total.y)};
}

bool segment_meets(const GrownShape& s, const VectorSum& direction, double t_max) {
  require_motion(direction, t_max);
  EXACTVO_REQUIRE(is_valid(s.shape) && is_finite(s.origin) && s.radius >= 0.0 && std::isfinite(s.radius),
                  excerpt(s.shape));
  const Point d = exact_sum(direction);
  const double extent = extent_of(s.shape) + size_of(s.origin) + s.radius;
  const Vec2 whole = rounded(direction);
  const double t = time_beyond(t_max, whole, extent);
  if (std::isfinite(t) && is_zero(d - make<Exact>(whole))) return segment_meets(s, whole, t);
  detail::count_exact();
  return detail::segment_meets_exactly(s, d, finite_time(t_max, d, extent));
}

bool sweep_meets(const ConvexShape& obstacle, const ConvexPolygon& robot, Vec2 position, const VectorSum& direction,
                 double t_max) {
  require_motion(direction, t_max);
  EXACTVO_REQUIRE(is_valid(obstacle), excerpt(obstacle));
  EXACTVO_REQUIRE(is_valid(ConvexShape{robot}) && is_finite(position), excerpt(robot.vertices));
  detail::count_exact();
  const Point d = exact_sum(direction);
  const double extent = extent_of(obstacle) + extent_of(robot) + size_of(position);
  const Exact t = finite_time(t_max, d, extent);
  return meets(obstacle, sweep_of(robot, make<Exact>(position), {t * d.x, t * d.y}));
}

}  // namespace exactvo::geometry
