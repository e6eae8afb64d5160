// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/region.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cgal_guard.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_2;
using Line = Kernel::Line_2;
using ExactRing = CGAL::Polygon_2<Kernel>;
using ExactPolygon = CGAL::Polygon_with_holes_2<Kernel>;
using ExactSet = CGAL::Polygon_set_2<Kernel>;

std::string show(const HalfPlane& h) {
  return hex_text(h.normal.x) + " " + hex_text(h.normal.y) + " " + hex_text(h.offset);
}

bool is_in_range(double x) {
  return std::fabs(x) <= kLargestRegionCoordinate;
}
bool is_in_range(Vec2 x) {
  return is_in_range(x.x) && is_in_range(x.y);
}

void require_in_range(const HalfPlane& h) {
  EXACTVO_REQUIRE(is_in_range(h.normal) && is_in_range(h.offset), show(h));
}

void require_in_range(const std::vector<Vec2>& points) {
  EXACTVO_REQUIRE(std::all_of(points.begin(), points.end(), [](Vec2 p) { return is_in_range(p); }), excerpt(points));
}

/// Its positive side is normal.x > offset.
Line line_of(const HalfPlane& h) {
  return {Number(h.normal.x), Number(h.normal.y), -Number(h.offset)};
}

// --- Convex polygons as cycles of lines: a vertex is the crossing of two lines given in doubles, however often the
// polygon was cut, so that its coordinates stay short ---

struct Corner {
  Point at;
  Line leaving;  ///< along the edge to the next corner
};
using Cycle = std::vector<Corner>;

Cycle cycle_of(const std::vector<Vec2>& v) {
  Cycle cycle;
  const auto point = [](Vec2 p) { return Point(Number(p.x), Number(p.y)); };
  for (std::size_t i = 0; i < v.size(); ++i)
    cycle.push_back({point(v[i]), Line(point(v[i]), point(v[(i + 1) % v.size()]))});
  return cycle;
}

Point crossing(const Line& a, const Line& b) {
  const Number det = a.a() * b.b() - a.b() * b.a();
  return {(a.b() * b.c() - b.b() * a.c()) / det, (b.a() * a.c() - a.a() * b.c()) / det};
}

Cycle clipped(const Cycle& cycle, const Line& keep) {
  std::vector<CGAL::Oriented_side> sides;
  for (const Corner& c : cycle) sides.push_back(keep.oriented_side(c.at));
  Cycle out;
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    const CGAL::Oriented_side here = sides[i], next = sides[(i + 1) % cycle.size()];
    const Line& edge = cycle[i].leaving;
    if (here == CGAL::ON_POSITIVE_SIDE) out.push_back(cycle[i]);
    // The kept side is on the left of a line's direction: what comes in goes on along its edge, what goes out turns.
    if (here == CGAL::ON_ORIENTED_BOUNDARY && next == CGAL::ON_POSITIVE_SIDE) out.push_back(cycle[i]);
    if (here == CGAL::ON_ORIENTED_BOUNDARY && next != CGAL::ON_POSITIVE_SIDE) out.push_back({cycle[i].at, keep});
    if (here == CGAL::ON_POSITIVE_SIDE && next == CGAL::ON_NEGATIVE_SIDE) out.push_back({crossing(edge, keep), keep});
    if (here == CGAL::ON_NEGATIVE_SIDE && next == CGAL::ON_POSITIVE_SIDE) out.push_back({crossing(edge, keep), edge});
  }
  return out;
}

bool has_area(const Cycle& cycle) {
  for (std::size_t i = 2; i < cycle.size(); ++i)
    if (CGAL::left_turn(cycle[0].at, cycle[i - 1].at, cycle[i].at)) return true;
  return false;
}

/// Without the corners that repeat another or lie on a straight run.
ExactRing ring_of(const Cycle& cycle) {
  std::vector<Point> points;
  for (const Corner& c : cycle)
    if (points.empty() || points.back() != c.at) points.push_back(c.at);
  while (points.size() > 1 && points.front() == points.back()) points.pop_back();
  ExactRing ring;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i)
    if (CGAL::left_turn(points[(i + n - 1) % n], points[i], points[(i + 1) % n])) ring.push_back(points[i]);
  return ring;
}

// --- Out again, in doubles ---

Bracket bracket_of(const Number& x) {
  const auto interval = CGAL::to_interval(x.exact());
  return {interval.first, interval.second};
}

Number exact_area(const ExactPolygon& polygon) {
  Number sum = polygon.outer_boundary().area();
  for (auto hole = polygon.holes_begin(); hole != polygon.holes_end(); ++hole) sum += hole->area();  // clockwise: < 0
  return sum;
}

