// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/pieces.h"

#include "exactvo/geometry/facades.h"
#include "exactvo/geometry/hull.h"

namespace exactvo::geometry {

bool is_convex(const Obstacle& obstacle) {
  if (const auto* polygon = std::get_if<Polygon>(&obstacle))
    return polygon->holes.empty() && is_valid(ConvexPolygon{polygon->outer});
  return convex_hull(vertices_of(obstacle)).vertices.size() <= 2;
}

ConvexShape hull_shape(const std::vector<Vec2>& points) {
  ConvexPolygon hull = convex_hull(points);
  if (hull.vertices.size() > 2) return hull;
  return Segment{hull.vertices.front(), hull.vertices.back()};
}

std::vector<ConvexShape> convex_cover(const Obstacle& obstacle) {
  if (is_convex(obstacle)) return {hull_shape(vertices_of(obstacle))};
  std::vector<ConvexShape> shapes;
  if (const auto* polygon = std::get_if<Polygon>(&obstacle)) {
    for (ConvexPolygon& piece : convex_pieces(*polygon)) shapes.emplace_back(std::move(piece));
  } else {
    for (const Segment& edge : divide_into_facades(obstacle).facades) shapes.emplace_back(edge);
  }
  return shapes;
}

}  // namespace exactvo::geometry
