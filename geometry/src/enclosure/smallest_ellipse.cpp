// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest ellipse, its support points found by CGAL in exact arithmetic.
#include <CGAL/Gmpq.h>
#include <CGAL/Min_ellipse_2.h>
#include <CGAL/Min_ellipse_2_traits_2.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "cgal_guard.h"
#include "enclosure/ellipse_solver.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using Rational = CGAL::Gmpq;  // Min_ellipse_2 does not compile with a lazy exact kernel
using Kernel = CGAL::Simple_cartesian<Rational>;
using Traits = CGAL::Min_ellipse_2_traits_2<Kernel>;
using MinEllipse = CGAL::Min_ellipse_2<Traits>;

// Welzl's algorithm is quick only in random order; this one is the same on every machine (SplitMix64, Fisher-Yates).
std::vector<Vec2> shuffled(std::vector<Vec2> points) {
  std::uint64_t state = 0;
  for (std::size_t i = points.size(); i > 1; --i) {
    state += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    std::swap(points[i - 1], points[(z ^ (z >> 31)) % i]);
  }
  return points;
}

// Seen from their middle, exactly: the numerators are shorter, and CGAL's own roundings do not meet the offset.
std::vector<Kernel::Point_2> centered(const std::vector<Vec2>& points, Vec2 middle) {
  const Rational x(middle.x);
  const Rational y(middle.y);
  std::vector<Kernel::Point_2> out;
  out.reserve(points.size());
  for (const Vec2 p : points) out.emplace_back(Rational(p.x) - x, Rational(p.y) - y);
  return out;
}

// The points that determine the smallest ellipse: at most five of `points`. Exact.
std::vector<Vec2> support_of_smallest_ellipse(const std::vector<Vec2>& points) {
  const std::vector<Vec2> order = shuffled(points);
  const std::vector<Kernel::Point_2> input = centered(order, points[0]);
  const MinEllipse ellipse(input.begin(), input.end(), false);
  std::vector<Vec2> support;
  for (auto p = ellipse.support_points_begin(); p != ellipse.support_points_end(); ++p) {
    const auto at = std::find(input.begin(), input.end(), *p);
    support.push_back(order[static_cast<std::size_t>(std::distance(input.begin(), at))]);
  }
  return support;
}

}  // namespace

Ellipse smallest_ellipse(const std::vector<Vec2>& points) {
  detail::require_places(points);
  const std::vector<Vec2> hull = convex_hull(points).vertices;
  if (hull.size() == 1) return {hull[0], 0.0, 0.0, 0.0};
  if (hull.size() == 2) return detail::ellipse_of_segment(hull[0], hull[1]);
  const auto values = [&] { return excerpt(hull); };
  const std::vector<Vec2> support =
      detail::without_cgal_failures("smallest_ellipse", values, [&] { return support_of_smallest_ellipse(hull); });
  return detail::certified_ellipse(detail::solve_smallest_ellipse(support).frame, hull);
}

}  // namespace exactvo::geometry
