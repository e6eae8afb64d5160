// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Partition_traits_2.h>
#include <CGAL/partition_2.h>

#include <algorithm>
#include <iterator>
#include <list>

#include "cgal_guard.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Partition_traits_2<Kernel>;
using Pieces = std::list<Traits::Polygon_2>;

/// Up to here the optimal partition takes under 2 ms; it grows with the fourth power of the size.
constexpr std::size_t kMostForOptimal = 32;

PartitionMethod chosen(PartitionMethod method, std::size_t size) {
  if (method != PartitionMethod::automatic) return method;
  return size <= kMostForOptimal ? PartitionMethod::optimal : PartitionMethod::greene;
}

Pieces partition(const std::vector<Kernel::Point_2>& points, PartitionMethod method) {
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
    case PartitionMethod::automatic:
      CGAL::greene_approx_convex_partition_2(first, last, std::back_inserter(pieces), traits);
      break;
  }
  return pieces;
}

ConvexPolygon from_cgal(const Traits::Polygon_2& piece) {
  ConvexPolygon out;
  for (auto v = piece.vertices_begin(); v != piece.vertices_end(); ++v) out.vertices.push_back({v->x(), v->y()});
  return out;
}

std::vector<ConvexPolygon> pieces_of(const Ring& ring, PartitionMethod method) {
  std::vector<Kernel::Point_2> points;
  points.reserve(ring.size());
  for (const Vec2 p : ring) points.emplace_back(p.x, p.y);
  std::vector<ConvexPolygon> out;
  for (const Traits::Polygon_2& piece : partition(points, method)) out.push_back(from_cgal(piece));
  return out;
}

}  // namespace

std::vector<ConvexPolygon> convex_pieces(const Ring& ring, PartitionMethod method) {
  EXACTVO_REQUIRE(std::all_of(ring.begin(), ring.end(), is_finite), to_string(ring));
  EXACTVO_REQUIRE(is_simple(ring) && winding(ring) == Sign::positive, to_string(ring));
  return detail::without_cgal_failures(
      "convex_pieces", [&] { return to_string(ring); }, [&] { return pieces_of(ring, chosen(method, ring.size())); });
}

}  // namespace exactvo::geometry
