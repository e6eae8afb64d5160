// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Features and geometries of GeoJSON (RFC 7946, section 3) once their JSON is parsed: what is wrong with them, their
/// lines and polygons, and what they have beside. They call themselves as deep as JSON nests (kDeepestJson).

#include <optional>
#include <string>

#include "gdal/properties.h"
#include "json/json_text.h"

namespace exactvo::datasets {

struct GeoJsonFault {
  std::string pointer;  ///< JSON pointer within the record
  std::string found;
  std::string expected;
};

/// Names of types in any case, as GDAL takes them.
bool is_feature_collection(const Json& json);
bool is_feature_or_geometry(const Json& json);

/// That it is a collection, a feature or a geometry.
std::optional<GeoJsonFault> fault_of_file(const Json& members);
/// The first fault of an entry among the features of a collection. None where there is no geometry, or an empty one. A
/// point is no obstacle, but a malformed one may have been meant for something else.
std::optional<GeoJsonFault> fault_of_entry(const Json& entry);
/// The same for a record of a sequence, or for the one that a file holds.
std::optional<GeoJsonFault> fault_of_record(const Json& record);

/// The geometry of a valid feature, or the record itself where that is a geometry. Null: none.
const Json* geometry_of(const Json& record);
/// Shows the parts of a valid geometry to the visitor.
void visit(const Json& geometry, const Visitor& visitor);

/// The properties of a feature; empty for other records.
FeatureProperties properties_of(const Json& feature);

}  // namespace exactvo::datasets
