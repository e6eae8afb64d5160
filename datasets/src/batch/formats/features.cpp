// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/features.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "batch/formats/bytes.h"
#include "exactvo/geometry/pi.h"
#include "json/json_text.h"

namespace exactvo::datasets::batch {
namespace {

using geometry::ConvexPolygon;
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
  const geometry::ShapeFigures& f = shapes.figures;
  const bool free = shapes.trap_free.ellipse.has_value();
  feature.values = {head.key,
                    head.file,
                    head.id,
                    head.outcome,
                    static_cast<std::int64_t>(shapes.certified()),
                    static_cast<std::int64_t>(f.vertices),
                    static_cast<std::int64_t>(shapes.facades.facades.size()),
                    static_cast<std::int64_t>(shapes.pieces.size()),
                    f.area,
                    f.hull_area,
                    f.ellipse_area,
                    f.trap_free_area,
                    f.trap_free_beyond,
                    std::string(free ? name(shapes.trap_free.grade) : "none")};
  return feature;
}

Feature ellipse_feature(const std::string& key, const char* kind, std::int64_t number, const Ellipse& e, int points) {
  Feature feature = flat_or_filled(kEllipses, outline_of(e, points));
  feature.values = {key, std::string(kind), number, e.center.x, e.center.y, e.l11, e.l21, e.l22};
  return feature;
}

void give_facades(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  std::int64_t number = 0;
  for (const Segment& s : shapes.facades.facades) {
    Feature feature;
    feature.layer = kFacades;
    feature.rings = {{s.a, s.b}};
    feature.values = {head.key, number, norm(s.b - s.a)};
    const auto k = static_cast<std::size_t>(number++);
    feature.values.emplace_back(k < shapes.facade_ellipses.size() ? shapes.facade_ellipses[k].clearance : 0.0);
    take(feature);
  }
}

void give_pieces(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  std::int64_t number = 0;
  for (const geometry::ConvexShape& piece : shapes.pieces) {
    const auto* segment = std::get_if<Segment>(&piece);
    Ring ring = segment != nullptr ? Ring{segment->a, segment->b} : std::get<ConvexPolygon>(piece).vertices;
    Feature feature = flat_or_filled(kPieces, std::move(ring));
    feature.values = {head.key, number++};
    take(feature);
  }
}

void give_hull(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  Feature feature = flat_or_filled(kHulls, shapes.hull.vertices);
  feature.values = {head.key, shapes.figures.hull_area};
  take(feature);
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

void append_coordinates(JsonWriter& json, const Ring& ring, bool closed) {
  json.begin_inline_array();
  for (const Vec2 p : ring) json.value(p);
  if (closed) json.value(ring.front());
  json.end_array();
}

using Place = std::function<Ring(Ring)>;

std::optional<std::vector<Ring>> placed(const std::vector<Ring>& rings, const Place& place) {
  std::vector<Ring> result;
  try {
    for (const Ring& ring : rings) result.push_back(place(ring));
  } catch (const DataError&) {
    return std::nullopt;
  }
  return result;
}

void append_geometry(JsonWriter& json, const Feature& feature, const Place& place) {
  json.key("geometry");
  const std::optional<std::vector<Ring>> rings = placed(feature.rings, place);
  if (!rings) {
    json.null();
    return;
  }
  json.begin_object();
  json.member("type", feature.is_polygon ? "Polygon" : "LineString").key("coordinates");
  if (!feature.is_polygon) {
    append_coordinates(json, rings->front(), false);
  } else {
    json.begin_array();
    for (const Ring& ring : *rings) append_coordinates(json, ring, true);
    json.end_array();
  }
  json.end_object();
}

void append_value(JsonWriter& json, const Value& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    json.value(static_cast<std::uint64_t>(*number));
  } else if (const auto* real = std::get_if<double>(&value)) {
    json.value(*real);
  } else {
    json.value(std::get<std::string>(value));
  }
}

// --- Rows ---

void append_points(std::string& bytes, const Ring& ring, bool closed) {
  append_raw(bytes, static_cast<std::uint32_t>(ring.size() + (closed ? 1 : 0)));
  for (const Vec2 p : ring) append_raw(bytes, p);
  if (closed) append_raw(bytes, ring.front());
}

/// The head as GeometryHead says, then well-known binary (OGC 06-103r4, 8.2).
std::string geometry_of(const Feature& feature) {
  constexpr std::uint32_t kLineString = 2;
  constexpr std::uint32_t kPolygon = 3;
  GeometryHead head;
  for (const Vec2 p : feature.rings.front()) head.add(p, p);
  std::string bytes;
  append_raw(bytes, head);
  bytes += kLittleEndian;
  append_raw(bytes, feature.is_polygon ? kPolygon : kLineString);
  if (feature.is_polygon) append_raw(bytes, static_cast<std::uint32_t>(feature.rings.size()));
  for (const Ring& ring : feature.rings) append_points(bytes, ring, feature.is_polygon);
  return bytes;
}

}  // namespace

