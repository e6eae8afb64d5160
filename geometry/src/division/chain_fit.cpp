// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/chain_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/support.h"

namespace exactvo::geometry::detail {

double largest_coordinate(const std::vector<Vec2>& points) {
  double largest = 0.0;
  for (const Vec2 p : points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

// distance(s, x) measures to a computed foot point. That is within 10 u M of the segment: u sqrt(2) M for rounding the
// sum, 3 u |b - a| <= 6 sqrt(2) u M for the product and the difference; 16 leaves room for the second order. The
// difference and the hypot add a relative 4 u; 8 is used.
double distance_upper_bound(const Segment& s, Vec2 x, double largest) {
  return distance(s, x) * (1.0 + 8.0 * kUnitRoundoff) + 16.0 * kUnitRoundoff * largest;
}

double refine_gap(const std::vector<Vec2>& points, std::vector<bool>& kept, std::size_t i, std::size_t j,
                  double tolerance, double largest) {
  double deviation = 0.0;
  std::vector<std::pair<std::size_t, std::size_t>> gaps = {{i, j}};
  while (!gaps.empty()) {
    const auto [from, to] = gaps.back();
    gaps.pop_back();
    const Segment edge = {points[from], points[to < points.size() ? to : 0]};
    double most = 0.0;
    std::size_t farthest = from;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double d = distance_upper_bound(edge, points[k], largest);
      if (d > most) farthest = k;
      most = std::max(most, d);
    }
    if (most <= tolerance) {
      deviation = std::max(deviation, most);
      continue;
    }
    kept[farthest] = true;
    gaps.emplace_back(from, farthest);
    gaps.emplace_back(farthest, to);
  }
  return deviation;
}

}  // namespace exactvo::geometry::detail
