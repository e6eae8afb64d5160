// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/obstacle_write.h"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/geometry/require.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "gdal/vector_library.h"
#include "json/json_text.h"
#include "obstacles/courses.h"
#include "scenarios/scenario_json.h"
#include "writers/property_table.h"
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

// --- GeoJSON ---

using Points = std::vector<geometry::Vec2>;
/// Longitudes and latitudes are rounded, and neighbours may become one: a point twice running is left out, unless too
/// few would stay for a line or a ring.
Points without_repeats(Points points) {
  Points kept;
  for (const geometry::Vec2 p : points)
    if (kept.empty() || !(kept.back() == p)) kept.push_back(p);
  const bool is_closed = points.size() > 1 && points.front() == points.back();
  return kept.size() < (is_closed ? 4 : 2) ? points : kept;
}

/// Those of the input, and `id` where none of them is called so.
std::string members_of(const formation::SceneObstacle& obstacle, const FeatureProperties& properties) {
  Json members = properties.members.empty() ? Json::object() : Json::parse(properties.members, nullptr, false);
  if (!members.is_object()) members = Json::object();
  if (!members.contains("id")) members["id"] = obstacle.id;
  return members.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_feature(JsonWriter& json, const formation::SceneObstacle& obstacle, const FeatureProperties& properties,
                    const Placement& place, bool drops_repeats) {
  json.begin_inline_object().member("type", "Feature");
  if (!properties.id.empty()) json.key("id").raw(properties.id);
  json.key("properties").raw(members_of(obstacle, properties));
  std::vector<geometry::Ring> courses = placed(courses_of(obstacle.shape), place);
  if (drops_repeats)
    for (geometry::Ring& course : courses) course = without_repeats(std::move(course));
  json.key("geometry").begin_object();
  append_geojson(json, geometry::has_interior(obstacle.shape), courses);
  json.end_object().end_object();
}

/// The fewest decimals, of at most six, that all coordinates have; -1 where some has more.
int decimals_of(const Obstacles& obstacles) {
  constexpr int kMost = 6;
  int decimals = 0;
  const auto has = [](double x, int places) {
    const double factor = std::pow(10.0, places);
    return std::round(x * factor) / factor == x;
  };
  for (const formation::SceneObstacle& obstacle : obstacles) {
    for (const geometry::Vec2 p : geometry::vertices_of(obstacle.shape)) {
      while (!(has(p.x, decimals) && has(p.y, decimals))) {
        if (++decimals > kMost) return -1;
      }
    }
  }
  return decimals;
}

/// One without a place on earth is moved near (0, 0), which is laid where the equator meets the first meridian.
LocalPlane plane_for(const Obstacles& obstacles, const LocalPlane& given) {
  if (given.is_placed()) return given;
  Extent extent;
  for (const formation::SceneObstacle& obstacle : obstacles)
    for (const geometry::Vec2 p : geometry::vertices_of(obstacle.shape)) extent.add(p);
  LocalPlane plane;
  if (!extent.is_empty()) plane.offset = offset_for(extent.low, extent.high);
  return plane;
}

// --- Properties of other formats ---

const FeatureProperties& properties_of(const WriteOptions& options, std::size_t obstacle) {
  static const FeatureProperties kNone;
  return obstacle < options.properties.size() ? options.properties[obstacle] : kNone;
}

Written wkt(const Obstacles& obstacles, const WriteOptions& options, const std::string&) {
  Written written{to_wkt(obstacles), {}};
  add_losses(options, "WKT", written.losses);
  written.losses.emplace_back("ids: WKT has no place for them");
  return written;
}

/// In longitude and latitude, or in metres; ids become the property `id` where no property is called so.
Written geojson(const Obstacles& obstacles, const WriteOptions& options, const std::string& file) {
  const LocalPlane plane = plane_for(obstacles, options.plane);
  std::optional<MetresToDegrees> to_degrees;
  if (!options.metres) to_degrees.emplace(plane, file);
  const Placement place = [&](Points points) { return to_degrees ? (*to_degrees)(std::move(points)) : points; };
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object().member("type", "FeatureCollection");
  if (options.metres) {
    json.member("units", "m");
  } else {
    json.key("local_metres").raw(local_metres_member(plane, decimals_of(obstacles)));
  }
  json.key("features").begin_array();
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    append_feature(json, obstacles[k], properties_of(options, k), place, to_degrees.has_value());
  json.end_array();
  return {json.end_object().take() + "\n", {}};
}

Written csv(const Obstacles& obstacles, const WriteOptions& options, const std::string&) {
  const PropertyTable table(options.properties, {"id", "WKT", "feature_id"});
  const auto& all = options.properties;
  const bool has_ids = std::any_of(all.begin(), all.end(), [](const FeatureProperties& p) { return !p.id.empty(); });
  std::string text = has_ids ? "id,WKT,feature_id" : "id,WKT";
  for (const PropertyTable::Column& column : table.columns()) text += "," + csv_quoted(column.name);
  text += "\r\n";
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const formation::SceneObstacle& o = obstacles[k];
    const Json row = table.row(k);
    text += csv_quoted(PropertyTable::id_of(row, o.id)) + "," + csv_quoted(wkt_of(o.shape));
    const std::string& id = properties_of(options, k).id;
    if (has_ids) text += "," + (id.empty() ? id : csv_quoted(PropertyTable::text_of(Json::parse(id))));
    for (const PropertyTable::Column& column : table.columns()) {
      const Json* value = PropertyTable::value_in(row, column);
      text += "," + (value == nullptr ? std::string() : csv_quoted(PropertyTable::text_of(*value)));
    }
    text += "\r\n";
  }
  Written written{text, table.renamed()};
  add_plane_losses(options, "CSV", written.losses);
  return written;
}

