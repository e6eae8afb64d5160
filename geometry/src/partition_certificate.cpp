// SPDX-License-Identifier: GPL-3.0-or-later
#include "partition_certificate.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "convexity.h"
#include "ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

struct LessByEnds {
  bool operator()(const Segment& s, const Segment& t) const {
    if (s.a != t.a) return lexicographically_less(s.a, t.a);
    return lexicographically_less(s.b, t.b);
  }
};

/// How often each edge is run along, less how often against; edges are named by their lesser end first.
class Boundary {
 public:
  void add(const std::vector<Vec2>& ring, int times) {
    for (std::size_t i = 0; i < ring.size(); ++i) add(ring[i], ring[(i + 1) % ring.size()], times);
  }

  bool is_empty() const {
    return std::all_of(count_.begin(), count_.end(), [](const auto& edge) { return edge.second == 0; });
  }

 private:
  void add(Vec2 a, Vec2 b, int times) {
    if (lexicographically_less(a, b)) {
      count_[{a, b}] += times;
    } else {
      count_[{b, a}] -= times;
    }
  }

  std::map<Segment, int, LessByEnds> count_;
};

}  // namespace

bool is_convex_partition(const std::vector<Ring>& rings, const std::vector<ConvexPolygon>& pieces) {
  Boundary boundary;
  for (const Ring& ring : rings) boundary.add(ring, -1);
  for (const ConvexPolygon& piece : pieces) {
    if (!runs_once_round_to_the_left(piece.vertices)) return false;
    boundary.add(piece.vertices, 1);
  }
  return boundary.is_empty();
}

}  // namespace exactvo::geometry::detail
