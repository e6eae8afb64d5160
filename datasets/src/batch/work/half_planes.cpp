// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/half_planes.h"

#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::datasets::batch {
namespace {

using geometry::ConvexShape;
using geometry::Vec2;

/// Whether there is one.
bool append_half_plane(JsonWriter& json, const ConvexShape& shape, Vec2 position, const BatchRobot& robot) {
  const geometry::GrownShape grown{shape, position, robot.radius};
  const auto half_plane = vo::half_plane(grown, robot.time_horizon, robot.velocity);
  if (!half_plane) {
    json.null();
    return false;
  }
  json.begin_object().member("normal", half_plane->normal).member("offset", half_plane->offset);
  json.member("certified", half_plane_is_safe(grown, robot.time_horizon, *half_plane)).end_object();
  return true;
}

bool overlaps(const ConvexShape& shape, Vec2 position, double radius) {
  return geometry::locate({shape, position, radius}, {0.0, 0.0}) != geometry::Place::outside;
}

ConvexShape hull_shape(const geometry::ConvexPolygon& hull) {
  if (hull.vertices.size() > 2) return hull;
  return geometry::Segment{hull.vertices.front(), hull.vertices.back()};
}

std::uint64_t append_position(JsonWriter& json, const geometry::ObstacleShapes& shapes, Vec2 position,
                              const BatchRobot& robot) {
  const ConvexShape hull = hull_shape(shapes.hull);
  const bool within_hull = overlaps(hull, position, robot.radius);
  json.begin_object().member("position", position).member("of", within_hull ? "pieces" : "hull");
  json.key("half_planes").begin_array();
  std::uint64_t missing = 0;
  if (!within_hull) {
    missing += append_half_plane(json, hull, position, robot) ? 0 : 1;
  } else {
    for (const ConvexShape& piece : shapes.pieces) missing += append_half_plane(json, piece, position, robot) ? 0 : 1;
  }
  json.end_array().end_object();
  return missing;
}

}  // namespace

std::uint64_t append_half_planes(JsonWriter& json, const geometry::ObstacleShapes& shapes, const BatchRobot& robot) {
  json.key("half_planes").begin_array();
  std::uint64_t missing = 0;
  for (const Vec2 position : robot.positions) missing += append_position(json, shapes, position, robot);
  json.end_array();
  return missing;
}

}  // namespace exactvo::datasets::batch
