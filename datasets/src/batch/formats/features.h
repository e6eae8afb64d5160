// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a batch writes of an obstacle for maps: features in layers, the same for GeoPackage and GeoJSON.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "exactvo/geometry/obstacle_shapes.h"

namespace exactvo::datasets::batch {

using Value = std::variant<std::string, double, std::int64_t>;

struct Field {
  const char* name;
  Value value;
};

struct Layer {
  const char* name;
  std::vector<Field> fields;  ///< those of its features, with any values of their types
};

/// obstacles, facades, pieces, hulls, ellipses.
const std::vector<Layer>& layers();

/// A polygon has rings (not closed here), a line has one and is open.
struct Feature {
  std::size_t layer = 0;
  bool is_polygon = false;
  std::vector<geometry::Ring> rings;
  std::vector<Field> fields;  ///< the layer's
};

/// The identity of the obstacle.
struct FeatureHead {
  std::string file;
  std::string id;
  std::string key;  ///< "FILE#NUMBER": what the rows of all layers have in common
  std::string outcome;
};

using TakeFeature = std::function<void(const Feature& feature)>;
/// Gives every feature of one obstacle, layer by layer; together they would take much more room than what is written of
/// them. Outlines of ellipses are rounded to a 10,000th of their size: for looking at; the ellipse itself stands in the
/// fields.
void features_of(const FeatureHead& head, const geometry::ObstacleShapes& shapes, const TakeFeature& take);

/// What is written of the points of a ring or a line. Throws DataError where they have no place on earth.
using Place = std::function<geometry::Ring(geometry::Ring)>;
/// A line of GeoJSON, without comma or newline. The geometry is null where `place` throws.
std::string to_geojson(const Feature& feature, const Place& place);

/// Appends the feature to `bytes` for `read_row`.
void append_row(std::string& bytes, const Feature& feature);
/// Takes the next one off the front. REQUIRES: what append_row wrote.
struct Row {
  std::size_t layer = 0;
  std::string_view geometry;  ///< well-known binary
  std::vector<Value> values;
};
Row read_row(std::string_view& bytes);

/// Points of the boundary for drawing.
geometry::Ring outline_of(const geometry::Ellipse& ellipse, int points);

}  // namespace exactvo::datasets::batch
