// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/swept.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exact/stages.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "predicates/exact_sweep.h"

namespace exactvo::geometry {
namespace {

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

Exact finite_time(double t_max, const Point& d, double extent) {
  if (std::isfinite(t_max)) return Exact(t_max);
  return is_zero(d) ? Exact(0) : detail::beyond(d, extent);
}

// --- A polygonal robot ---

/// The robot's corners where it starts, and how far it moves.
struct Sweep {
  std::vector<Point> start;
  Point step;
};

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

/// Seen from the robot, the disc moves the other way.
bool meets(const Disc& d, Sweep seen) {
  for (Point& p : seen.start) p = p - make<Exact>(d.center);
  return detail::hull_meets(seen.start, Exact(d.radius), {-seen.step.x, -seen.step.y});
}

/// With a width and a height. The plane is mapped so that the ellipse becomes a disc of radius det L round 0: x ->
/// adj(L) (x - centre), without a mirror image: the columns of L may be turned round, so that det L > 0.
bool meets(const Ellipse& e, const Sweep& sweep) {
  const Exact l11(std::fabs(e.l11)), l21(e.l11 < 0.0 ? -e.l21 : e.l21), l22(std::fabs(e.l22));
  const auto mapped = [&](const Point& u) { return Point{l22 * u.x, l11 * u.y - l21 * u.x}; };
  std::vector<Point> seen;
  for (const Point& p : sweep.start) seen.push_back(mapped(p - make<Exact>(e.center)));
  return detail::hull_meets(seen, l11 * l22, mapped({-sweep.step.x, -sweep.step.y}));
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
  const double extent = box_of(s.shape).largest_coordinate() + size_of(s.origin) + s.radius;
  const Vec2 whole = rounded(direction);
  // A time after which t v lies beyond S, if a double can say it: the fast predicate then does for ever, too.
  const double fastest = std::max(std::fabs(whole.x), std::fabs(whole.y));
  const double t = std::isfinite(t_max) ? t_max : std::exp2(std::ceil(std::log2(4.0 * extent / fastest)));
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
  const double extent = box_of(obstacle).largest_coordinate() + box_of(robot).largest_coordinate() + size_of(position);
  const Exact t = finite_time(t_max, d, extent);
  Sweep sweep{{}, {t * d.x, t * d.y}};
  for (const Vec2 b : robot.vertices) sweep.start.push_back(make<Exact>(b) + make<Exact>(position));
  return meets(obstacle, sweep);
}

}  // namespace exactvo::geometry
