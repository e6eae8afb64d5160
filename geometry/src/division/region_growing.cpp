// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/region_growing.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cgal_guard.h"

namespace exactvo::geometry::detail {
namespace {

namespace SD = CGAL::Shape_detection;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Item = std::pair<Kernel::Point_2, Kernel::Vector_2>;  // a point and its normal
using Items = std::vector<Item>;
using PointMap = CGAL::First_of_pair_property_map<Item>;
using NormalMap = CGAL::Second_of_pair_property_map<Item>;
using Neighbours = SD::Point_set::Sphere_neighbor_query<Kernel, Items, PointMap>;
using LineRegion = SD::Point_set::Least_squares_line_fit_region<Kernel, Items, PointMap, NormalMap>;
using Growing = SD::Region_growing<Items, Neighbours, LineRegion>;
using Group = std::vector<std::size_t>;

constexpr double kDegreesOfRadian = 57.295779513082320877;

// The direction of largest spread: the eigenvector of the covariance [xx xy; xy yy].
Vec2 principal_direction(const std::vector<Vec2>& points, const Group& group) {
  const Vec2 origin = points[group.front()];  // far-away clouds keep their bits
  Vec2 mean;
  for (const std::size_t i : group) mean += (points[i] - origin) / static_cast<double>(group.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const std::size_t i : group) {
    const Vec2 d = points[i] - origin - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {std::cos(angle), std::sin(angle)};
}

// The normals of lines fitted to each point's neighbours. Positions are seen from the first point.
void set_normals(const std::vector<Vec2>& points, const Neighbours& neighbours, Items& items) {
  Group near;
  for (std::size_t i = 0; i < items.size(); ++i) {
    neighbours(i, near);
    std::sort(near.begin(), near.end());
    const Vec2 normal = perp(principal_direction(points, near));
    items[i].second = {normal.x, normal.y};
  }
}

Items items_of(const std::vector<Vec2>& points) {
  Items items;
  items.reserve(points.size());
  for (const Vec2 p : points) {
    const Vec2 seen = p - points.front();
    items.emplace_back(Kernel::Point_2(seen.x, seen.y), Kernel::Vector_2(0, 1));
  }
  return items;
}

void sort_along_line(const std::vector<Vec2>& points, Group& group) {
  std::sort(group.begin(), group.end());
  const Vec2 direction = principal_direction(points, group);
  const Vec2 origin = points[group.front()];
  std::stable_sort(group.begin(), group.end(), [&](std::size_t i, std::size_t j) {
    return dot(points[i] - origin, direction) < dot(points[j] - origin, direction);
  });
}

}  // namespace

std::vector<Group> points_along_lines(const std::vector<Vec2>& points, const PointOptions& options) {
  return without_cgal_failures(
      "points_along_lines", [&] { return excerpt(points); },
      [&] {
        Items items = items_of(points);
        Neighbours neighbours(items, options.neighbour_radius);
        set_normals(points, neighbours, items);
        const double degrees = std::min(90.0, options.normal_angle * kDegreesOfRadian);
        LineRegion region(items, options.tolerance, degrees, options.least_points);
        Growing growing(items, neighbours, region);
        std::vector<Group> groups;
        growing.detect(std::back_inserter(groups));
        for (Group& group : groups) sort_along_line(points, group);
        return groups;
      });
}

}  // namespace exactvo::geometry::detail