Ring rounded(const ExactRing& ring) {
  Ring out;
  for (auto v = ring.vertices_begin(); v != ring.vertices_end(); ++v) {
    const Vec2 p{CGAL::to_double(v->x()), CGAL::to_double(v->y())};
    if (out.empty() || out.back() != p) out.push_back(p);
  }
  return out;
}

Polygon rounded(const ExactPolygon& polygon) {
  Polygon out{rounded(polygon.outer_boundary()), {}};
  for (auto hole = polygon.holes_begin(); hole != polygon.holes_end(); ++hole) out.holes.push_back(rounded(*hole));
  return out;
}

std::vector<ExactPolygon> polygons_of(const ExactSet& set) {
  std::vector<ExactPolygon> polygons;
  set.polygons_with_holes(std::back_inserter(polygons));
  return polygons;
}

template <class Work>
auto guarded(const char* where, Work&& work) {
  return detail::without_cgal_failures(
      where, [] { return std::string("regions of valid polygons"); }, std::forward<Work>(work));
}

}  // namespace

struct Region::Set {
  ExactSet set;
};

Region::Region() : set_(std::make_shared<const Set>()) {}
Region::Region(std::shared_ptr<const Set> set) : set_(std::move(set)) {}

Region Region::hull_of(const std::vector<Vec2>& points) {
  require_in_range(points);
  if (points.empty()) return {};
  return cut(convex_hull(points), {});
}

Region Region::cut(const ConvexPolygon& polygon, const std::vector<HalfPlane>& keep) {
  require_in_range(polygon.vertices);
  EXACTVO_REQUIRE(is_valid(ConvexShape{polygon}), excerpt(polygon.vertices));
  return guarded("Region::cut", [&]() -> Region {
    Cycle cycle = cycle_of(convex_hull(polygon.vertices).vertices);
    if (cycle.size() < 3) return {};
    for (const HalfPlane& h : keep) {
      require_in_range(h);
      if (h.normal == Vec2{}) {
        if (h.offset > 0.0) return {};
        continue;
      }
      cycle = clipped(cycle, line_of(h));
      if (!has_area(cycle)) return {};
    }
    auto out = std::make_shared<Set>();
    out->set.insert(ring_of(cycle));
    return Region(std::move(out));
  });
}

Region Region::cut(const HalfPlane& keep) const {
  require_in_range(keep);
  if (keep.normal == Vec2{}) return keep.offset > 0.0 ? Region() : *this;
  if (is_empty()) return {};
  return guarded("Region::cut", [&]() -> Region {
    // A square round everything, without what the half-plane drops.
    double reach = 0.0;
    for (const ExactPolygon& polygon : polygons_of(set_->set)) {
      const auto box = polygon.outer_boundary().bbox();
      reach = std::max({reach, -box.xmin(), box.xmax(), -box.ymin(), box.ymax()});
    }
    const double r = std::min(2.0 * reach + 1.0, kLargestRegionCoordinate);
    return intersection(cut(ConvexPolygon{{{-r, -r}, {r, -r}, {r, r}, {-r, r}}}, {keep}));
  });
}

Region Region::difference(const Region& other) const {
  return guarded("Region::difference", [&] {
    auto out = std::make_shared<Set>(*set_);
    out->set.difference(other.set_->set);
    return Region(std::move(out));
  });
}

Region Region::intersection(const Region& other) const {
  return guarded("Region::intersection", [&] {
    auto out = std::make_shared<Set>(*set_);
    out->set.intersection(other.set_->set);
    return Region(std::move(out));
  });
}

bool Region::is_empty() const {
  return set_->set.is_empty();
}

Bracket Region::area() const {
  return guarded("Region::area", [&] {
    Number sum(0);
    for (const ExactPolygon& polygon : polygons_of(set_->set)) sum += exact_area(polygon);
    return bracket_of(sum);
  });
}

Place Region::locate(Vec2 x) const {
  EXACTVO_REQUIRE(is_in_range(x), hex_text(x.x) + " " + hex_text(x.y));
  return guarded("Region::locate", [&] {
    const CGAL::Oriented_side side = set_->set.oriented_side(Point(Number(x.x), Number(x.y)));
    if (side == CGAL::ON_ORIENTED_BOUNDARY) return Place::boundary;
    return side == CGAL::ON_POSITIVE_SIDE ? Place::inside : Place::outside;
  });
}

std::vector<Region::Piece> Region::pieces() const {
  return guarded("Region::pieces", [&] {
    std::vector<Piece> pieces;
    for (const ExactPolygon& polygon : polygons_of(set_->set)) {
      auto alone = std::make_shared<Set>();
      alone->set.insert(polygon);
      pieces.push_back({Region(std::move(alone)), rounded(polygon), bracket_of(exact_area(polygon))});
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.area.high > b.area.high; });
    return pieces;
  });
}

}  // namespace exactvo::geometry
