// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_shape.h"

#include <cpl_port.h>

#include <algorithm>
#include <utility>

#include "gdal/properties.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

using Fault = std::optional<GeoJsonFault>;

/// How deep the positions of a type lie below `coordinates`; -1 of collections.
struct Type {
  const char* name;
  int depth;
};
constexpr Type kTypes[] = {{"Point", 0},   {"MultiPoint", 1},   {"LineString", 1},         {"MultiLineString", 2},
                           {"Polygon", 2}, {"MultiPolygon", 3}, {"GeometryCollection", -1}};
const char* const kTypeNames =
    "Point, MultiPoint, LineString, MultiLineString, Polygon, MultiPolygon or GeometryCollection";

/// GDAL takes names in any case.
bool is_name(const Json& value, const char* name) {
  return value.is_string() && EQUAL(value.get_ref<const std::string&>().c_str(), name);
}

const Type* type_of(const Json& geometry) {
  const auto type = geometry.find("type");
  if (type == geometry.end()) return nullptr;
  for (const Type& known : kTypes) {
    if (is_name(*type, known.name)) return &known;
  }
  return nullptr;
}

/// A height may follow; what comes after it has no meaning (RFC 7946, 3.1.1).
bool is_position(const Json& value) {
  if (!value.is_array() || value.size() < 2) return false;
  for (std::size_t k = 0; k < std::min<std::size_t>(value.size(), 3); ++k) {
    if (!value[k].is_number()) return false;
  }
  return true;
}

Fault fault_of_coordinates(const Json& value, int depth, const std::string& pointer) {
  if (depth == 0) {
    if (is_position(value)) return std::nullopt;
    return GeoJsonFault{pointer, value.dump().substr(0, 40), "a position: [x, y], numbers"};
  }
  if (!value.is_array()) {
    return GeoJsonFault{pointer, described(value), depth == 1 ? "an array of positions" : "an array of arrays"};
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (Fault fault = fault_of_coordinates(value[k], depth - 1, pointer + "/" + std::to_string(k))) return fault;
  }
  return std::nullopt;
}

Fault fault_of_geometry(const Json& geometry, const std::string& pointer, int depth);

Fault fault_of_collection(const Json& geometry, const std::string& pointer, int depth) {
  const auto parts = geometry.find("geometries");
  if (parts == geometry.end() || !parts->is_array()) {
    return GeoJsonFault{pointer + "/geometries", parts == geometry.end() ? "nothing" : described(*parts),
                        "an array of geometries"};
  }
  for (std::size_t k = 0; k < parts->size(); ++k) {
    const std::string place = pointer + "/geometries/" + std::to_string(k);
    if (Fault fault = fault_of_geometry((*parts)[k], place, depth + 1)) return fault;
  }
  return std::nullopt;
}

Fault fault_of_geometry(const Json& geometry, const std::string& pointer, int depth) {
  if (geometry.is_null() || depth > kDeepestCollection) return std::nullopt;
  if (!geometry.is_object()) return GeoJsonFault{pointer, described(geometry), "a geometry or null"};
  const Type* type = type_of(geometry);
  if (type == nullptr) {
    const auto word = geometry.find("type");
    return GeoJsonFault{pointer + "/type", word == geometry.end() ? "nothing" : described(*word), kTypeNames};
  }
  if (type->depth < 0) return fault_of_collection(geometry, pointer, depth);
  const auto coordinates = geometry.find("coordinates");
  if (coordinates == geometry.end()) return GeoJsonFault{pointer + "/coordinates", "nothing", "an array"};
  const bool is_empty_point = type->depth == 0 && coordinates->is_array() && coordinates->empty();
  if (is_empty_point) return std::nullopt;
  return fault_of_coordinates(*coordinates, type->depth, pointer + "/coordinates");
}

/// GDAL takes attributes in any encoding; the shape needs only ASCII.
Json parsed_as_ascii(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0x80) != 0; }, '?');
  return parse_json_if_any(text);
}

bool holds_position(const Json& geometry) {
  const Type* type = type_of(geometry);
  return type != nullptr && type->depth >= 0 && geometry.contains("coordinates") && !geometry["coordinates"].empty();
}

bool is_feature_or_geometry(const Json& json) {
  if (!json.is_object() || !json.contains("type")) return false;
  return is_name(json["type"], "Feature") || type_of(json) != nullptr;
}

Fault fault_of_feature(const Json& record) {
  if (!record.is_object()) return GeoJsonFault{"", described(record), "a feature"};
  const auto geometry = record.find("geometry");
  if (geometry != record.end()) return fault_of_geometry(*geometry, "/geometry", 0);
  const bool stands_alone = record.contains("coordinates") || record.contains("geometries") || type_of(record);
  return stands_alone ? fault_of_geometry(record, "", 0) : std::nullopt;
}

Fault fault_where_read(const Json& record, bool read) {
  const bool bare = !read && record.is_object() && !record.contains("geometry") && holds_position(record);
  return bare ? GeoJsonFault{"", "a geometry", "a feature"} : fault_of_feature(record);
}

Fault fault_in_sequence(const Json& record) {
  if (is_feature_or_geometry(record)) return fault_of_feature(record);
  const bool named = record.is_object() && record.contains("type");
  return GeoJsonFault{named ? "/type" : "", described(named ? record["type"] : record), "a feature or a geometry"};
}

}  // namespace

GeoJsonText::GeoJsonText(std::string text) : text_(std::move(text)), json_(parse_json_if_any(text_)) {
  is_utf8_ = !json_.is_discarded();
  if (!is_utf8_) json_ = parsed_as_ascii(text_);
}

// What is quoted from a text is ASCII in any case.

std::optional<GeoJsonFault> GeoJsonText::fault(bool read) const {
  if (json_.is_discarded()) {
    if (read || text_.find("\"coordinates\"") == std::string::npos) return std::nullopt;
    return GeoJsonFault{"", "coordinates that are no JSON", "finite numbers"};
  }
  const Fault fault = fault_where_read(json_, read);
  return fault && is_utf8_ ? fault_where_read(parsed_as_ascii(text_), read) : fault;
}

std::optional<GeoJsonFault> GeoJsonText::fault_as_record() const {
  if (json_.is_discarded()) return std::nullopt;
  const Fault fault = fault_in_sequence(json_);
  return fault && is_utf8_ ? fault_in_sequence(parsed_as_ascii(text_)) : fault;
}

FeatureProperties GeoJsonText::properties() const {
  return is_utf8_ ? properties_of_geojson(json_) : FeatureProperties{};
}

bool is_type_of_record(const std::string& type) {
  return is_feature_or_geometry(Json{{"type", type}});
}

std::string place_within(const GeoJsonFault& fault) {
  return fault.pointer.empty() ? "" : ", " + fault.pointer;
}

}  // namespace exactvo::datasets
