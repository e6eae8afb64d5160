// SPDX-License-Identifier: GPL-3.0-or-later
#include "rings/snap_rounding.h"

#include <gmpxx.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

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

}  // namespace

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

}  // namespace exactvo::geometry::detail
