// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/partition_certificate.h"

#include <algorithm>
#include <cstddef>

#include "rings/convexity.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

/// An edge, its lesser end first, and how often it is run along less how often against.
struct Run {
  Segment edge;
  int times = 0;
};

bool same_edge(const Run& s, const Run& t) {
  return s.edge.a == t.edge.a && s.edge.b == t.edge.b;
}

bool lexicographically_less(const Run& s, const Run& t) {
  if (s.edge.a != t.edge.a) return detail::lexicographically_less(s.edge.a, t.edge.a);
  return detail::lexicographically_less(s.edge.b, t.edge.b);
}

class Boundary {
 public:
  void add(const std::vector<Vec2>& ring, int times) {
    for (std::size_t i = 0; i < ring.size(); ++i) add(ring[i], ring[(i + 1) % ring.size()], times);
  }

  /// Whether every edge is run along as often as against.
  bool is_empty() {
    std::sort(runs_.begin(), runs_.end(), lexicographically_less);
    for (std::size_t i = 0; i < runs_.size();) {
      int sum = 0;
      const Run& first = runs_[i];
      for (; i < runs_.size() && same_edge(first, runs_[i]); ++i) sum += runs_[i].times;
      if (sum != 0) return false;
    }
    return true;
  }

 private:
  void add(Vec2 a, Vec2 b, int times) {
    runs_.push_back(detail::lexicographically_less(a, b) ? Run{{a, b}, times} : Run{{b, a}, -times});
  }

  std::vector<Run> runs_;
};

}  // namespace

bool is_convex_partition(const std::vector<Ring>& rings, const std::vector<ConvexPolygon>& pieces) {
  Boundary boundary;
  for (const Ring& ring : rings) boundary.add(ring, -1);
  for (const ConvexPolygon& piece : pieces) {
    if (!is_convex_ccw(piece.vertices)) return false;
    boundary.add(piece.vertices, 1);
  }
  return boundary.is_empty();
}

}  // namespace exactvo::geometry::detail
