// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles as GDAL's formats: made in memory, so that the file on disk appears whole or not at all.
#include <ogrsf_frmts.h>

#include <algorithm>

#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "obstacles/courses.h"
#include "writers/property_table.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

void add_points(OGRSimpleCurve& curve, const std::vector<geometry::Vec2>& points) {
  curve.setNumPoints(static_cast<int>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) curve.setPoint(static_cast<int>(i), points[i].x, points[i].y);
}

std::unique_ptr<OGRGeometry> ogr_of(const geometry::Obstacle& shape) {
  const std::vector<geometry::Ring> courses = courses_of(shape);
  if (!geometry::has_interior(shape)) {
    auto curve = std::make_unique<OGRLineString>();
    add_points(*curve, courses.front());
    return curve;
  }
  auto polygon = std::make_unique<OGRPolygon>();
  for (const geometry::Ring& points : courses) {
    OGRLinearRing ring;
    add_points(ring, points);
    polygon->addRing(&ring);
  }
  return polygon;
}

class LayerWriter {
 public:
  LayerWriter(const std::string& driver, const std::string& file, const WriteOptions& options)
      : driver_(driver), file_(file), options_(options), table_(options.properties, {"id", "fid", "geom", kFeatureId}) {
    register_gdal_once();
  }

  Written write(const Obstacles& obstacles) {
    const MemoryFile memory(driver_ == "GPKG" ? ".gpkg" : ".fgb");
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_.c_str());
    refuse_unless(driver != nullptr);
    std::unique_ptr<GDALDataset> data(driver->Create(memory.name(), 0, 0, 0, GDT_Unknown, nullptr));
    refuse_unless(data != nullptr);
    fill(*data, obstacles);
    data.reset();
    refuse_unless(true);
    std::string bytes = memory.bytes();
    if (bytes.empty()) throw DataError(DataCode::wrong_count, file_, "", "no obstacles", "one at least: " + driver_);
    Written written{std::move(bytes), table_.renamed()};
    if (has_id_column_)
      written.losses.push_back(std::string("feature ids as such: they are not distinct whole numbers from 1 on, or ") +
                               driver_ + " numbers features itself; they stand in column \"" + kFeatureId + "\"");
    return written;
  }

 private:
  /// The column of feature ids that are not distinct numbers, or not of a GeoPackage.
  static constexpr const char* kFeatureId = "feature_id";

  /// That of the plane. One without a place on earth has a system of its own: without it GeoPackage takes numbers for
  /// degrees.
  OGRSpatialReference local_metres() const {
    OGRSpatialReference system;
    const LocalPlane& plane = options_.plane;
    const bool is_shifted = plane.offset != geometry::Vec2{};
    if (!plane.reference_system.empty() && !is_shifted) {
      system.importFromWkt(plane.reference_system.c_str());
    } else if (plane.origin && plane.reference_system.empty() && !is_shifted) {
      system = plane_round(*OGRSpatialReference::GetWGS84SRS(), *plane.origin);
      system.SetProjCS("local metres");
    } else {
      system.SetLocalCS("local metres");
      system.SetLinearUnits(SRS_UL_METER, 1.0);
    }
    return system;
  }

  /// By PropertyTable::Type.
  static constexpr OGRFieldType kTypes[] = {OFTInteger, OFTInteger64, OFTReal, OFTString};

  /// The ids where a GeoPackage can have them as its own: distinct whole numbers from 1 on. Else none.
  static std::vector<GIntBig> feature_numbers(const std::vector<FeatureProperties>& all) {
    std::vector<GIntBig> numbers;
    for (const FeatureProperties& p : all) {
      const Json id = p.id.empty() ? Json() : Json::parse(p.id, nullptr, false);
      if (!id.is_number_integer() || id.get<double>() < 1.0 || id.get<double>() > 0x1p62) return {};
      numbers.push_back(id.get<GIntBig>());
    }
    std::vector<GIntBig> sorted = numbers;
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? numbers : std::vector<GIntBig>{};
  }

  void create_fields(OGRLayer& layer) {
    OGRFieldDefn id("id", OFTString);
    refuse_unless(layer.CreateField(&id) == OGRERR_NONE);
    const std::vector<FeatureProperties>& all = options_.properties;
    const bool has_ids = std::any_of(all.begin(), all.end(), [](const FeatureProperties& p) { return !p.id.empty(); });
    if (has_ids && driver_ == "GPKG") numbers_ = feature_numbers(all);
    has_id_column_ = has_ids && numbers_.empty();
    OGRFieldDefn feature_id(kFeatureId, OFTString);
    if (has_id_column_) refuse_unless(layer.CreateField(&feature_id) == OGRERR_NONE);
    for (const PropertyTable::Column& column : table_.columns()) {
      OGRFieldDefn field(column.name.c_str(), kTypes[static_cast<int>(column.type)]);
      if (column.type == PropertyTable::Type::boolean) field.SetSubType(OFSTBoolean);
      refuse_unless(layer.CreateField(&field) == OGRERR_NONE);
    }
  }

  void fill(GDALDataset& data, const Obstacles& obstacles) {
    OGRSpatialReference system = local_metres();
    // An index would sort the features of a FlatGeobuf.
    const char* const in_order[] = {"SPATIAL_INDEX=NO", nullptr};
    OGRLayer* layer = data.CreateLayer("obstacles", &system, wkbUnknown,
                                       driver_ == "FlatGeobuf" ? const_cast<char**>(in_order) : nullptr);
    refuse_unless(layer != nullptr);
    create_fields(*layer);
    refuse_unless(layer->StartTransaction() == OGRERR_NONE);
    for (std::size_t k = 0; k < obstacles.size(); ++k) add(*layer, obstacles[k], k);
    refuse_unless(layer->CommitTransaction() == OGRERR_NONE);
  }

  void add(OGRLayer& layer, const formation::SceneObstacle& obstacle, std::size_t number) {
    OGRFeature feature(layer.GetLayerDefn());
    const Json row = table_.row(number);
    feature.SetField("id", PropertyTable::id_of(row, obstacle.id).c_str());
    if (!numbers_.empty()) feature.SetFID(numbers_[number]);
    if (has_id_column_ && !options_.properties[number].id.empty())
      feature.SetField(kFeatureId, PropertyTable::text_of(Json::parse(options_.properties[number].id)).c_str());
    const int first = feature.GetFieldCount() - static_cast<int>(table_.columns().size());
    for (std::size_t k = 0; k < table_.columns().size(); ++k) {
      const PropertyTable::Column& column = table_.columns()[k];
      const Json* value = PropertyTable::value_in(row, column);
      if (value != nullptr) set_field(feature, first + static_cast<int>(k), column.type, *value);
    }
    feature.SetGeometryDirectly(ogr_of(obstacle.shape).release());
    refuse_unless(layer.CreateFeature(&feature) == OGRERR_NONE);
  }

  static void set_field(OGRFeature& feature, int field, PropertyTable::Type type, const Json& value) {
    switch (type) {
      case PropertyTable::Type::boolean:
        return feature.SetField(field, value.get<bool>() ? 1 : 0);
      case PropertyTable::Type::integer:
        return feature.SetField(field, static_cast<GIntBig>(value.get<std::int64_t>()));
      case PropertyTable::Type::real:
        return feature.SetField(field, value.get<double>());
      case PropertyTable::Type::text:
        return feature.SetField(field, PropertyTable::text_of(value).c_str());
    }
  }

  void refuse_unless(bool worked) {
    const std::string words = complaints_.take_failure();
    if (worked && words.empty()) return;
    throw DataError(DataCode::library, file_, "", words.empty() ? "GDAL's driver " + driver_ + " refused" : words,
                    "obstacles that it writes");
  }

  std::string driver_;
  std::string file_;
  const WriteOptions& options_;
  PropertyTable table_;
  std::vector<GIntBig> numbers_;  ///< of the features, where their ids are that
  bool has_id_column_ = false;
  GdalComplaints complaints_;
};

}  // namespace

Written to_gdal_file(const Obstacles& obstacles, const WriteOptions& options, const std::string& driver,
                     const std::string& file) {
  return LayerWriter(driver, file, options).write(obstacles);
}

}  // namespace exactvo::datasets
