// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where chains of edges meet, and whether a list of vertices runs once round a convex polygon: what partitions are
/// certified by and shapes judged by. Exact: orientation tests and comparisons of coordinates only.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// A closed or open chain of distinct consecutive vertices. Edge i runs from vertex i to vertex i + 1 (cyclically).
struct Chain {
  const std::vector<Vec2>* points = nullptr;
  bool closed = true;

  std::size_t edge_count() const { return closed ? points->size() : points->size() - 1; }
  Segment edge(std::size_t i) const { return {(*points)[i], (*points)[(i + 1) % points->size()]}; }
};

/// Edge `edge` of chain number `chain`.
struct EdgeId {
  std::size_t chain = 0;
  std::size_t edge = 0;
};

/// Two edges that have a point in common which is not the vertex that they share as neighbours.
struct Contact {
  EdgeId first;
  EdgeId second;
  Vec2 where;  ///< see `common_point`
};

/// Some contact of the chains with themselves or each other, or nothing if there is none. O(n log n): a sweep after
/// Shamos and Hoey (Geometric intersection problems, 1976) in lexicographic order, so verticals need no special case.
/// REQUIRES: no two consecutive vertices equal; closed chains have at least three.
std::optional<Contact> find_contact(const std::vector<Chain>& chains);

/// Gives pairs of edges whose boxes meet, the one of the earlier chain first, in no order to rely on, until `take` says
/// that it wants no more. False then, and where there are more than `most`: the others are not given. O(n log^2 n +
/// pairs) (CGAL).
bool for_each_box_pair(const std::vector<Chain>& chains, std::size_t most,
                       const std::function<bool(EdgeId first, EdgeId second)>& take);

/// Every contact between edges of different chains, ordered. O(n log^2 n + candidates), by the edges' boxes (CGAL).
std::vector<Contact> all_contacts_between(const std::vector<Chain>& chains);

/// Whether edges of rings, neighbours in a ring left out, meet in more than `most` pairs; also true where more than
/// kMostBoxPairs pairs of boxes meet, which would take seconds to look through.
bool has_more_crossings_than(std::size_t most, const std::vector<Ring>& rings);
inline constexpr std::size_t kMostBoxPairs = std::size_t{1} << 26;

/// The place of the lexicographically least point. REQUIRES: there is one.
std::size_t least_vertex(const std::vector<Vec2>& points);

/// The largest magnitude of a coordinate; 0 without points.
double largest_coordinate(const std::vector<Vec2>& points);

/// An upper bound of the distance from x to s. `largest` bounds the magnitudes of the coordinates. Certified.
double distance_upper_bound(const Segment& s, Vec2 x, double largest);

/// A common point of two segments that meet: an end that lies on the other, else the crossing, rounded.
Vec2 common_point(const Segment& s, const Segment& t);

/// Whether x lies on the closed segment. Exact.
bool lies_on(const Segment& s, Vec2 x);

/// Whether the closed ring turns nowhere to the right, somewhere to the left, never back, and only once round:
/// then it bounds a convex polygon of positive area, counter-clockwise. Vertices on a straight run are tolerated, two
/// equal ones running are not. Exact, O(n).
bool is_convex_ccw(const std::vector<Vec2>& ring);

/// Whether all points lie on one line. Exact, O(n).
bool on_one_line(const std::vector<Vec2>& points);

/// Comparison by x, then by y.
inline bool lexicographically_less(Vec2 a, Vec2 b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

}  // namespace exactvo::geometry::detail
