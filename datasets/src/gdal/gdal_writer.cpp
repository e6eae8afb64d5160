// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles as GDAL's formats: made in memory, so that the file on disk appears whole or not at all.
#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <ogrsf_frmts.h>

#include <atomic>

#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "writers/writers.h"

namespace exactvo::datasets {
namespace {

/// GeoPackage records when it was written: always the same, so that equal obstacles are equal bytes.
class FixedDate {
 public:
  FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z"); }
  ~FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr); }
  FixedDate(const FixedDate&) = delete;
  FixedDate& operator=(const FixedDate&) = delete;
};

void add_points(OGRSimpleCurve& curve, const std::vector<geometry::Vec2>& points) {
  curve.setNumPoints(static_cast<int>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) curve.setPoint(static_cast<int>(i), points[i].x, points[i].y);
}

OGRGeometryUniquePtr ogr_of(const geometry::Obstacle& shape) {
  if (const auto* line = std::get_if<geometry::Polyline>(&shape)) {
    auto curve = std::make_unique<OGRLineString>();
    add_points(*curve, line->points);
    return OGRGeometryUniquePtr(curve.release());
  }
  auto polygon = std::make_unique<OGRPolygon>();
  for (const geometry::Ring& points : closed_rings_of(std::get<geometry::Polygon>(shape))) {
    OGRLinearRing ring;
    add_points(ring, points);
    polygon->addRing(&ring);
  }
  return OGRGeometryUniquePtr(polygon.release());
}

/// A file in memory with a name of its own, gone with the object.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& extension) {
    static std::atomic<unsigned> number{0};
    name_ = "/vsimem/exactvo_written_" + std::to_string(number++) + extension;
  }
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::string& name() const { return name_; }
  std::string bytes() const {
    vsi_l_offset length = 0;
    const GByte* data = VSIGetMemFileBuffer(name_.c_str(), &length, FALSE);
    return data == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(data), length);
  }

 private:
  std::string name_;
};

class LayerWriter {
 public:
  LayerWriter(const std::string& driver, const std::string& file) : driver_(driver), file_(file) {
    register_gdal_once();
  }

  std::string write(const Obstacles& obstacles) {
    const FixedDate date;
    const MemoryFile memory(driver_ == "GPKG" ? ".gpkg" : ".fgb");
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_.c_str());
    refuse_unless(driver != nullptr);
    std::unique_ptr<GDALDataset> data(driver->Create(memory.name().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    refuse_unless(data != nullptr);
    fill(*data, obstacles);
    data.reset();
    refuse_unless(true);
    std::string bytes = memory.bytes();
    if (bytes.empty()) throw DataError(DataCode::wrong_count, file_, "", "no obstacles", "one at least: " + driver_);
    return bytes;
  }

 private:
  /// A plane of metres with no place on earth: without it GeoPackage takes numbers for degrees.
  static OGRSpatialReference local_metres() {
    OGRSpatialReference system;
    system.SetLocalCS("local metres");
    system.SetLinearUnits(SRS_UL_METER, 1.0);
    return system;
  }

  void fill(GDALDataset& data, const Obstacles& obstacles) {
    OGRSpatialReference system = local_metres();
    // An index would sort the features of a FlatGeobuf.
    const char* const in_order[] = {"SPATIAL_INDEX=NO", nullptr};
    OGRLayer* layer = data.CreateLayer("obstacles", &system, wkbUnknown,
                                       driver_ == "FlatGeobuf" ? const_cast<char**>(in_order) : nullptr);
    refuse_unless(layer != nullptr);
    OGRFieldDefn id("id", OFTString);
    refuse_unless(layer->CreateField(&id) == OGRERR_NONE);
    refuse_unless(layer->StartTransaction() == OGRERR_NONE);
    for (const formation::SceneObstacle& obstacle : obstacles) add(*layer, obstacle);
    refuse_unless(layer->CommitTransaction() == OGRERR_NONE);
  }

  void add(OGRLayer& layer, const formation::SceneObstacle& obstacle) {
    OGRFeature feature(layer.GetLayerDefn());
    feature.SetField("id", obstacle.id.c_str());
    feature.SetGeometryDirectly(ogr_of(obstacle.shape).release());
    refuse_unless(layer.CreateFeature(&feature) == OGRERR_NONE);
  }

  void refuse_unless(bool worked) {
    const std::string words = complaints_.take_failure();
    if (worked && words.empty()) return;
    throw DataError(DataCode::library, file_, "", words.empty() ? "GDAL's driver " + driver_ + " refused" : words,
                    "obstacles that it writes");
  }

  std::string driver_;
  std::string file_;
  GdalComplaints complaints_;
};

}  // namespace

std::string to_gdal_file(const Obstacles& obstacles, const std::string& driver, const std::string& file) {
  return LayerWriter(driver, file).write(obstacles);
}

}  // namespace exactvo::datasets
