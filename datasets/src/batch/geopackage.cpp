// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/geopackage.h"

#include <cpl_conv.h>
#include <fcntl.h>
#include <ogrsf_frmts.h>
#include <unistd.h>

#include <vector>

#include "batch/features.h"
#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "system_error.h"

namespace exactvo::datasets::batch {
namespace {

/// Rows between commits: few enough to hold in memory, many enough to be quick.
constexpr std::size_t kRowsOfTransaction = 100000;

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

/// Set for this thread while it lives. The file is synced once, at its end; until then a crash loses nothing, since
/// nobody reads it.
class Settings {
 public:
  Settings() {
    CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z");
    CPLSetThreadLocalConfigOption("OGR_SQLITE_SYNCHRONOUS", "OFF");
    CPLSetThreadLocalConfigOption("OGR_SQLITE_JOURNAL", "MEMORY");
    // A second thread would build the spatial index page by page beside this one, in an order of its own.
    CPLSetThreadLocalConfigOption("OGR_GPKG_ALLOW_THREADED_RTREE", "NO");
  }
  ~Settings() {
    for (const char* name :
         {"OGR_CURRENT_DATE", "OGR_SQLITE_SYNCHRONOUS", "OGR_SQLITE_JOURNAL", "OGR_GPKG_ALLOW_THREADED_RTREE"}) {
      CPLSetThreadLocalConfigOption(name, nullptr);
    }
  }
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;
};

void sync_file(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw cannot_write(path, errno);
  const int failed = ::fsync(descriptor) != 0 ? errno : 0;
  ::close(descriptor);
  if (failed != 0) throw cannot_write(path, failed);
}

}  // namespace

struct GeoPackage::Inside {
  std::filesystem::path path;
  GdalComplaints complaints;
  Settings settings;
  std::unique_ptr<GDALDataset> data;
  std::vector<OGRLayer*> layers;
  std::size_t uncommitted = 0;

  void need(bool done) {
    const std::string words = complaints.take_failure();
    if (done && words.empty()) return;
    throw DataError(DataCode::file_unwritable, path.string(), "", words.empty() ? "GDAL can't write it" : words,
                    "a place that can be written");
  }

  void create_layers() {
    const char* const options[] = {"SPATIAL_INDEX=YES", nullptr};
    OGRSpatialReference metres;  // without one the format takes numbers for degrees
    metres.SetLocalCS("local metres");
    metres.SetLinearUnits("metre", 1.0);
    for (const Layer& layer : batch::layers()) {
      OGRLayer* made = data->CreateLayer(layer.name, &metres, wkbUnknown, const_cast<char**>(options));
      need(made != nullptr);
      for (const Field& field : layer.fields) {
        OGRFieldDefn definition(field.name, type_of(field.type));
        need(made->CreateField(&definition) == OGRERR_NONE);
      }
      layers.push_back(made);
    }
  }

  void add(const Row& row) {
    OGRLayer* layer = layers[row.layer];
    OGRFeature feature(layer->GetLayerDefn());
    for (std::size_t k = 0; k < row.values.size(); ++k) set(feature, static_cast<int>(k), row.values[k]);
    OGRGeometry* shape = nullptr;
    need(OGRGeometryFactory::createFromWkb(row.wkb.data(), nullptr, &shape, row.wkb.size()) == OGRERR_NONE);
    feature.SetGeometryDirectly(shape);
    need(layer->CreateFeature(&feature) == OGRERR_NONE);
  }

  static void set(OGRFeature& feature, int field, const Value& value) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) {
      feature.SetField(field, static_cast<GIntBig>(*number));
    } else if (const auto* real = std::get_if<double>(&value)) {
      feature.SetField(field, *real);
    } else {
      feature.SetField(field, std::get<std::string>(value).c_str());
    }
  }
};

GeoPackage::GeoPackage(const std::filesystem::path& path, const std::string& provenance)
    : inside_(std::make_unique<Inside>()) {
  register_gdal_once();
  inside_->path = path;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  inside_->need(driver != nullptr);
  inside_->data.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  inside_->need(inside_->data != nullptr);
  inside_->need(inside_->data->SetMetadataItem("EXACTVO_PROVENANCE", provenance.c_str()) == CE_None);
  inside_->create_layers();
  inside_->need(inside_->data->StartTransaction() == OGRERR_NONE);
}

GeoPackage::~GeoPackage() = default;

void GeoPackage::add(std::string_view rows) {
  while (!rows.empty()) {
    inside_->add(read_row(rows));
    if (++inside_->uncommitted < kRowsOfTransaction) continue;
    inside_->need(inside_->data->CommitTransaction() == OGRERR_NONE);
    inside_->need(inside_->data->StartTransaction() == OGRERR_NONE);
    inside_->uncommitted = 0;
  }
}

void GeoPackage::finish() {
  inside_->need(inside_->data->CommitTransaction() == OGRERR_NONE);
  inside_->data->FlushCache();
  inside_->data.reset();
  inside_->need(true);
  sync_file(inside_->path);
}

}  // namespace exactvo::datasets::batch
