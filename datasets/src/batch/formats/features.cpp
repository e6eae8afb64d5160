// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/features.h"

#include <algorithm>
#include <cmath>

#include "batch/formats/bytes.h"
#include "exactvo/geometry/pi.h"
#include "json/json_text.h"
#include "obstacles/courses.h"
#include "writers/writers.h"

namespace exactvo::datasets::batch {
namespace {

using geometry::Ellipse;
using geometry::ObstacleShapes;
using geometry::Ring;
using geometry::Segment;
using geometry::Vec2;

enum LayerNumber : std::size_t { kObstacles, kFacades, kPieces, kHulls, kEllipses };

using Length = std::uint32_t;  // of a text in a row

constexpr int kFinePoints = 48;    // round the whole obstacle
constexpr int kCoarsePoints = 20;  // round a facade

/// Decimal places that leave a 10,000th of `size`.
double rounding_for(double size) {
  if (!(size > 0.0) || !std::isfinite(size)) return 1.0;
  return std::pow(10.0, 4.0 - std::floor(std::log10(size)));
}

double rounded(double x, double places) {
  const double value = std::round(x * places) / places;
  return std::isfinite(value) ? value : x;
}

/// A line where it has no width.
Feature flat_or_filled(std::size_t layer, Ring ring) {
  Feature feature;
  feature.layer = layer;
  feature.is_polygon = ring.size() > 2;
  if (ring.size() == 1) ring.push_back(ring.front());
  feature.rings.push_back(std::move(ring));
  return feature;
}

// --- The fields of each layer ---

std::vector<Field> obstacle_fields(const FeatureHead& head, const ObstacleShapes& shapes) {
  const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  const geometry::ShapeMeasurements& f = shapes.measurements;
  const bool free = shapes.trap_free.ellipse.has_value();
  return {{"key", head.key},
          {"file", head.file},
          {"id", head.id},
          {"outcome", head.outcome},
          {"certified", count(shapes.certified() ? 1 : 0)},
          {"vertices", count(f.vertices)},
          {"facades", count(shapes.facades.facades.size())},
          {"pieces", count(shapes.pieces.size())},
          {"area", f.area},
          {"hull_area", f.hull_area},
          {"ellipse_area", f.ellipse_area},
          {"trap_free_area", f.trap_free_area},
          {"trap_free_beyond", f.trap_free_beyond},
          {"trap_free", std::string(free ? name(shapes.trap_free.grade) : "none")}};
}

std::vector<Field> facade_fields(const std::string& key, std::int64_t number, const Segment& facade, double clearance) {
  return {{"key", key}, {"number", number}, {"length", norm(facade.b - facade.a)}, {"clearance", clearance}};
}

std::vector<Field> piece_fields(const std::string& key, std::int64_t number) {
  return {{"key", key}, {"number", number}};
}

std::vector<Field> hull_fields(const std::string& key, double area) {
  return {{"key", key}, {"area", area}};
}

std::vector<Field> ellipse_fields(const std::string& key, const char* kind, std::int64_t number, const Ellipse& e) {
  return {{"key", key},
          {"kind", std::string(kind)},
          {"number", number},
          {"center_x", e.center.x},
          {"center_y", e.center.y},
          {"l11", e.l11},
          {"l21", e.l21},
          {"l22", e.l22}};
}

// --- Features ---

Feature obstacle_feature(const FeatureHead& head, const ObstacleShapes& shapes) {
  Feature feature;
  feature.layer = kObstacles;
  if (const auto* polygon = std::get_if<geometry::Polygon>(&shapes.obstacle)) {
    feature.is_polygon = true;
    feature.rings.push_back(polygon->outer);
    feature.rings.insert(feature.rings.end(), polygon->holes.begin(), polygon->holes.end());
  } else {
    feature.rings.push_back(std::get<geometry::Polyline>(shapes.obstacle).points);
  }
  feature.fields = obstacle_fields(head, shapes);
  return feature;
}

Feature ellipse_feature(const std::string& key, const char* kind, std::int64_t number, const Ellipse& e, int points) {
  Feature feature = flat_or_filled(kEllipses, outline_of(e, points));
  feature.fields = ellipse_fields(key, kind, number, e);
  return feature;
}

void give_facades(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  std::int64_t number = 0;
  for (const Segment& s : shapes.facades.facades) {
    Feature feature;
    feature.layer = kFacades;
    feature.rings = {{s.a, s.b}};
    const auto k = static_cast<std::size_t>(number);
    const double clearance = k < shapes.facade_ellipses.size() ? shapes.facade_ellipses[k].clearance : 0.0;
    feature.fields = facade_fields(head.key, number++, s, clearance);
    take(feature);
  }
}

void give_pieces(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  std::int64_t number = 0;
  for (const geometry::ConvexShape& piece : shapes.pieces) {
    const auto* segment = std::get_if<Segment>(&piece);
    Ring ring = segment != nullptr ? Ring{segment->a, segment->b} : std::get<geometry::ConvexPolygon>(piece).vertices;
    Feature feature = flat_or_filled(kPieces, std::move(ring));
    feature.fields = piece_fields(head.key, number++);
    take(feature);
  }
}

void give_ellipses(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  take(ellipse_feature(head.key, "smallest", 0, shapes.smallest_ellipse, kFinePoints));
  if (shapes.trap_free.ellipse) {
    take(ellipse_feature(head.key, "trap-free", 0, *shapes.trap_free.ellipse, kFinePoints));
  }
  std::int64_t number = 0;
  for (const geometry::FacadeEnclosure& e : shapes.facade_ellipses) {
    take(ellipse_feature(head.key, "facade", number++, e.ellipse, kCoarsePoints));
  }
}

// --- GeoJSON ---

void append_geometry(JsonWriter& json, const Feature& feature, const Place& place) {
  json.key("geometry");
  std::vector<Ring> rings;
  try {
    for (Ring& points : placed(feature.rings, place))
      rings.push_back(feature.is_polygon ? closed(std::move(points)) : std::move(points));
  } catch (const DataError&) {
    json.null();
    return;
  }
  json.begin_object();
  append_geojson(json, feature.is_polygon, rings);
  json.end_object();
}

// --- Rows ---

void append(std::string& bytes, const std::string& text) {
  append_text<Length>(bytes, text);
}
template <class Number>
void append(std::string& bytes, Number number) {
  append_raw(bytes, number);
}

void take(std::string_view& bytes, std::string& text) {
  text = take_text<Length>(bytes);
}
template <class Number>
void take(std::string_view& bytes, Number& number) {
  number = take_raw<Number>(bytes);
}

/// Well-known binary (OGC 06-103r4, 8.2), in the byte order of the machines that this runs on.
std::string geometry_of(const Feature& feature) {
  constexpr char kLittleEndian = 1;
  constexpr std::uint32_t kLineString = 2;
  constexpr std::uint32_t kPolygon = 3;
  std::string bytes(1, kLittleEndian);
  append_raw(bytes, feature.is_polygon ? kPolygon : kLineString);
  if (feature.is_polygon) append_raw(bytes, static_cast<std::uint32_t>(feature.rings.size()));
  for (const Ring& ring : feature.rings) {
    append_raw(bytes, static_cast<std::uint32_t>(ring.size() + (feature.is_polygon ? 1 : 0)));
    for (const Vec2 p : ring) append_raw(bytes, p);
    if (feature.is_polygon) append_raw(bytes, ring.front());
  }
  return bytes;
}

}  // namespace

const std::vector<Layer>& layers() {
  static const std::vector<Layer> kLayers{{"obstacles", obstacle_fields({}, {})},
                                          {"facades", facade_fields("", 0, {}, 0.0)},
                                          {"pieces", piece_fields("", 0)},
                                          {"hulls", hull_fields("", 0.0)},
                                          {"ellipses", ellipse_fields("", "", 0, {})}};
  return kLayers;
}

void features_of(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  take(obstacle_feature(head, shapes));
  give_facades(head, shapes, take);
  give_pieces(head, shapes, take);
  Feature hull = flat_or_filled(kHulls, shapes.hull.vertices);
  hull.fields = hull_fields(head.key, shapes.measurements.hull_area);
  take(hull);
  give_ellipses(head, shapes, take);
}

std::string to_geojson(const Feature& feature, const Place& place) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("type", "Feature");
  json.key("properties").begin_object();
  for (const Field& field : feature.fields)
    std::visit([&](const auto& value) { json.member(field.name, value); }, field.value);
  json.end_object();
  append_geometry(json, feature, place);
  return json.end_object().take();
}

