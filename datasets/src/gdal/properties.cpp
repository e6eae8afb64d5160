// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/properties.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "readers/readers.h"

namespace exactvo::datasets {

namespace {

geometry::Ring points_of(const OGRSimpleCurve& curve) {
  geometry::Ring points(static_cast<std::size_t>(curve.getNumPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {curve.getX(static_cast<int>(i)), curve.getY(static_cast<int>(i))};
  }
  return points;
}

std::vector<geometry::Ring> rings_of(const OGRPolygon& polygon) {
  std::vector<geometry::Ring> rings;
  for (const OGRLinearRing* ring : polygon) rings.push_back(points_of(*ring));
  return rings;
}

void append_value(JsonWriter& json, const OGRFeature& feature, int field) {
  int count = 0;
  const auto list = [&](const auto* numbers) {
    json.begin_array();
    for (int k = 0; k < count; ++k) json.value(numbers[k]);
    json.end_array();
  };
  const OGRFieldDefn& definition = *feature.GetFieldDefnRef(field);
  if (feature.IsFieldNull(field)) {
    json.null();
    return;
  }
  switch (definition.GetType()) {
    case OFTInteger:
      if (definition.GetSubType() == OFSTBoolean) {
        json.value(feature.GetFieldAsInteger(field) != 0);
      } else {
        json.value(feature.GetFieldAsInteger(field));
      }
      break;
    case OFTInteger64:
      json.value(feature.GetFieldAsInteger64(field));
      break;
    case OFTReal:
      json.value(feature.GetFieldAsDouble(field));
      break;
    case OFTIntegerList:
      return list(feature.GetFieldAsIntegerList(field, &count));
    case OFTInteger64List:
      return list(feature.GetFieldAsInteger64List(field, &count));
    case OFTRealList:
      return list(feature.GetFieldAsDoubleList(field, &count));
    case OFTStringList:
      json.begin_array();
      for (char** texts = feature.GetFieldAsStringList(field); texts != nullptr && *texts != nullptr; ++texts)
        json.value(*texts);
      json.end_array();
      break;
    default:
      json.value(feature.GetFieldAsString(field));
  }
}

/// The driver calls the geometries of a CSV's column X "X" or "geom_X", and "" those of a column WKT.
bool is_column_of_geometry(const OGRFeature& feature, const std::string& field) {
  if (feature.GetGeomFieldCount() == 0) return false;
  const std::string name = feature.GetGeomFieldDefnRef(0)->GetNameRef();
  return field == name || "geom_" + field == name || (name.empty() && EQUAL(field.c_str(), "WKT"));
}

double bounded(const JsonCursor& at, double largest) {
  const double number = at.number();
  if (!(std::fabs(number) <= largest)) at.refuse("a number within " + std::to_string(largest), DataCode::out_of_range);
  return number;
}

}  // namespace

Visitor taker_of_rings(DegreeBox& box) {
  const auto take = [&box](RawKind, const std::vector<geometry::Ring>& rings) {
    for (const geometry::Ring& ring : rings) box.add(ring);
  };
  return {take, [](const std::string&) {}};
}

void visit(const OGRGeometry& geometry, const Visitor& visitor, int depth) {
  if (depth > kDeepestCollection) return visitor.other("collections nested too deeply skipped");
  if (geometry.IsEmpty()) return visitor.other(std::string("an empty ") + geometry.getGeometryName() + " skipped");
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPoint:
    case wkbMultiPoint:
      return visitor.other("a " + std::string(geometry.getGeometryName()) + " skipped: points are no obstacles");
    case wkbLineString:
      return visitor.shape(RawKind::polyline, {points_of(*geometry.toLineString())});
    case wkbPolygon:
    case wkbTriangle:
      return visitor.shape(RawKind::polygon, rings_of(*geometry.toPolygon()));
    case wkbMultiLineString:
    case wkbMultiPolygon:
    case wkbGeometryCollection:
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) visit(*part, visitor, depth + 1);
      return;
    default:
      break;
  }
  const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
  if (straight && wkbFlatten(straight->getGeometryType()) != wkbFlatten(geometry.getGeometryType())) {
    return visit(*straight, visitor, depth + 1);
  }
  visitor.other(std::string("a ") + geometry.getGeometryName() + " skipped: no line or polygon");
}

FeatureProperties properties_of(const OGRFeature& feature, const std::string& driver) {
  const bool is_csv = driver == "CSV";
  FeatureProperties properties;
  if (driver == "GPKG" && feature.GetFID() != OGRNullFID) properties.id = std::to_string(feature.GetFID());
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object();
  bool any = false;
  for (int k = 0; k < feature.GetFieldCount(); ++k) {
    const std::string name = feature.GetFieldDefnRef(k)->GetNameRef();
    if (!feature.IsFieldSet(k) || (is_csv && is_column_of_geometry(feature, name))) continue;
    json.key(name);
    append_value(json, feature, k);
    any = true;
  }
  json.end_object();
  if (any) properties.members = json.take();
  return properties;
}

std::string text_of_geometry(const OGRFeature& feature) {
  if (feature.GetGeomFieldCount() == 0) return "";
  const std::string name = feature.GetGeomFieldDefnRef(0)->GetNameRef();
  int column = feature.GetFieldIndex(name.empty() ? "WKT" : name.c_str());
  if (column < 0 && name.rfind("geom_", 0) == 0) column = feature.GetFieldIndex(name.c_str() + 5);
  return column < 0 ? "" : feature.GetFieldAsString(column);
}

bool begins_with_srid(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin != std::string::npos && EQUALN(text.c_str() + begin, "SRID=", 5);
}

int srid_of(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return 0;
  if (begins_with_srid(text)) return std::max(0, std::atoi(text.c_str() + begin + 5));
  const std::string_view rest = std::string_view(text).substr(begin);
  return is_wkb_text(rest) ? srid_of_wkb_text(rest) : 0;
}

geometry::Vec2 GivenPlane::rounded(geometry::Vec2 p) const {
  if (decimals < 0) return p;
  const double places = std::pow(10.0, decimals);
  return {std::round(p.x * places) / places + 0.0, std::round(p.y * places) / places + 0.0};
}

GivenPlane given_plane(const Json& collection, const std::string& file) {
  GivenPlane given;
  const auto member = collection.find("local_metres");
  if (member == collection.end()) return given;
  const JsonCursor at = JsonCursor(collection, file, "").at("local_metres");
  if (at.has("reference_system")) {
    given.plane.reference_system = at.at("reference_system").text();
  } else {
    const JsonCursor centre = at.at("centre");
    if (centre.size() != 2) centre.refuse("[longitude, latitude]", DataCode::wrong_count);
    given.plane.origin = ProjectionOrigin{bounded(centre.at(std::size_t{0}), 180.0), bounded(centre.at(1), 90.0)};
  }
  if (at.has("offset")) {
    const JsonCursor offset = at.at("offset");
    if (offset.size() != 2) offset.refuse("[x, y], m", DataCode::wrong_count);
    given.plane.offset = {bounded(offset.at(std::size_t{0}), kLargestCoordinate),
                          bounded(offset.at(1), kLargestCoordinate)};
  }
  if (at.has("is_placed")) given.is_placed = at.at("is_placed").truth();
  if (at.has("decimals")) given.decimals = static_cast<int>(bounded(at.at("decimals"), 9.0));
  return given;
}

}  // namespace exactvo::datasets
