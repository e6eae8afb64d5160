// SPDX-License-Identifier: GPL-3.0-or-later
#include "rings/snap_rounding.h"

#include <algorithm>
#include <optional>

#include "exact/exact_number.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

// A parameter along an edge, num / den with den > 0, and whether it is left out.
struct Bound {
  Exact num;
  Exact den;
  bool open = false;
};

int compare(const Bound& a, const Bound& b) {
  return static_cast<int>(sign_of(a.num * b.den - b.num * a.den));
}

struct Range {
  Bound low{Exact(0), Exact(1), false};
  Bound high{Exact(1), Exact(1), false};
  bool empty = false;

  void from(const Bound& b) {
    const int order = compare(b, low);
    if (order > 0 || (order == 0 && b.open)) low = b;
  }
  void to(const Bound& b) {
    const int order = compare(b, high);
    if (order < 0 || (order == 0 && b.open)) high = b;
  }
  bool holds_something() const {
    const int order = compare(low, high);
    return !empty && (order < 0 || (order == 0 && !low.open && !high.open));
  }
};

// Keeps the parameters t with low <= a + t (b - a) < high.
void clip(double a, double b, const Exact& low, const Exact& high, Range& range) {
  const Exact start(a);
  const Exact step = Exact(b) - start;
  switch (sign_of(step)) {
    case Sign::positive:
      range.from({low - start, step, false});
      range.to({high - start, step, true});
      break;
    case Sign::negative:
      range.to({start - low, -step, false});
      range.from({start - high, -step, true});
      break;
    default:
      range.empty = range.empty || sign_of(start - low) == Sign::negative || sign_of(high - start) != Sign::positive;
  }
}

// Where the edge enters the pixel, if it meets it.
std::optional<Bound> entry(const Segment& edge, Vec2 centre, double grid) {
  const Exact half(grid / 2);
  Range range;
  clip(edge.a.x, edge.b.x, Exact(centre.x) - half, Exact(centre.x) + half, range);
  clip(edge.a.y, edge.b.y, Exact(centre.y) - half, Exact(centre.y) + half, range);
  if (!range.holds_something()) return std::nullopt;
  return range.low;
}

struct Passed {
  Bound entry;
  Vec2 centre;
};

// Pixels are disjoint, so are the stretches of the edge in them.
bool is_passed_before(const Passed& a, const Passed& b) {
  const int order = compare(a.entry, b.entry);
  return order < 0 || (order == 0 && !a.entry.open && b.entry.open);
}

void append_bent(const Segment& edge, const std::vector<Vec2>& hot, double grid, Ring& ring) {
  const double left = std::min(edge.a.x, edge.b.x) - grid, right = std::max(edge.a.x, edge.b.x) + grid;
  const double low = std::min(edge.a.y, edge.b.y) - grid, high = std::max(edge.a.y, edge.b.y) + grid;
  std::vector<Passed> passed;
  const auto x_less = [](Vec2 p, double x) { return p.x < x; };
  for (auto p = std::lower_bound(hot.begin(), hot.end(), left, x_less); p != hot.end() && p->x <= right; ++p) {
    if (p->y < low || p->y > high) continue;
    if (const auto at = entry(edge, *p, grid)) passed.push_back({*at, *p});
  }
  std::sort(passed.begin(), passed.end(), is_passed_before);
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
