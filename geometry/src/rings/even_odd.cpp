// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/even_odd.h"

#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/exceptions.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/support.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

/// Snap rounding (Hobby, Practical segment intersection with finite precision output, 1999): the plane is divided into
/// square pixels, those that hold a vertex or a crossing are hot, and every edge is bent to run through the centres of
/// the hot pixels that it meets. What comes out meets in vertices only, and no point moves farther than a pixel is
/// wide.

// A parameter t along an edge, and on which side of it a range of parameters begins or ends: {t, false} just before t,
// {t, true} just behind it.
using Bound = std::pair<mpq_class, bool>;

// From low to high; empty unless low < high. At first the edge with both its ends.
struct Range {
  Bound low{0, false};
  Bound high{1, true};
};

// Keeps the parameters t with from <= a + t (b - a) < to.
void clip(double a, double b, const mpq_class& from, const mpq_class& to, Range& range) {
  const mpq_class start(a), step = b - start;
  if (sgn(step) == 0) {
    if (start < from || start >= to) range.high = range.low;
    return;
  }
  const mpq_class at_from = (from - start) / step, at_to = (to - start) / step;
  const bool up = sgn(step) > 0;
  range.low = std::max(range.low, up ? Bound{at_from, false} : Bound{at_to, true});
  range.high = std::min(range.high, up ? Bound{at_to, false} : Bound{at_from, true});
}

// Where the edge enters the pixel, if it meets it.
std::optional<Bound> entry(const Segment& edge, Vec2 centre, double grid) {
  const mpq_class half(grid / 2);
  Range range;
  clip(edge.a.x, edge.b.x, centre.x - half, centre.x + half, range);
  clip(edge.a.y, edge.b.y, centre.y - half, centre.y + half, range);
  if (!(range.low < range.high)) return std::nullopt;
  return range.low;
}

struct Passed {
  Bound entry;
  Vec2 centre;
};

void append_bent(const Segment& edge, const std::vector<Vec2>& hot, double grid, Ring& ring) {
  const double left = std::min(edge.a.x, edge.b.x) - grid, right = std::max(edge.a.x, edge.b.x) + grid;
  const double low = std::min(edge.a.y, edge.b.y) - grid, high = std::max(edge.a.y, edge.b.y) + grid;
  std::vector<Passed> passed;
  const auto x_less = [](Vec2 p, double x) { return p.x < x; };
  for (auto p = std::lower_bound(hot.begin(), hot.end(), left, x_less); p != hot.end() && p->x <= right; ++p) {
    if (p->y < low || p->y > high) continue;
    if (const auto at = entry(edge, *p, grid)) passed.push_back({*at, *p});
  }
  // Pixels are disjoint, so are the stretches of the edge in them.
  std::sort(passed.begin(), passed.end(), [](const Passed& p, const Passed& q) { return p.entry < q.entry; });
  for (const Passed& p : passed) {
    if (ring.empty() || ring.back() != p.centre) ring.push_back(p.centre);
  }
}

/// The rings bent. A pixel is its centre plus [-grid/2, grid/2) in both coordinates. Exact. Takes time in proportion to
/// the edges times the hot pixels in an edge's range of x. REQUIRES: `hot` holds the centre of every pixel with a
/// vertex or a crossing; grid a power of two, and the centres multiples of it.
std::vector<Ring> snap_rounded(const std::vector<Ring>& rings, std::vector<Vec2> hot, double grid) {
  std::sort(hot.begin(), hot.end(), lexicographically_less);
  hot.erase(std::unique(hot.begin(), hot.end()), hot.end());
  std::vector<Ring> bent;
  for (const Ring& ring : rings) {
    Ring& result = bent.emplace_back();
    for (std::size_t i = 0; i < ring.size(); ++i)
      append_bent({ring[i], ring[(i + 1) % ring.size()]}, hot, grid, result);
    while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  }
  return bent;
}

}  // namespace
}  // namespace exactvo::geometry::detail

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
// Every piece of an edge carries the numbers of the edges that it lies on.
using Traits = CGAL::Arr_consolidated_curve_data_traits_2<CGAL::Arr_segment_traits_2<Kernel>, std::size_t>;

struct VertexFacts {
  std::size_t boundary_degree = 0;  // half-edges of the region's boundary that end here
  Vec2 rounded;
  bool is_given = false;  // a vertex of the rings
};

struct FaceFacts {
  bool seen = false;
  bool inside = false;
  std::size_t component = 0;  // of the open region; 0: none yet
};

