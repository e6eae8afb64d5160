// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/package_schema.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <ogrsf_frmts.h>

#include <memory>

#include "batch/formats/features.h"
#include "exactvo/datasets/data_error.h"
#include "files/unique_word.h"
#include "gdal/gdal_session.h"

namespace exactvo::datasets::batch {
namespace {

OGRFieldType type_of(FieldType type) {
  switch (type) {
    case FieldType::text:
      return OFTString;
    case FieldType::real:
      return OFTReal;
    case FieldType::integer:
      return OFTInteger64;
  }
  return OFTString;
}

/// Set for this thread while it lives.
class FixedDate {
 public:
  FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z"); }
  ~FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr); }
  FixedDate(const FixedDate&) = delete;
  FixedDate& operator=(const FixedDate&) = delete;
};

/// A file of GDAL's in memory, gone with the object.
class MemoryFile {
 public:
  MemoryFile() : name_("/vsimem/" + unique_word() + ".gpkg") {}
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::string bytes() const {
    vsi_l_offset length = 0;
    const GByte* data = VSIGetMemFileBuffer(name(), &length, FALSE);
    return data == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(data), length);
  }

 private:
  std::string name_;
};

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
      OGRFieldDefn definition(field.name, type_of(field.type));
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
  const FixedDate date;
  const MemoryFile file;
  Schema schema(file.name(), path);
  schema.describe(provenance);
  for (const Layer& layer : layers()) schema.create_layer(layer);
  schema.close();
  return file.bytes();
}

}  // namespace exactvo::datasets::batch
