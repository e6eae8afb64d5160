// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/route/map.h"

#include <fmt/format.h>

#include <filesystem>

#include "support/projection.h"
#include "support/robot_numbers.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

using geometry::Vec2;

namespace {

/// What concerns the file as a whole, such as moving obstacles that are left out.
void say_notes(const datasets::ObstacleFile& content) {
  say_projection(content);
  for (const datasets::DataNote& note : content.notes)
    if (!note.code && note.place.empty() && !content.origin) message(content.file + ": " + note.text);
  if (content.obstacles.empty()) message(content.file + ": no obstacle in it");
}

CellPlaces cells_of(const std::string& file, const datasets::ReadOptions& reading, const std::string& cell_point) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw UsageError("map", file, "a regular file: the size of a Moving AI map is read from it once more");
  const double side = reading.cell_size > 0.0 ? reading.cell_size : 1.0;
  return {datasets::read_map_size(file), side, cell_point == kCellPoints[0] ? 0.5 : 0.0};
}

formation::SceneObstacle border_of(const CellPlaces& cells) {
  const double x = static_cast<double>(cells.size.columns) * cells.side;
  const double y = static_cast<double>(cells.size.rows) * cells.side;
  return {"the border of the map", geometry::Polyline{{{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}, {0.0, 0.0}}}};
}

bool is_a_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789-") == std::string::npos;
}

}  // namespace

std::optional<Vec2> AskedMap::in_metres(Vec2 given) const {
  if (!is_in_range(given)) return std::nullopt;
  if (!cells) return given;
  const double rows = static_cast<double>(cells->size.rows), columns = static_cast<double>(cells->size.columns);
  const double x = given.x + cells->offset, y = rows - (given.y + cells->offset);
  if (!(x >= 0.0 && x <= columns && y >= 0.0 && y <= rows)) return std::nullopt;
  return Vec2{x * cells->side, y * cells->side};
}

std::string AskedMap::accepted_points() const {
  if (!cells) return "two numbers within 2^100, X,Y in m";
  return fmt::format("a cell of the map, which has {} columns and {} rows: X,Y, the first 0,0", cells->size.columns,
                     cells->size.rows);
}

std::string AskedMap::name_of(std::size_t obstacle) const {
  const formation::SceneObstacle& o = obstacles[obstacle];
  if (!is_a_number(o.id)) return o.id;
  return (geometry::has_interior(o.shape) ? "polygon " : "wall ") + o.id;
}

AskedMap read_asked_map(const std::string& file, const datasets::ReadOptions& reading, const std::string& cell_point) {
  datasets::ObstacleFile content = datasets::read_obstacles(file, reading);
  say_notes(content);
  AskedMap map{file, content.format, std::move(content.obstacles), {}, std::nullopt};
  if (map.format == "movingai-map") {
    map.cells = cells_of(file, reading, cell_point);
    map.obstacles.push_back(border_of(*map.cells));
  }
  for (const formation::SceneObstacle& o : map.obstacles) map.shapes.push_back(o.shape);
  return map;
}

}  // namespace exactvo::tools
