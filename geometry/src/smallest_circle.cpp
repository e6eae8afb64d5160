// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Min_sphere_of_points_d_traits_2.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>

#include "cgal_guard.h"
#include "ellipse_solver.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Traits = CGAL::Min_sphere_of_points_d_traits_2<Kernel, double>;
using MinCircle = CGAL::Min_sphere_of_spheres_d<Traits>;

double reach(Vec2 center, const std::vector<Vec2>& points) {
  double farthest = 0.0;
  for (const Vec2 p : points) farthest = std::max(farthest, std::hypot(p.x - center.x, p.y - center.y));
  return farthest;
}

// Seen from one of the points and scaled to unit size, so that squares neither overflow nor drown in an offset.
Vec2 center_of_smallest_circle(const std::vector<Vec2>& points) {
  const Vec2 origin = points.front();
  const double scale = reach(origin, points);
  std::vector<Kernel::Point_2> input;
  input.reserve(points.size());
  for (const Vec2 p : points) input.emplace_back((p.x - origin.x) / scale, (p.y - origin.y) / scale);
  MinCircle circle(input.begin(), input.end());
  const auto center = circle.center_cartesian_begin();
  return {origin.x + scale * center[0], origin.y + scale * center[1]};
}

bool contains_all(const Disc& disc, const std::vector<Vec2>& points) {
  const GrownShape shape = {disc, {}, 0.0};
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) { return locate(shape, p) != Place::outside; });
}

// hypot and the subtraction are off by 3 u; 4 u grows past that in one step almost always.
Disc certified_circle(Vec2 center, const std::vector<Vec2>& points) {
  double radius = reach(center, points);
  for (double growth = 4.0 * kUnitRoundoff;; growth *= 2.0) {
    if (contains_all({center, radius}, points)) return {center, radius};
    radius *= 1.0 + growth;
  }
}

}  // namespace

Disc smallest_circle(const std::vector<Vec2>& points) {
  detail::require_places(points);
  const bool one = std::all_of(points.begin(), points.end(), [&](Vec2 p) { return p == points.front(); });
  if (one) return {points.front(), 0.0};
  return detail::without_cgal_failures(
      "smallest_circle", [&] { return to_string(points); },
      [&] { return certified_circle(center_of_smallest_circle(points), points); });
}

}  // namespace exactvo::geometry
