// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_geometry.h"

#include <strings.h>

#include <algorithm>

namespace exactvo::datasets {
namespace {

using Fault = std::optional<GeoJsonFault>;

/// How deep the positions of a type lie below `coordinates`, and those of one line or polygon; -1 of collections.
struct Type {
  const char* name;
  const char* word;  ///< of messages, as GDAL has it for other formats
  int depth;
  int depth_of_part;
};
constexpr int kOfLine = 1, kOfPolygon = 2;
constexpr Type kTypes[] = {{"Point", "POINT", 0, 0},
                           {"MultiPoint", "MULTIPOINT", 1, 0},
                           {"LineString", "LINESTRING", kOfLine, kOfLine},
                           {"MultiLineString", "MULTILINESTRING", 2, kOfLine},
                           {"Polygon", "POLYGON", kOfPolygon, kOfPolygon},
                           {"MultiPolygon", "MULTIPOLYGON", 3, kOfPolygon},
                           {"GeometryCollection", "GEOMETRYCOLLECTION", -1, -1}};
const char* const kTypeNames =
    "Point, MultiPoint, LineString, MultiLineString, Polygon, MultiPolygon or GeometryCollection";
const char* const kFileTypes = "FeatureCollection, Feature or a geometry";

bool is_of_type(const Json& object, const char* name) {
  const auto type = object.is_object() ? object.find("type") : object.end();
  return type != object.end() && type->is_string() &&
         ::strcasecmp(type->get_ref<const std::string&>().c_str(), name) == 0;
}

const Type* type_of(const Json& geometry) {
  for (const Type& known : kTypes)
    if (is_of_type(geometry, known.name)) return &known;
  return nullptr;
}

// --- What is wrong ---

/// A height may follow; what comes after it has no meaning (RFC 7946, 3.1.1).
bool is_position(const Json& value) {
  return value.is_array() && value.size() >= 2 &&
         std::all_of(value.begin(),
                     value.begin() + std::min<std::ptrdiff_t>(3, static_cast<std::ptrdiff_t>(value.size())),
                     [](const Json& number) { return number.is_number(); });
}

Fault fault_of_coordinates(const Json& value, int depth, const std::string& pointer) {
  if (depth == 0) {
    if (is_position(value)) return std::nullopt;
    return GeoJsonFault{pointer, value.dump().substr(0, 40), "a position: [x, y], numbers"};
  }
  if (!value.is_array())
    return GeoJsonFault{pointer, described(value), depth == 1 ? "an array of positions" : "an array of arrays"};
  for (std::size_t k = 0; k < value.size(); ++k)
    if (Fault fault = fault_of_coordinates(value[k], depth - 1, pointer + "/" + std::to_string(k))) return fault;
  return std::nullopt;
}

/// The fault of a member that is not as it should be.
GeoJsonFault fault_of_member(const Json& object, const char* key, const std::string& pointer, const char* expected) {
  const auto member = object.find(key);
  return {pointer + "/" + key, member == object.end() ? "nothing" : described(*member), expected};
}

Fault fault_of_geometry(const Json& geometry, const std::string& pointer) {
  if (geometry.is_null()) return std::nullopt;
  if (!geometry.is_object()) return GeoJsonFault{pointer, described(geometry), "a geometry or null"};
  const Type* type = type_of(geometry);
  if (type == nullptr) return fault_of_member(geometry, "type", pointer, kTypeNames);
  const char* key = type->depth < 0 ? "geometries" : "coordinates";
  const auto parts = geometry.find(key);
  if (parts == geometry.end()) return fault_of_member(geometry, key, pointer, "an array");
  const std::string within = pointer + "/" + key;
  if (type->depth > 0 || (type->depth == 0 && !(parts->is_array() && parts->empty())))
    return fault_of_coordinates(*parts, type->depth, within);
  if (type->depth == 0) return std::nullopt;
  if (!parts->is_array()) return fault_of_member(geometry, key, pointer, "an array of geometries");
  for (std::size_t k = 0; k < parts->size(); ++k)
    if (Fault fault = fault_of_geometry((*parts)[k], within + "/" + std::to_string(k))) return fault;
  return std::nullopt;
}

const char* kind_of(const Json& value) {
  if (value.is_array()) return "an array";
  if (value.is_string()) return "a string";
  if (value.is_number()) return "a number";
  return value.is_null() ? "null" : "true or false";
}

// --- What it holds ---

/// Whether there is no position `depth` below.
bool is_empty(const Json& coordinates, int depth) {
  if (depth == 0) return coordinates.empty();
  return std::all_of(coordinates.begin(), coordinates.end(),
                     [&](const Json& part) { return is_empty(part, depth - 1); });
}

bool is_empty(const Json& geometry) {
  if (geometry.is_null()) return true;
  const Type& type = *type_of(geometry);
  if (type.depth >= 0) return is_empty(geometry["coordinates"], type.depth);
  const Json& parts = geometry["geometries"];
  return std::all_of(parts.begin(), parts.end(), [](const Json& part) { return is_empty(part); });
}

geometry::Ring ring_of(const Json& positions) {
  geometry::Ring ring;
  ring.reserve(positions.size());
  for (const Json& p : positions) ring.push_back({p[0].get<double>(), p[1].get<double>()});
  return ring;
}

/// One line or polygon, or several where the positions lie deeper.
void visit_parts(const Json& coordinates, int depth, int depth_of_part, const Visitor& visitor) {
  const bool is_line = depth_of_part == kOfLine;
  if (depth > depth_of_part) {
    for (const Json& part : coordinates) visit_parts(part, depth - 1, depth_of_part, visitor);
  } else if (is_empty(coordinates, depth)) {
    visitor.other(std::string("an empty ") + (is_line ? "LINESTRING" : "POLYGON") + " skipped");
  } else if (is_line) {
    visitor.shape(RawKind::polyline, {ring_of(coordinates)});
  } else {
    std::vector<geometry::Ring> rings;
    for (const Json& ring : coordinates) rings.push_back(ring_of(ring));
    visitor.shape(RawKind::polygon, std::move(rings));
  }
}

}  // namespace

bool is_feature_collection(const Json& json) {
  return is_of_type(json, "FeatureCollection");
}

bool is_feature_or_geometry(const Json& json) {
  return is_of_type(json, "Feature") || type_of(json) != nullptr;
}

std::optional<GeoJsonFault> fault_of_file(const Json& members) {
  if (is_feature_or_geometry(members)) return std::nullopt;
  if (!members.is_object()) return GeoJsonFault{"", described(members), kFileTypes};
  if (!is_feature_collection(members)) return fault_of_member(members, "type", "", kFileTypes);
  const auto features = members.find("features");
  if (features != members.end() && features->is_array()) return std::nullopt;
  return fault_of_member(members, "features", "", "a list of features");
}

std::optional<GeoJsonFault> fault_of_entry(const Json& entry) {
  if (!entry.is_object()) return GeoJsonFault{"", kind_of(entry), "a feature"};
  const auto geometry = entry.find("geometry");
  if (geometry != entry.end()) return fault_of_geometry(*geometry, "/geometry");
  if (!entry.contains("coordinates") && !entry.contains("geometries") && type_of(entry) == nullptr) return std::nullopt;
  Fault fault = fault_of_geometry(entry, "");
  return fault || is_empty(entry) ? fault : GeoJsonFault{"", "a geometry", "a feature"};
}

std::optional<GeoJsonFault> fault_of_record(const Json& record) {
  if (is_of_type(record, "Feature")) return fault_of_entry(record);
  if (type_of(record) != nullptr) return fault_of_geometry(record, "");
  if (!record.is_object()) return GeoJsonFault{"", described(record), "a feature or a geometry"};
  return fault_of_member(record, "type", "", "a feature or a geometry");
}

const Json* geometry_of(const Json& record) {
  if (type_of(record) != nullptr) return &record;
  const auto geometry = record.find("geometry");
  return geometry == record.end() || geometry->is_null() ? nullptr : &*geometry;
}

void visit(const Json& geometry, const Visitor& visitor) {
  if (geometry.is_null()) return;
  const Type& type = *type_of(geometry);
  if (is_empty(geometry)) return visitor.other(std::string("an empty ") + type.word + " skipped");
  if (type.depth_of_part == 0)
    return visitor.other(std::string("a ") + type.word + " skipped: points are no obstacles");
  if (type.depth > 0) return visit_parts(geometry["coordinates"], type.depth, type.depth_of_part, visitor);
  for (const Json& part : geometry["geometries"]) visit(part, visitor);
}

FeatureProperties properties_of(const Json& feature) {
  FeatureProperties properties;
  if (type_of(feature) != nullptr) return properties;
  const auto members = feature.find("properties");
  const auto id = feature.find("id");
  if (members != feature.end() && members->is_object() && !members->empty()) properties.members = members->dump();
  if (id != feature.end() && (id->is_string() || id->is_number())) properties.id = id->dump();
  return properties;
}

}  // namespace exactvo::datasets
