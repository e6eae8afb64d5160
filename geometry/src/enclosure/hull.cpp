// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>

#include <algorithm>
#include <iterator>

#include "cgal_guard.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;

std::vector<Point> to_cgal(const std::vector<Vec2>& points) {
  std::vector<Point> out;
  out.reserve(points.size());
  for (const Vec2 p : points) out.emplace_back(p.x, p.y);
  return out;
}

}  // namespace

ConvexPolygon convex_hull(const std::vector<Vec2>& points) {
  EXACTVO_REQUIRE(!points.empty(), std::string("no point"));
  EXACTVO_REQUIRE(std::all_of(points.begin(), points.end(), is_finite), excerpt(points));
  return detail::without_cgal_failures(
      "convex_hull", [&] { return excerpt(points); },
      [&] {
        const std::vector<Point> input = to_cgal(points);
        std::vector<Point> hull;
        CGAL::convex_hull_2(input.begin(), input.end(), std::back_inserter(hull));
        ConvexPolygon out;
        for (const Point& p : hull) out.vertices.push_back({p.x(), p.y()});
        return out;
      });
}

}  // namespace exactvo::geometry
