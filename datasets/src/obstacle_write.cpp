// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/obstacle_write.h"

#include "exactvo/datasets/atomic_file.h"
#include "json_text.h"
#include "scenario_json.h"

namespace exactvo::datasets {
namespace {

geometry::Ring closed(geometry::Ring ring) {
  if (!ring.empty()) ring.push_back(ring.front());
  return ring;
}

std::vector<geometry::Ring> rings_of(const geometry::Polygon& polygon) {
  std::vector<geometry::Ring> rings{closed(polygon.outer)};
  for (const geometry::Ring& hole : polygon.holes) rings.push_back(closed(hole));
  return rings;
}

std::string wkt_points(const std::vector<geometry::Vec2>& points) {
  std::string text = "(";
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) text += ", ";
    append_number(text, points[i].x);
    text += ' ';
    append_number(text, points[i].y);
  }
  return text + ")";
}

std::string wkt_of(const geometry::Polyline& line) {
  return "LINESTRING " + wkt_points(line.points);
}

std::string wkt_of(const geometry::Polygon& polygon) {
  std::string text = "POLYGON (";
  const std::vector<geometry::Ring> rings = rings_of(polygon);
  for (std::size_t k = 0; k < rings.size(); ++k) text += (k > 0 ? ", " : "") + wkt_points(rings[k]);
  return text + ")";
}

void append_geometry(JsonWriter& json, const geometry::Polyline& line) {
  json.member("type", "LineString").key("coordinates");
  append_points(json, line.points);
}

void append_geometry(JsonWriter& json, const geometry::Polygon& polygon) {
  json.member("type", "Polygon").key("coordinates").begin_array();
  for (const geometry::Ring& ring : rings_of(polygon)) append_points(json, ring);
  json.end_array();
}

void append_feature(JsonWriter& json, const formation::SceneObstacle& obstacle) {
  json.begin_inline_object().member("type", "Feature");
  json.key("properties").begin_object().member("id", obstacle.id).end_object();
  json.key("geometry").begin_object();
  std::visit([&](const auto& shape) { append_geometry(json, shape); }, obstacle.shape);
  json.end_object().end_object();
}

}  // namespace

std::string to_wkt(const std::vector<formation::SceneObstacle>& obstacles) {
  std::string text;
  for (const formation::SceneObstacle& obstacle : obstacles) {
    text += std::visit([](const auto& shape) { return wkt_of(shape); }, obstacle.shape) + "\n";
  }
  return text;
}

std::string to_geojson(const std::vector<formation::SceneObstacle>& obstacles) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object().member("type", "FeatureCollection").member("units", "m");
  json.key("features").begin_array();
  for (const formation::SceneObstacle& obstacle : obstacles) append_feature(json, obstacle);
  json.end_array();
  return json.end_object().take() + "\n";
}

void write_obstacles(const std::filesystem::path& path, const std::vector<formation::SceneObstacle>& obstacles) {
  const std::string extension = path.extension().string();
  if (extension == ".wkt") return write_file_atomically(path, to_wkt(obstacles));
  if (extension == ".geojson" || extension == ".json") return write_file_atomically(path, to_geojson(obstacles));
  throw DataError(DataCode::format_unknown, path.string(), "", "the extension \"" + extension + "\"",
                  ".wkt, .geojson or .json");
}

}  // namespace exactvo::datasets