using Dcel = CGAL::Arr_extended_dcel<Traits, VertexFacts, bool, FaceFacts>;
using Arrangement = CGAL::Arrangement_2<Traits, Dcel>;
using Face = Arrangement::Face_handle;
using HalfEdge = Arrangement::Halfedge_handle;
using Vertex = Arrangement::Vertex_handle;

// --- Rounding ---

// The double nearest to x; a number that is a double comes back as it was.
double nearest_double(const Number& x) {
  const auto interval = CGAL::to_interval(x);
  if (interval.first == interval.second) return interval.first;
  const double truncated = CGAL::to_double(x.exact());
  double best = truncated;
  for (const double other : {std::nextafter(truncated, -HUGE_VAL), std::nextafter(truncated, HUGE_VAL)}) {
    if (std::isfinite(other) && CGAL::abs(x - Number(other)) < CGAL::abs(x - Number(best))) best = other;
  }
  return best;
}

// An upper bound of |exact - rounded|. Certified.
double rounding_of(const Number& exact, double rounded) {
  const auto interval = CGAL::to_interval(exact - Number(rounded));
  return std::max(std::fabs(interval.first), std::fabs(interval.second));
}

// Not less than the exact sum of two numbers >= 0. Nothing and nothing stays nothing.
double sum_rounded_up(double a, double b) {
  if (a == 0.0 || b == 0.0) return a + b;
  return std::nextafter(a + b, std::numeric_limits<double>::infinity());
}

// To doubles, and by how much at most.
class Rounding {
 public:
  Vec2 operator()(const Kernel::Point_2& exact) {
    const Vec2 p = {coordinate(exact.x()), coordinate(exact.y())};
    // The sum of both is not less than their hypotenuse.
    moved_ = std::max(moved_, sum_rounded_up(rounding_of(exact.x(), p.x), rounding_of(exact.y(), p.y)));
    return p;
  }
  double moved() const { return moved_; }

 private:
  static double coordinate(const Number& exact) {
    const double x = nearest_double(exact);
    return x == 0.0 ? 0.0 : x;  // no negative zero
  }

  double moved_ = 0.0;
};

// The k * grid with k * grid - grid / 2 <= x < k * grid + grid / 2. `grid`: a power of two, k exact.
double centre_of_pixel(const Number& x, double grid) {
  const Number half(grid / 2);
  double centre = grid * std::floor(nearest_double(x) / grid + 0.5);
  while (x < Number(centre) - half) centre -= grid;
  while (x >= Number(centre) + half) centre += grid;
  return centre == 0.0 ? 0.0 : centre;
}

// --- The arrangement of the rings ---

std::vector<Traits::Curve_2> edges_of_rings(const std::vector<Ring>& rings) {
  const auto exact = [](Vec2 p) { return Kernel::Point_2(p.x, p.y); };
  std::vector<Traits::Curve_2> edges;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 a = ring[i];
      const Vec2 b = ring[(i + 1) % ring.size()];
      if (a != b) edges.emplace_back(Kernel::Segment_2(exact(a), exact(b)), edges.size());
    }
  }
  return edges;
}

template <class Action>
void for_each_edge_round(const Face& face, const Action& action) {
  const auto walk = [&](HalfEdge first) {
    HalfEdge edge = first;
    do {
      action(edge);
      edge = edge->next();
    } while (edge != first);
  };
  for (auto ccb = face->outer_ccbs_begin(); ccb != face->outer_ccbs_end(); ++ccb) walk(*ccb);
  for (auto ccb = face->inner_ccbs_begin(); ccb != face->inner_ccbs_end(); ++ccb) walk(*ccb);
}

void mark_inside(Arrangement& arrangement) {
  std::vector<Face> open{arrangement.unbounded_face()};
  open.front()->data().seen = true;
  while (!open.empty()) {
    const Face face = open.back();
    open.pop_back();
    for_each_edge_round(face, [&](const HalfEdge& edge) {
      const Face next = edge->twin()->face();
      if (next->data().seen) return;
      next->data().seen = true;
      // Crossing an edge changes sides if an odd number of the rings' edges lie on it.
      next->data().inside = face->data().inside != (edge->curve().data().size() % 2 == 1);
      open.push_back(next);
    });
  }
}

void number_component(const Face& start, std::size_t component) {
  std::vector<Face> open{start};
  start->data().component = component;
  while (!open.empty()) {
    const Face face = open.back();
    open.pop_back();
    for_each_edge_round(face, [&](const HalfEdge& edge) {
      FaceFacts& next = edge->twin()->face()->data();
      if (!next.inside || next.component != 0) return;
      next.component = component;
      open.push_back(edge->twin()->face());
    });
  }
}

