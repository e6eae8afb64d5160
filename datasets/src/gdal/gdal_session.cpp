// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/gdal_session.h"

#include <cpl_conv.h>

#include <mutex>
#include <string_view>
#include <utility>

namespace exactvo::datasets {
namespace {

const char* const kDrivers[] = {
    "GeoJSON", "GeoJSONSeq", "TopoJSON", "ESRI Shapefile", "GPKG",   "FlatGeobuf", "CSV", "OSM", "DXF",
    "KML",     "GML",        "GPX",      "MapInfo File",   "SQLite", nullptr};

/// NATIVE_DATA keeps the members of a GeoJSON collection that GDAL has no place for, `units` among them.
const char* const kGeoJsonOptions[] = {"NATIVE_DATA=YES", nullptr};
/// What people call a column of WKT.
const char* const kCsvOptions[] = {"GEOM_POSSIBLE_NAMES=WKT,wkt,geometry,geom,the_geom,wkt_geom", nullptr};
const char* const kNoOptions[] = {nullptr};

/// A driver warns of options that it does not know.
const char* const* options_for(GDALDriverH driver) {
  const std::string name = driver == nullptr ? "" : GDALGetDriverShortName(driver);
  if (name == "CSV") return kCsvOptions;
  return name == "GeoJSON" ? kGeoJsonOptions : kNoOptions;
}

}  // namespace

void register_gdal_once() {
  static std::once_flag done;
  std::call_once(done, [] { GDALAllRegister(); });
}

GdalComplaints::GdalComplaints() {
  CPLPushErrorHandlerEx(&GdalComplaints::hear, this);
}

GdalComplaints::~GdalComplaints() {
  CPLPopErrorHandler();
}

void CPL_STDCALL GdalComplaints::hear(CPLErr severity, CPLErrorNum, const char* words) {
  auto& self = *static_cast<GdalComplaints*>(CPLGetErrorHandlerUserData());
  if (severity == CE_Failure) {
    std::string& first = std::string_view(words).rfind("Invalid ", 0) == 0 ? self.malformed_ : self.failure_;
    if (first.empty()) first = words;
  }
  if (severity == CE_Warning) self.warnings_.emplace_back(words);
}

std::string GdalComplaints::take_failure() {
  const std::string malformed = take_malformed();
  const std::string failure = std::exchange(failure_, {});
  return failure.empty() ? malformed : failure;
}

std::string GdalComplaints::take_malformed() {
  return std::exchange(malformed_, {});
}

std::vector<std::string> GdalComplaints::take_warnings() {
  return std::exchange(warnings_, {});
}

std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path) {
  register_gdal_once();
  const GDALDriverH driver = GDALIdentifyDriverEx(path.c_str(), GDAL_OF_VECTOR, kDrivers, nullptr);
  return std::unique_ptr<GDALDataset>(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers, options_for(driver), nullptr));
}

}  // namespace exactvo::datasets
