// SPDX-License-Identifier: GPL-3.0-or-later
#include "rings/convexity.h"

#include <algorithm>
#include <cstddef>

#include "exactvo/geometry/predicates.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

// The lexicographic order splits directions in two open halves and no edge is without one; on a straight run the next
// edge goes on in the same half, on a spike it comes back in the other.
bool turns_right_or_back(Vec2 before, Vec2 at, Vec2 after) {
  const Sign turn = orientation(before, at, after);
  const bool goes_on = lexicographically_less(before, at) == lexicographically_less(at, after);
  return turn == Sign::negative || (turn == Sign::zero && !goes_on);
}

// A ring that only turns left and goes k times round changes k times from rightward to leftward and k times back.
std::size_t changes_of_half(const std::vector<Vec2>& ring) {
  const std::size_t n = ring.size();
  std::size_t changes = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = ring[i], b = ring[(i + 1) % n], c = ring[(i + 2) % n];
    changes += lexicographically_less(a, b) != lexicographically_less(b, c) ? 1 : 0;
  }
  return changes;
}

}  // namespace

bool is_convex_ccw(const std::vector<Vec2>& ring) {
  const std::size_t n = ring.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 at = ring[(i + 1) % n];
    if (ring[i] == at || turns_right_or_back(ring[i], at, ring[(i + 2) % n])) return false;
  }
  return changes_of_half(ring) == 2;
}

bool on_one_line(const std::vector<Vec2>& points) {
  const auto other = std::find_if(points.begin(), points.end(), [&](Vec2 p) { return p != points.front(); });
  return other == points.end() ||
         std::all_of(other, points.end(), [&](Vec2 p) { return orientation(points.front(), *other, p) == Sign::zero; });
}

}  // namespace exactvo::geometry::detail