Written geopackage(const Obstacles& obstacles, const WriteOptions& options, const std::string& file) {
  return vector_library().to_gdal_file(obstacles, options, "GPKG", file);
}

Written flatgeobuf(const Obstacles& obstacles, const WriteOptions& options, const std::string& file) {
  return vector_library().to_gdal_file(obstacles, options, "FlatGeobuf", file);
}

struct Writer {
  const char* name;
  std::vector<const char*> endings;  ///< lower case; the longest that fits is meant
  bool needs_gdal;
  Written (*write)(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);
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

const Writer& writer_for(const std::filesystem::path& path, const std::string& format) {
  const std::string names = boost::join(writable_formats(), ", ");
  if (!format.empty()) {
    for (const Writer& writer : writers())
      if (format == writer.name) return writer;
    throw DataError(DataCode::not_an_option, path.string(), "format", "\"" + format + "\"", "one of " + names);
  }
  const std::string name = lower_case(path.filename().string());
  std::vector<std::string> endings;
  for (const Writer& writer : writers()) {
    for (const char* ending : writer.endings) {
      if (boost::ends_with(name, ending)) return writer;
      endings.emplace_back(ending);
    }
  }
  throw DataError(DataCode::format_unknown, path.string(), "", "the extension \"" + path.extension().string() + "\"",
                  boost::join(endings, ", ") + "; or a format by name: " + names);
}

}  // namespace

std::vector<geometry::Ring> placed(std::vector<geometry::Ring> rings, const Placement& place) {
  std::vector<geometry::Vec2> all;
  for (const geometry::Ring& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  all = place(std::move(all));
  auto at = all.begin();
  for (geometry::Ring& ring : rings) {
    const auto end = at + static_cast<std::ptrdiff_t>(ring.size());
    ring.assign(at, end);
    at = end;
  }
  return rings;
}

void append_geojson(JsonWriter& json, bool is_polygon, const std::vector<geometry::Ring>& courses) {
  json.member("type", is_polygon ? "Polygon" : "LineString").key("coordinates");
  if (!is_polygon) return append_points(json, courses.front());
  json.begin_array();
  for (const geometry::Ring& ring : courses) append_points(json, ring);
  json.end_array();
}

std::string wkt_of(const geometry::Obstacle& shape) {
  std::string text;
  for (const geometry::Ring& course : courses_of(shape)) text += (text.empty() ? "" : ", ") + wkt_points(course);
  return geometry::has_interior(shape) ? "POLYGON (" + text + ")" : "LINESTRING " + text;
}

std::string to_wkt(const Obstacles& obstacles) {
  std::string text;
  for (const formation::SceneObstacle& obstacle : obstacles) text += wkt_of(obstacle.shape) + "\n";
  return text;
}

std::string local_metres_member(const LocalPlane& plane, int decimals) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object();
  if (plane.reference_system.empty()) {
    const ProjectionOrigin centre = plane.origin.value_or(ProjectionOrigin{});
    json.member("centre", geometry::Vec2{centre.longitude, centre.latitude});
  } else {
    json.member("reference_system", plane.reference_system);
  }
  json.member("offset", plane.offset);
  if (decimals >= 0) json.member("decimals", decimals);
  json.member("is_placed", plane.is_placed());
  return json.end_object().take();
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
                                         const WriteOptions& options) {
  EXACTVO_REQUIRE(options.properties.empty() || options.properties.size() == obstacles.size(),
                  std::to_string(options.properties.size()));
  Written written = writer_for(path, options.format).write(obstacles, options, path.string());
  write_file_atomically(path, written.bytes);
  return std::move(written.losses);
}

}  // namespace exactvo::datasets