const std::vector<Layer>& layers() {
  using T = FieldType;
  static const std::vector<Layer> kLayers{
      {"obstacles",
       {{"key", T::text},
        {"file", T::text},
        {"id", T::text},
        {"outcome", T::text},
        {"certified", T::integer},
        {"vertices", T::integer},
        {"facades", T::integer},
        {"pieces", T::integer},
        {"area", T::real},
        {"hull_area", T::real},
        {"ellipse_area", T::real},
        {"trap_free_area", T::real},
        {"trap_free_beyond", T::real},
        {"trap_free", T::text}}},
      {"facades", {{"key", T::text}, {"number", T::integer}, {"length", T::real}, {"clearance", T::real}}},
      {"pieces", {{"key", T::text}, {"number", T::integer}}},
      {"hulls", {{"key", T::text}, {"area", T::real}}},
      {"ellipses",
       {{"key", T::text},
        {"kind", T::text},
        {"number", T::integer},
        {"center_x", T::real},
        {"center_y", T::real},
        {"l11", T::real},
        {"l21", T::real},
        {"l22", T::real}}},
  };
  return kLayers;
}

void features_of(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  take(obstacle_feature(head, shapes));
  give_facades(head, shapes, take);
  give_pieces(head, shapes, take);
  give_hull(head, shapes, take);
  give_ellipses(head, shapes, take);
}

std::string to_geojson(const Feature& feature, const Place& place) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("type", "Feature");
  json.key("properties").begin_object();
  const Layer& layer = layers()[feature.layer];
  for (std::size_t k = 0; k < layer.fields.size(); ++k) {
    json.key(layer.fields[k].name);
    append_value(json, feature.values[k]);
  }
  json.end_object();
  append_geometry(json, feature, place);
  return json.end_object().take();
}

void append_row(std::string& bytes, const Feature& feature) {
  append_raw(bytes, static_cast<std::uint8_t>(feature.layer));
  append_text<Length>(bytes, geometry_of(feature));
  for (const Value& value : feature.values) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) {
      append_raw(bytes, *number);
    } else if (const auto* real = std::get_if<double>(&value)) {
      append_raw(bytes, *real);
    } else {
      append_text<Length>(bytes, std::get<std::string>(value));
    }
  }
}

Row read_row(std::string_view& bytes) {
  Row row;
  row.layer = take_raw<std::uint8_t>(bytes);
  row.geometry = take_text<Length>(bytes);
  for (const Field& field : layers()[row.layer].fields) {
    switch (field.type) {
      case FieldType::text:
        row.values.emplace_back(std::string(take_text<Length>(bytes)));
        break;
      case FieldType::real:
        row.values.emplace_back(take_raw<double>(bytes));
        break;
      case FieldType::integer:
        row.values.emplace_back(take_raw<std::int64_t>(bytes));
        break;
    }
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
