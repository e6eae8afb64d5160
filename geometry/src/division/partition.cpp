// SPDX-License-Identifier: GPL-3.0-or-later
// `convex_pieces` of hull.h: chooses a method, asks CGAL or merged_triangles.cpp, and proves every answer
// before it is given.
#define CGAL_DEBUG 1  // assertions on whatever the build: see proved_pieces_by_cgal
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Partition_traits_2.h>
#include <CGAL/partition_2.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cgal_guard.h"
#include "division/merged_triangles.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/names.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shapes.h"
#include "exactvo/geometry/validity.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

/// The proof that some polygons are a partition of a ring into convex pieces.

/// An edge, its lesser end first, and how often it is run along less how often against.
using Run = std::pair<std::array<double, 4>, int>;

void add_runs(const std::vector<Vec2>& ring, int times, std::vector<Run>& runs) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const bool along = lexicographically_less(a, b);
    runs.push_back(along ? Run{{a.x, a.y, b.x, b.y}, times} : Run{{b.x, b.y, a.x, a.y}, -times});
  }
}

/// Whether every edge is run along as often as against.
bool cancel_out(std::vector<Run>& runs) {
  std::sort(runs.begin(), runs.end());
  for (std::size_t i = 0; i < runs.size();) {
    int sum = 0;
    const std::size_t first = i;
    for (; i < runs.size() && runs[i].first == runs[first].first; ++i) sum += runs[i].second;
    if (sum != 0) return false;
  }
  return true;
}

/// True proves that the pieces are convex, cover the polygon of the rings (outer counter-clockwise, holes clockwise,
/// a valid polygon) and nothing else, and overlap nowhere. Exact, O(n log n).
///
/// Why: each piece runs once round counter-clockwise, so its winding number is 1 inside and 0 outside. Where every
/// directed edge of the pieces is an edge of a ring, once, or meets its own reverse in another piece, the pieces'
/// boundaries add up to the rings'; so do the winding numbers, and the rings' is 1 inside and 0 outside as well.
///
/// False for a true partition whose pieces meet in T-junctions (a vertex of one inside an edge of the next).
bool is_convex_partition(const std::vector<Ring>& rings, const std::vector<ConvexPolygon>& pieces) {
  std::vector<Run> boundary;
  for (const Ring& ring : rings) add_runs(ring, -1, boundary);
  for (const ConvexPolygon& piece : pieces) {
    if (!is_convex_ccw(piece.vertices)) return false;
    add_runs(piece.vertices, 1, boundary);
  }
  return cancel_out(boundary);
}

}  // namespace
}  // namespace exactvo::geometry::detail

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Partition_traits_2<Kernel>;
using Pieces = std::list<Traits::Polygon_2>;

constexpr Names<PartitionMethod, 5> kMethods{{{PartitionMethod::automatic, "automatic"},
                                              {PartitionMethod::greene, "greene"},
                                              {PartitionMethod::approximate, "approximate"},
                                              {PartitionMethod::optimal, "optimal"},
                                              {PartitionMethod::triangles, "triangles"}}};

/// Up to here the optimal partition takes under 2 ms; it grows with the fourth power of the size.
constexpr std::size_t kMostForOptimal = 32;

Pieces partition_by_cgal(const std::vector<Kernel::Point_2>& points, PartitionMethod method) {
  Pieces pieces;
  const Traits traits;
  const auto first = points.begin();
  const auto last = points.end();
  switch (method) {
    case PartitionMethod::optimal:
      CGAL::optimal_convex_partition_2(first, last, std::back_inserter(pieces), traits);
      break;
    case PartitionMethod::approximate:
      CGAL::approx_convex_partition_2(first, last, std::back_inserter(pieces), traits);
      break;
    case PartitionMethod::greene:
      CGAL::greene_approx_convex_partition_2(first, last, std::back_inserter(pieces), traits);
      break;
    case PartitionMethod::triangles:
    case PartitionMethod::automatic:
      EXACTVO_REQUIRE(false, std::string("a method that is not CGAL's"));
  }
  return pieces;
}

ConvexPolygon piece_from_cgal(const Traits::Polygon_2& piece) {
  ConvexPolygon out;
  for (auto v = piece.vertices_begin(); v != piece.vertices_end(); ++v) out.vertices.push_back({v->x(), v->y()});
  return out;
}

std::vector<ConvexPolygon> pieces_by_cgal(const Ring& ring, PartitionMethod method) {
  std::vector<Kernel::Point_2> points;
  points.reserve(ring.size());
  for (const Vec2 p : ring) points.emplace_back(p.x, p.y);
  std::vector<ConvexPolygon> out;
  for (const Traits::Polygon_2& piece : partition_by_cgal(points, method)) out.push_back(piece_from_cgal(piece));
  return out;
}

