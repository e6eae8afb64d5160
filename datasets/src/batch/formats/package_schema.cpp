// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/package_schema.h"

#include <ogrsf_frmts.h>

#include <memory>

#include "batch/formats/features.h"
#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "gdal/memory_file.h"

namespace exactvo::datasets::batch {
namespace {

/// By the kind of `Value`.
constexpr OGRFieldType kTypes[] = {OFTString, OFTReal, OFTInteger64};

class Schema {
 public:
  Schema(const char* name, const std::filesystem::path& path) : path_(path) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    need(driver != nullptr);
    data_.reset(driver->Create(name, 0, 0, 0, GDT_Unknown, nullptr));
    need(data_ != nullptr);
  }

  void describe(const std::string& provenance) {
    need(data_->SetMetadataItem("EXACTVO_PROVENANCE", provenance.c_str()) == CE_None);
  }

  void create_layer(const Layer& layer) {
    const char* const options[] = {"SPATIAL_INDEX=YES", nullptr};
    OGRSpatialReference metres;  // without one the format takes numbers for degrees
    metres.SetLocalCS("local metres");
    metres.SetLinearUnits("metre", 1.0);
    OGRLayer* made = data_->CreateLayer(layer.name, &metres, wkbUnknown, const_cast<char**>(options));
    need(made != nullptr);
    for (const Field& field : layer.fields) {
      OGRFieldDefn definition(field.name, kTypes[field.value.index()]);
      need(made->CreateField(&definition) == OGRERR_NONE);
    }
  }

  void close() {
    data_->FlushCache();
    data_.reset();
    need(true);
  }

 private:
  void need(bool done) {
    const std::string words = complaints_.take_failure();
    if (done && words.empty()) return;
    throw DataError(DataCode::file_unwritable, path_.string(), "", words.empty() ? "GDAL can't write it" : words,
                    "a place that can be written");
  }

  const std::filesystem::path& path_;
  GdalComplaints complaints_;
  std::unique_ptr<GDALDataset> data_;
};

}  // namespace

std::string empty_package(const std::string& provenance, const std::filesystem::path& path) {
  register_gdal_once();
  const MemoryFile file(".gpkg", "1970-01-01T00:00:00.000Z");
  Schema schema(file.name(), path);
  schema.describe(provenance);
  for (const Layer& layer : layers()) schema.create_layer(layer);
  schema.close();
  return file.bytes();
}

}  // namespace exactvo::datasets::batch