void append_row(std::string& bytes, const Feature& feature) {
  append_raw(bytes, static_cast<std::uint8_t>(feature.layer));
  append_text<Length>(bytes, geometry_of(feature));
  for (const Field& field : feature.fields) std::visit([&](const auto& value) { append(bytes, value); }, field.value);
}

Row read_row(std::string_view& bytes) {
  Row row;
  row.layer = take_raw<std::uint8_t>(bytes);
  row.geometry = take_text<Length>(bytes);
  for (const Field& field : layers()[row.layer].fields) {
    row.values.push_back(field.value);
    std::visit([&](auto& value) { take(bytes, value); }, row.values.back());
  }
  return row;
}

Ring outline_of(const Ellipse& e, int points) {
  if (e.l11 == 0.0 && e.l21 == 0.0 && e.l22 == 0.0) return {e.center};
  if (e.l22 == 0.0) return {e.center - Vec2{e.l11, e.l21}, e.center + Vec2{e.l11, e.l21}};
  const double places = rounding_for(std::max({std::fabs(e.l11), std::fabs(e.l21), std::fabs(e.l22)}));
  Ring ring;
  ring.reserve(static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * geometry::kPi * i / points;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Vec2 p = e.center + Vec2{e.l11 * c, e.l21 * c + e.l22 * s};
    ring.push_back({rounded(p.x, places), rounded(p.y, places)});
  }
  return ring;
}

}  // namespace exactvo::datasets::batch