/// CGAL's answer if it gives one and the answer is proved. Its partitions assert on some simple rings (Greene's on the
/// outline of Africa), and what asserts is undefined where assertions are compiled out: hence CGAL_DEBUG for this file.
std::optional<std::vector<ConvexPolygon>> proved_pieces_by_cgal(const Ring& ring, PartitionMethod method) {
  try {
    std::vector<ConvexPolygon> pieces = pieces_by_cgal(ring, method);
    if (detail::is_convex_partition({ring}, pieces)) return pieces;
  } catch (const CGAL::Failure_exception&) {
    // The triangles answer instead.
  }
  return std::nullopt;
}

PartitionMethod chosen(PartitionMethod method, std::size_t size) {
  if (method != PartitionMethod::automatic) return method;
  return size <= kMostForOptimal ? PartitionMethod::optimal : PartitionMethod::triangles;
}

/// Whether a simple ring is convex and has no vertex in the middle of a side. Then it is its own optimal partition, as
/// CGAL lists it too.
bool turns_left_everywhere(const Ring& ring) {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i)
    if (orientation(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]) != Sign::positive) return false;
  return true;
}

std::vector<ConvexPolygon> proved_triangles(const std::vector<Ring>& rings) {
  std::vector<ConvexPolygon> pieces = detail::merged_triangles(rings);
  EXACTVO_REQUIRE(detail::is_convex_partition(rings, pieces), excerpt(rings.front()));
  return pieces;
}

std::vector<ConvexPolygon> proved_pieces(const Ring& ring, PartitionMethod method) {
  if (method != PartitionMethod::triangles) {
    if (auto pieces = proved_pieces_by_cgal(ring, method)) return *std::move(pieces);
  }
  return proved_triangles({ring});
}

/// The rings of a polygon, each with a vertex wherever another one touches it inside an edge.
std::vector<Ring> rings_split_where_they_touch(const Polygon& polygon) {
  std::vector<Ring> rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  std::vector<detail::Chain> chains;
  for (const Ring& ring : rings) chains.push_back({&ring});
  using Split = std::pair<detail::EdgeId, Vec2>;
  std::vector<Split> splits;
  for (const detail::Contact& contact : detail::all_contacts_between(chains)) {
    for (const detail::EdgeId id : {contact.first, contact.second}) {
      const Segment edge = chains[id.chain].edge(id.edge);
      if (contact.where != edge.a && contact.where != edge.b) splits.emplace_back(id, contact.where);
    }
  }
  // From the last edge on, and on each edge from its end on, so that places before stay where they are.
  const auto comes_first = [&](const Split& s, const Split& t) {
    if (s.first.chain != t.first.chain) return s.first.chain < t.first.chain;
    if (s.first.edge != t.first.edge) return s.first.edge > t.first.edge;
    const Vec2 from = chains[s.first.chain].edge(s.first.edge).a;
    const bool ascending = detail::lexicographically_less(from, s.second);
    return ascending ? detail::lexicographically_less(t.second, s.second)
                     : detail::lexicographically_less(s.second, t.second);
  };
  std::sort(splits.begin(), splits.end(), comes_first);
  std::vector<Ring> split = rings;
  for (const auto& [id, where] : splits) {
    Ring& ring = split[id.chain];
    const auto at = ring.begin() + static_cast<std::ptrdiff_t>(id.edge) + 1;
    if (at == ring.end() || *at != where) ring.insert(at, where);
  }
  return split;
}

}  // namespace

const char* name(PartitionMethod method) {
  return name_in(kMethods, method);
}

bool parse(const std::string& text, PartitionMethod& out) {
  return parse_in(kMethods, text, out);
}

std::vector<std::string> partition_method_names() {
  return words_in(kMethods);
}

std::vector<ConvexPolygon> convex_pieces(const Ring& ring, PartitionMethod method) {
  EXACTVO_REQUIRE(std::all_of(ring.begin(), ring.end(), is_finite), excerpt(ring));
  EXACTVO_REQUIRE(is_simple(ring) && winding(ring) == Sign::positive, excerpt(ring));
  if (method == PartitionMethod::automatic && ring.size() <= kMostForOptimal && turns_left_everywhere(ring))
    return {ConvexPolygon{ring}};
  return detail::without_cgal_failures(
      "convex_pieces", [&] { return excerpt(ring); }, [&] { return proved_pieces(ring, chosen(method, ring.size())); });
}

std::vector<ConvexPolygon> convex_pieces(const Polygon& polygon, PartitionMethod method) {
  if (polygon.holes.empty()) return convex_pieces(polygon.outer, method);
  return detail::without_cgal_failures(
      "convex_pieces", [&] { return excerpt(polygon.outer); },
      [&] { return proved_triangles(rings_split_where_they_touch(polygon)); });
}

}  // namespace exactvo::geometry
