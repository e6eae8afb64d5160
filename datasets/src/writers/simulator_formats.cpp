// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles as simulators of crowds and traffic and a triangulator's tests hold them: outlines, mostly without holes.
#include <algorithm>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/markup.h"
#include "exactvo/geometry/counted.h"
#include "json/json_text.h"
#include "obstacles/courses.h"
#include "scenarios/scenario_json.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

/// The file `bytes`, of a format that has outlines only, with what that loses. Where holes are lost, what was free in
/// them counts as solid.
Written outlines(std::string bytes, const Obstacles& obstacles, const WriteOptions& options, const char* format) {
  Written written{std::move(bytes), {}};
  std::size_t holes = 0;
  for (const formation::SceneObstacle& obstacle : obstacles)
    if (const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape)) holes += polygon->holes.size();
  if (holes > 0)
    written.losses.push_back(geometry::counted(holes, "hole") + " filled: " + format +
                             " has outlines only; nothing that was solid is lost");
  add_losses(options, format, written.losses);
  return written;
}

const std::vector<geometry::Vec2>& outline_of(const geometry::Obstacle& shape) {
  if (const auto* polygon = std::get_if<geometry::Polygon>(&shape)) return polygon->outer;
  return std::get<geometry::Polyline>(shape).points;
}

}  // namespace

Written to_rings_json(const Obstacles& obstacles, const WriteOptions& options, const std::string& file) {
  const auto* polygon = obstacles.size() == 1 ? std::get_if<geometry::Polygon>(&obstacles.front().shape) : nullptr;
  if (polygon == nullptr) {
    throw DataError(DataCode::wrong_count, file, "", geometry::counted(obstacles.size(), "obstacle"),
                    "one polygon: rings-json holds no more, and no walls");
  }
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_array();
  append_points(json, polygon->outer);
  for (const geometry::Ring& hole : polygon->holes) append_points(json, hole);
  Written written{json.end_array().take() + "\n", {}};
  add_losses(options, "rings-json", written.losses);
  written.losses.emplace_back("the id: rings-json has no place for it");
  return written;
}

Written to_menge_xml(const Obstacles& obstacles, const WriteOptions& options, const std::string&) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<Experiment version=\"2.0\">\n"
      "  <ObstacleSet type=\"explicit\" class=\"1\">\n";
  for (const formation::SceneObstacle& obstacle : obstacles) {
    text += std::string("    <Obstacle closed=\"") + (geometry::has_interior(obstacle.shape) ? "1" : "0") + "\">\n";
    for (const geometry::Vec2 p : outline_of(obstacle.shape))
      text += "      <Vertex p_x=\"" + number_text(p.x) + "\" p_y=\"" + number_text(p.y) + "\"/>\n";
    text += "    </Obstacle>\n";
  }
  Written written = outlines(text + "  </ObstacleSet>\n</Experiment>\n", obstacles, options, "Menge");
  written.losses.emplace_back("ids: Menge has no place for them");
  return written;
}

Written to_sumo_poly(const Obstacles& obstacles, const WriteOptions& options, const std::string&) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<additional>\n";
  for (const formation::SceneObstacle& obstacle : obstacles) {
    const bool is_solid = geometry::has_interior(obstacle.shape);
    const std::vector<geometry::Vec2>& points = outline_of(obstacle.shape);
    text += "  <poly id=\"" + escaped_markup(obstacle.id) + "\" type=\"obstacle\" color=\"128,128,128\" fill=\"" +
            (is_solid ? "1" : "0") + "\" layer=\"0\" shape=\"";
    for (const geometry::Vec2 p : is_solid ? closed(points) : points)
      text += (text.back() == '"' ? "" : " ") + number_text(p.x) + "," + number_text(p.y);
    text += "\"/>\n";
  }
  Written written = outlines(text + "</additional>\n", obstacles, options, "SUMO");
  const auto closed_walls = std::count_if(obstacles.begin(), obstacles.end(), [](const auto& obstacle) {
    const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape);
    return wall != nullptr && wall->points.size() > 2 && wall->points.front() == wall->points.back();
  });
  if (closed_walls > 0) {
    written.losses.push_back(geometry::counted(static_cast<std::size_t>(closed_walls), "closed wall") +
                             " made solid: in SUMO a closed outline is a polygon");
  }
  return written;
}

}  // namespace exactvo::datasets
