// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a feature holds: lines and polygons, and what it has beside its shape; and what a GeoJSON file that we wrote
/// says of its plane.

#include <ogr_feature.h>
#include <ogr_geometry.h>

#include <functional>
#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "gdal/degree_box.h"
#include "json/json_text.h"
#include "readers/raw_geometry.h"

namespace exactvo::datasets {

/// The lines and polygons inside a geometry of any kind, in order, and a word about what else is there.
struct Visitor {
  std::function<void(RawKind, std::vector<geometry::Ring>)> shape;
  std::function<void(const std::string&)> other;
};

/// One that puts all rings and lines into `box`, which must outlive it.
Visitor taker_of_rings(DegreeBox& box);

void visit(const OGRGeometry& geometry, const Visitor& visitor, int depth = 0);

/// The fields of the feature; in a CSV without the column that its geometry was read from, in a GeoPackage with its
/// number.
FeatureProperties properties_of(const OGRFeature& feature, const std::string& driver);

/// What stands in the column that a CSV's geometries are taken from.
std::string text_of_geometry(const OGRFeature& feature);

/// What well-known text, or binary in hexadecimal digits, says of its reference system before the geometry; 0: nothing.
int srid_of(const std::string& text);
/// Well-known text that says something of it, be it 0.
bool begins_with_srid(const std::string& text);

/// GeoJSON's top-level member "local_metres" (obstacle_write.h).
struct GivenPlane {
  LocalPlane plane;  ///< its origin is that of the projection, also where it is no place on earth
  bool is_placed = true;
  int decimals = -1;  ///< of the metres; below 0: not known

  geometry::Vec2 rounded(geometry::Vec2 p) const;
};

/// Throws DataError (E_TYPE, E_RANGE) where it is not as we write it. Without the member: nothing.
GivenPlane given_plane(const Json& collection, const std::string& file);

}  // namespace exactvo::datasets