// The region on the left, its outside on the right.
bool on_boundary(const HalfEdge& edge) {
  return edge->face()->data().inside && !edge->twin()->face()->data().inside;
}

void describe_vertices(Arrangement& arrangement, const std::vector<Vec2>& given, Rounding& rounding) {
  for (HalfEdge edge : arrangement.halfedge_handles()) {
    if (on_boundary(edge)) ++edge->target()->data().boundary_degree;
  }
  for (Vertex vertex : arrangement.vertex_handles()) {
    VertexFacts& facts = vertex->data();
    if (facts.boundary_degree == 0) continue;
    facts.rounded = rounding(vertex->point());
    facts.is_given = std::binary_search(given.begin(), given.end(), facts.rounded, detail::lexicographically_less) &&
                     vertex->point() == Kernel::Point_2(facts.rounded.x, facts.rounded.y);
  }
}

// --- Rings of the region ---

using Loop = std::vector<Vertex>;

//      \ next: the sharpest turn to the left, so that the region
//       \      between the two edges is one piece
//  ------o
//  edge
HalfEdge next_on_boundary(const HalfEdge& edge) {
  HalfEdge next = edge->next();
  while (!on_boundary(next)) next = next->twin()->next();
  return next;
}

// A walk round the region that passes a vertex twice is two loops that touch there.
std::vector<Loop> cut_at_repeated_vertices(const Loop& walk) {
  std::vector<Loop> loops;
  Loop open;
  std::map<const void*, std::size_t> position;
  for (const Vertex& vertex : walk) {
    const auto [seen, is_new] = position.emplace(&*vertex, open.size());
    if (!is_new) {
      const auto first = open.begin() + static_cast<std::ptrdiff_t>(seen->second);
      loops.emplace_back(first, open.end());
      for (auto gone = first + 1; gone != open.end(); ++gone) position.erase(&**gone);
      open.erase(first + 1, open.end());
      continue;
    }
    open.push_back(vertex);
  }
  loops.push_back(std::move(open));
  return loops;
}

// Where only edges inside or outside of the region crossed its boundary, nothing is to be seen.
bool is_superfluous(const Loop& loop, std::size_t i) {
  const std::size_t n = loop.size();
  const VertexFacts& facts = loop[i]->data();
  return !facts.is_given && facts.boundary_degree == 1 &&
         CGAL::collinear(loop[(i + n - 1) % n]->point(), loop[i]->point(), loop[(i + 1) % n]->point());
}

// From its lexicographically least vertex on.
Ring rounded_ring(const Loop& loop) {
  Ring ring;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 p = loop[i]->data().rounded;
    if (!is_superfluous(loop, i) && (ring.empty() || ring.back() != p)) ring.push_back(p);
  }
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), detail::lexicographically_less), ring.end());
  return ring;
}

bool runs_counter_clockwise(const Loop& loop) {
  const auto less = [](const Vertex& a, const Vertex& b) { return a->point() < b->point(); };
  const auto least = static_cast<std::size_t>(std::min_element(loop.begin(), loop.end(), less) - loop.begin());
  const std::size_t n = loop.size();
  return CGAL::left_turn(loop[(least + n - 1) % n]->point(), loop[least]->point(), loop[(least + 1) % n]->point());
}

Loop walk_from(const HalfEdge& first) {
  Loop walk;
  HalfEdge edge = first;
  do {
    edge->set_data(true);
    walk.push_back(edge->target());
    edge = next_on_boundary(edge);
  } while (edge != first);
  return walk;
}

bool lexicographically_less(const Ring& a, const Ring& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), detail::lexicographically_less);
}

// A component of the open region has one outer ring, and its other loops are holes.
std::vector<Polygon> polygons_of(Arrangement& arrangement, std::size_t components) {
  std::vector<Polygon> polygons(components);
  for (HalfEdge edge : arrangement.halfedge_handles()) edge->set_data(false);
  for (HalfEdge edge : arrangement.halfedge_handles()) {
    if (edge->data() || !on_boundary(edge)) continue;
    Polygon& polygon = polygons[edge->face()->data().component - 1];
    for (const Loop& loop : cut_at_repeated_vertices(walk_from(edge))) {
      Ring ring = rounded_ring(loop);
      if (runs_counter_clockwise(loop)) {
        polygon.outer = std::move(ring);
      } else {
        polygon.holes.push_back(std::move(ring));
      }
    }
  }
  for (Polygon& polygon : polygons) std::sort(polygon.holes.begin(), polygon.holes.end(), lexicographically_less);
  std::sort(polygons.begin(), polygons.end(),
            [](const Polygon& a, const Polygon& b) { return lexicographically_less(a.outer, b.outer); });
  return polygons;
}

