// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/geopackage.h"

#include <fcntl.h>
#include <ogrsf_frmts.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "batch/formats/features.h"
#include "exactvo/datasets/data_error.h"
#include "files/system_error.h"
#include "gdal/gdal_session.h"

namespace exactvo::datasets::batch {
namespace {

/// By the kind of `Value`.
constexpr OGRFieldType kTypes[] = {OFTString, OFTReal, OFTInteger64};

void sync_file(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw cannot_write(path, errno);
  const int failed = ::fsync(descriptor) != 0 ? errno : 0;
  ::close(descriptor);
  if (failed != 0) throw cannot_write(path, failed);
}

/// Threads take turns at it, and GDAL keeps dates and complaints by thread: each call has its own.
class WrittenGeoPackage final : public GeoPackage {
 public:
  WrittenGeoPackage(std::filesystem::path path, const std::string& provenance) : path_(std::move(path)) {
    register_gdal_once();
    call([&] {
      GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
      if (driver != nullptr) data_.reset(driver->Create(path_.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
      if (data_ == nullptr) return false;
      bool worked = data_->SetMetadataItem("EXACTVO_PROVENANCE", provenance.c_str()) == CE_None;
      for (const Layer& layer : layers()) worked = worked && create_layer(layer);
      return worked && data_->StartTransaction() == OGRERR_NONE;
    });
  }

  void add(std::string_view rows) override {
    call([&] {
      while (!rows.empty())
        if (!add(read_row(rows))) return false;
      return true;
    });
  }

  void finish() override {
    call([&] {
      const bool worked = data_->CommitTransaction() == OGRERR_NONE;
      data_.reset();
      return worked;
    });
    sync_file(path_);
  }

 private:
  template <class Action>
  void call(const Action& action) {
    // GDAL's own files ask for no locks, which network mounts may not have: this process alone writes it.
    const ConfigOption files("SQLITE_USE_OGR_VFS", "YES");
    const ConfigOption pragmas("OGR_SQLITE_PRAGMA", "journal_mode=OFF,synchronous=OFF");
    const FixedDate date;
    GdalComplaints complaints;
    const bool worked = action();
    const std::string words = complaints.take_failure();
    if (worked && words.empty()) return;
    throw DataError(DataCode::file_unwritable, path_.string(), "", words.empty() ? "GDAL can't write it" : words,
                    "a path that can be written");
  }

  bool create_layer(const Layer& layer) {
    OGRSpatialReference metres;  // without one the format takes numbers for degrees
    metres.SetLocalCS("local metres");
    metres.SetLinearUnits("metre", 1.0);
    const char* const options[] = {"SPATIAL_INDEX=NO", nullptr};
    OGRLayer* made = data_->CreateLayer(layer.name, &metres, wkbUnknown, const_cast<char**>(options));
    bool worked = made != nullptr;
    for (const Field& field : layer.fields) {
      OGRFieldDefn definition(field.name, kTypes[field.value.index()]);
      worked = worked && made->CreateField(&definition) == OGRERR_NONE;
    }
    layers_.push_back(made);
    return worked;
  }

  bool add(const Row& row) {
    OGRLayer& layer = *layers_[row.layer];
    OGRFeature feature(layer.GetLayerDefn());
    OGRGeometry* geometry = nullptr;
    if (OGRGeometryFactory::createFromWkb(row.geometry.data(), nullptr, &geometry, row.geometry.size()) != OGRERR_NONE)
      return false;
    feature.SetGeometryDirectly(geometry);
    for (int k = 0; k < feature.GetFieldCount(); ++k) set(feature, k, row.values[static_cast<std::size_t>(k)]);
    return layer.CreateFeature(&feature) == OGRERR_NONE;
  }

  static void set(OGRFeature& feature, int field, const Value& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return feature.SetField(field, text->c_str());
    if (const auto* number = std::get_if<double>(&value)) return feature.SetField(field, *number);
    feature.SetField(field, static_cast<GIntBig>(std::get<std::int64_t>(value)));
  }

  std::filesystem::path path_;
  std::unique_ptr<GDALDataset> data_;
  std::vector<OGRLayer*> layers_;
};

}  // namespace

std::unique_ptr<GeoPackage> make_geopackage(const std::filesystem::path& path, const std::string& provenance) {
  return std::make_unique<WrittenGeoPackage>(path, provenance);
}

}  // namespace exactvo::datasets::batch
