// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles as simulators of crowds and traffic and a triangulator's tests hold them: outlines, mostly without holes.
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/markup.h"
#include "exactvo/geometry/counted.h"
#include "json/json_text.h"
#include "scenarios/scenario_json.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

std::size_t count_holes(const Obstacles& obstacles) {
  std::size_t holes = 0;
  for (const formation::SceneObstacle& obstacle : obstacles) {
    if (const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape)) holes += polygon->holes.size();
  }
  return holes;
}

/// Where holes are lost, what was free in them counts as solid.
std::vector<std::string> hole_losses(const Obstacles& obstacles, const char* format) {
  const std::size_t holes = count_holes(obstacles);
  if (holes == 0) return {};
  return {std::to_string(holes) + (holes == 1 ? " hole" : " holes") + " filled: " + format +
          " has outlines only; nothing that was solid is lost"};
}

const std::vector<geometry::Vec2>& outline_of(const geometry::Obstacle& shape) {
  if (const auto* polygon = std::get_if<geometry::Polygon>(&shape)) return polygon->outer;
  return std::get<geometry::Polyline>(shape).points;
}

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
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
  Written written{json.end_array().take() + "\n", losses_beside_shapes(options, "rings-json")};
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
  Written written{text + "  </ObstacleSet>\n</Experiment>\n", hole_losses(obstacles, "Menge")};
  append(written.losses, losses_beside_shapes(options, "Menge"));
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
  Written written{text + "</additional>\n", hole_losses(obstacles, "SUMO")};
  append(written.losses, losses_beside_shapes(options, "SUMO"));
  return written;
}

}  // namespace exactvo::datasets
