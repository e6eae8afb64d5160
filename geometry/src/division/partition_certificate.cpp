// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/partition_certificate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "rings/convexity.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

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

}  // namespace

bool is_convex_partition(const std::vector<Ring>& rings, const std::vector<ConvexPolygon>& pieces) {
  std::vector<Run> boundary;
  for (const Ring& ring : rings) add_runs(ring, -1, boundary);
  for (const ConvexPolygon& piece : pieces) {
    if (!is_convex_ccw(piece.vertices)) return false;
    add_runs(piece.vertices, 1, boundary);
  }
  return cancel_out(boundary);
}

}  // namespace exactvo::geometry::detail
