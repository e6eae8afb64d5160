// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/features.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"
#include "json/json_text.h"
#include "obstacles/courses.h"
#include "writers/writers.h"

namespace exactvo::datasets::batch {
namespace {

using geometry::ConvexPolygon;
using geometry::Ellipse;
using geometry::ObstacleShapes;
using geometry::Ring;
using geometry::Segment;
using geometry::Vec2;

enum LayerNumber : std::size_t { kObstacles, kFacades, kPieces, kHulls, kEllipses };  // in the order of kLayers

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
  const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  const geometry::ShapeMeasurements& f = shapes.measurements;
  const bool free = shapes.trap_free.ellipse.has_value();
  feature.fields = {{"key", head.key},
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
  return feature;
}

Feature ellipse_feature(const std::string& key, const char* kind, std::int64_t number, const Ellipse& e, int points) {
  Feature feature = flat_or_filled(kEllipses, outline_of(e, points));
  feature.fields = {{"key", key},
                    {"kind", std::string(kind)},
                    {"number", number},
                    {"center_x", e.center.x},
                    {"center_y", e.center.y},
                    {"l11", e.l11},
                    {"l21", e.l21},
                    {"l22", e.l22}};
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
    feature.fields = {{"key", head.key}, {"number", number++}, {"length", norm(s.b - s.a)}, {"clearance", clearance}};
    take(feature);
  }
}

void give_pieces(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  std::int64_t number = 0;
  for (const geometry::ConvexShape& piece : shapes.pieces) {
    const auto* segment = std::get_if<Segment>(&piece);
    Ring ring = segment != nullptr ? Ring{segment->a, segment->b} : std::get<ConvexPolygon>(piece).vertices;
    Feature feature = flat_or_filled(kPieces, std::move(ring));
    feature.fields = {{"key", head.key}, {"number", number++}};
    take(feature);
  }
}

void give_hull(const FeatureHead& head, const ObstacleShapes& shapes, const TakeFeature& take) {
  Feature feature = flat_or_filled(kHulls, shapes.hull.vertices);
  feature.fields = {{"key", head.key}, {"area", shapes.measurements.hull_area}};
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

}  // namespace

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
  for (const Field& field : feature.fields)
    std::visit([&](const auto& value) { json.member(field.name, value); }, field.value);
  json.end_object();
  append_geometry(json, feature, place);
  return json.end_object().take();
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