// --- Rounds ---

Arrangement arrangement_of(const std::vector<Ring>& rings) {
  Arrangement arrangement;
  const std::vector<Traits::Curve_2> edges = edges_of_rings(rings);
  CGAL::insert(arrangement, edges.begin(), edges.end());
  return arrangement;
}

struct Cut {
  std::vector<Polygon> polygons;  // rounded: valid only where nothing moved into anything else
  double moved = 0.0;
};

Cut cut(const std::vector<Ring>& rings) {
  Arrangement arrangement = arrangement_of(rings);
  mark_inside(arrangement);
  std::size_t components = 0;
  for (Face face : arrangement.face_handles())
    if (face->data().inside && face->data().component == 0) number_component(face, ++components);
  Rounding rounding;
  std::vector<Vec2> vertices;
  for (const Ring& ring : rings) vertices.insert(vertices.end(), ring.begin(), ring.end());
  std::sort(vertices.begin(), vertices.end(), detail::lexicographically_less);
  describe_vertices(arrangement, vertices, rounding);
  Cut result;
  result.polygons = polygons_of(arrangement, components);
  result.moved = rounding.moved();
  return result;
}

std::vector<Ring> rings_of(const std::vector<Polygon>& polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

bool same(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Polygon& p, const Polygon& q) { return p.outer == q.outer && p.holes == q.holes; });
}

// Two units in the last place of the largest coordinate: pixels of that size have exact corners.
double grid_for(const std::vector<Ring>& rings) {
  double largest = 0.0;
  for (const Ring& ring : rings) {
    for (const Vec2 p : ring) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  }
  constexpr int kLeastExponent = -1073;  // of a number whose half is one
  return std::ldexp(1.0, std::max(std::ilogb(largest) - 51, kLeastExponent));
}

std::vector<Ring> snapped(const std::vector<Ring>& rings, double grid) {
  const Arrangement arrangement = arrangement_of(rings);
  std::vector<Vec2> hot;
  for (auto vertex = arrangement.vertices_begin(); vertex != arrangement.vertices_end(); ++vertex)
    hot.push_back({centre_of_pixel(vertex->point().x(), grid), centre_of_pixel(vertex->point().y(), grid)});
  return detail::snap_rounded(rings, std::move(hot), grid);
}

EvenOddRegion cut_until_nothing_changes(std::vector<Ring> rings) {
  EvenOddRegion region;
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    if (round == kPlainRounds) {
      const double grid = grid_for(rings);
      rings = snapped(rings, grid);
      region.moved = sum_rounded_up(region.moved, grid);  // more than half a pixel's diagonal
    }
    Cut next = cut(rings);
    if (round > 0 && same(next.polygons, region.polygons)) return region;
    region.polygons = std::move(next.polygons);
    region.moved = sum_rounded_up(region.moved, next.moved);
    region.rounds = round + 1;
    rings = rings_of(region.polygons);
  }
  return {EvenOddStatus::not_roundable, {}, 0.0, kMostRounds};
}

bool is_small_enough(Vec2 p) {
  return std::max(std::fabs(p.x), std::fabs(p.y)) <= kLargestCutCoordinate;
}

}  // namespace

EvenOddRegion even_odd_region(const std::vector<Ring>& rings) {
  for (const Ring& ring : rings) EXACTVO_REQUIRE(std::all_of(ring.begin(), ring.end(), is_finite), excerpt(ring));
  for (const Ring& ring : rings) {
    if (!std::all_of(ring.begin(), ring.end(), is_small_enough)) return {EvenOddStatus::too_large, {}, 0.0, 0};
  }
  std::size_t edges = 0;
  for (const Ring& ring : rings) edges += ring.size();
  if (detail::has_more_crossings_than(most_crossings(edges), rings))
    return {EvenOddStatus::too_many_crossings, {}, 0.0, 0};
  try {
    return cut_until_nothing_changes(rings);
  } catch (const CGAL::Failure_exception&) {
    return {EvenOddStatus::refused, {}, 0.0, 0};
  }
}

}  // namespace exactvo::geometry
