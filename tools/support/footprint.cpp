// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/footprint.h"

#include <filesystem>
#include <system_error>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/counted.h"
#include "support/usage.h"

namespace exactvo::tools {

geometry::Obstacle footprint_shape(const std::string& text) {
  std::error_code error;
  const bool is_file = std::filesystem::exists(text, error);
  const datasets::ObstacleFile content =
      is_file ? datasets::read_obstacles(text) : datasets::parse_wkt(text, "--footprint");
  if (content.obstacles.size() != 1)
    throw UsageError("--footprint", geometry::counted(content.obstacles.size(), "shape"),
                     "one polygon without holes, or one line that --radius makes wide");
  return content.obstacles.front().shape;
}

geometry::RigidBody footprint_body(const geometry::Obstacle& shape, double radius) {
  if (const auto* line = std::get_if<geometry::Polyline>(&shape)) {
    if (radius == 0.0) throw lacking("--footprint with a line", "--radius", "half its width");
    geometry::RigidBody body;
    for (std::size_t k = 1; k < line->points.size(); ++k)
      body.push_back({{line->points[k - 1], line->points[k]}, radius});
    return body;
  }
  const auto& polygon = std::get<geometry::Polygon>(shape);
  if (!polygon.holes.empty())
    throw UsageError("--footprint", geometry::counted(polygon.holes.size(), "hole"), "a polygon without holes");
  geometry::RigidBody body = geometry::polygon_body(polygon);
  for (geometry::RoundedPolygon& part : body) part.radius = radius;
  return body;
}

}  // namespace exactvo::tools
