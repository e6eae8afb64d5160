// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/obstacle_write.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/obstacle_file.h"
#include "gdal/vector_library.h"
#include "json_text.h"
#include "scenarios/scenario_json.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

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

std::string wkt_text(const geometry::Polyline& line) {
  return "LINESTRING " + wkt_points(line.points);
}

std::string wkt_text(const geometry::Polygon& polygon) {
  std::string text = "POLYGON (";
  const std::vector<geometry::Ring> rings = closed_rings_of(polygon);
  for (std::size_t k = 0; k < rings.size(); ++k) text += (k > 0 ? ", " : "") + wkt_points(rings[k]);
  return text + ")";
}

void append_geometry(JsonWriter& json, const geometry::Polyline& line) {
  json.member("type", "LineString").key("coordinates");
  append_points(json, line.points);
}

void append_geometry(JsonWriter& json, const geometry::Polygon& polygon) {
  json.member("type", "Polygon").key("coordinates").begin_array();
  for (const geometry::Ring& ring : closed_rings_of(polygon)) append_points(json, ring);
  json.end_array();
}

void append_feature(JsonWriter& json, const formation::SceneObstacle& obstacle) {
  json.begin_inline_object().member("type", "Feature");
  json.key("properties").begin_object().member("id", obstacle.id).end_object();
  json.key("geometry").begin_object();
  std::visit([&](const auto& shape) { append_geometry(json, shape); }, obstacle.shape);
  json.end_object().end_object();
}

/// RFC 4180: quoted, quotes doubled.
std::string csv_field(const std::string& text) {
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

Written wkt(const Obstacles& obstacles, const std::string&) {
  return {to_wkt(obstacles), {"ids: WKT has no place for them"}};
}

Written geojson(const Obstacles& obstacles, const std::string&) {
  return {to_geojson(obstacles), {}};
}

Written csv(const Obstacles& obstacles, const std::string&) {
  std::string text = "id,WKT\r\n";
  for (const formation::SceneObstacle& o : obstacles)
    text += csv_field(o.id) + "," + csv_field(wkt_of(o.shape)) + "\r\n";
  return {text, {}};
}

Written geopackage(const Obstacles& obstacles, const std::string& file) {
  return {vector_library().to_gdal_file(obstacles, "GPKG", file), {}};
}

Written flatgeobuf(const Obstacles& obstacles, const std::string& file) {
  return {vector_library().to_gdal_file(obstacles, "FlatGeobuf", file), {}};
}

struct Writer {
  const char* name;
  std::vector<const char*> endings;  ///< lower case; the longest that fits is meant
  bool needs_gdal;
  Written (*write)(const Obstacles& obstacles, const std::string& file);
};

const std::vector<Writer>& writers() {
  static const std::vector<Writer> kWriters{
      {"wkt", {".wkt"}, false, wkt},          {"geojson", {".geojson", ".json"}, false, geojson},
      {"gpkg", {".gpkg"}, true, geopackage},  {"fgb", {".fgb"}, true, flatgeobuf},
      {"csv", {".csv"}, false, csv},          {"rings-json", {}, false, to_rings_json},
      {"menge-xml", {}, false, to_menge_xml}, {"sumo-poly", {".poly.xml"}, false, to_sumo_poly},
  };
  return kWriters;
}

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

const Writer* writer_by_extension(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  for (const Writer& writer : writers()) {
    for (const char* ending : writer.endings) {
      if (ends_with(name, ending)) return &writer;
    }
  }
  return nullptr;
}

const Writer* writer_by_name(const std::string& name) {
  for (const Writer& writer : writers()) {
    if (name == writer.name) return &writer;
  }
  return nullptr;
}

std::string names() {
  std::string text;
  for (const std::string& name : writable_formats()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string endings() {
  std::string text;
  for (const Writer& writer : writers()) {
    for (const char* ending : writer.endings) text += (text.empty() ? "" : ", ") + std::string(ending);
  }
  return text;
}

const Writer& writer_for(const std::filesystem::path& path, const std::string& format) {
  if (!format.empty()) {
    if (const Writer* writer = writer_by_name(format)) return *writer;
    throw DataError(DataCode::not_an_option, path.string(), "format", "\"" + format + "\"", "one of " + names());
  }
  if (const Writer* writer = writer_by_extension(path)) return *writer;
  throw DataError(DataCode::format_unknown, path.string(), "", "the extension \"" + path.extension().string() + "\"",
                  endings() + "; or a format by name: " + names());
}

}  // namespace

geometry::Ring closed(geometry::Ring ring) {
  if (!ring.empty()) ring.push_back(ring.front());
  return ring;
}

std::vector<geometry::Ring> closed_rings_of(const geometry::Polygon& polygon) {
  std::vector<geometry::Ring> rings{closed(polygon.outer)};
  for (const geometry::Ring& hole : polygon.holes) rings.push_back(closed(hole));
  return rings;
}

std::string wkt_of(const geometry::Obstacle& shape) {
  return std::visit([](const auto& s) { return wkt_text(s); }, shape);
}

std::string to_wkt(const Obstacles& obstacles) {
  std::string text;
  for (const formation::SceneObstacle& obstacle : obstacles) text += wkt_of(obstacle.shape) + "\n";
  return text;
}

std::string to_geojson(const Obstacles& obstacles) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object().member("type", "FeatureCollection").member("units", "m");
  json.key("features").begin_array();
  for (const formation::SceneObstacle& obstacle : obstacles) append_feature(json, obstacle);
  json.end_array();
  return json.end_object().take() + "\n";
}

std::vector<std::string> writable_formats() {
  std::vector<std::string> names;
  for (const Writer& writer : writers()) {
    if (!writer.needs_gdal || built_with_gdal()) names.emplace_back(writer.name);
  }
  return names;
}

std::string format_to_write(const std::filesystem::path& path, const std::string& format) {
  return writer_for(path, format).name;
}

std::vector<std::string> write_obstacles(const std::filesystem::path& path, const Obstacles& obstacles,
                                         const std::string& format) {
  Written written = writer_for(path, format).write(obstacles, path.string());
  write_file_atomically(path, written.bytes);
  return std::move(written.losses);
}

}  // namespace exactvo::datasets
