// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal_session.h"

#include <cpl_conv.h>

#include <mutex>
#include <utility>

#include "exactvo/datasets/obstacle_file.h"
#include "gdal_facts.h"

namespace exactvo::datasets {
namespace {

const char* const kDrivers[] = {
    "GeoJSON", "GeoJSONSeq", "TopoJSON", "ESRI Shapefile", "GPKG",   "FlatGeobuf", "CSV", "OSM", "DXF",
    "KML",     "GML",        "GPX",      "MapInfo File",   "SQLite", nullptr};

/// NATIVE_DATA keeps the members of a GeoJSON collection that GDAL has no place for, `units` among them; the names are
/// what people call a column of WKT.
const char* const kOpenOptions[] = {"NATIVE_DATA=YES", "GEOM_POSSIBLE_NAMES=WKT,wkt,geometry,geom,the_geom,wkt_geom",
                                    "KEEP_GEOM_COLUMNS=NO", nullptr};

void register_drivers_once() {
  static std::once_flag done;
  std::call_once(done, [] { GDALAllRegister(); });
}

}  // namespace

std::string gdal_release() {
  return GDALVersionInfo("RELEASE_NAME");
}

bool built_with_gdal() {
  return true;
}

GdalComplaints::GdalComplaints() {
  CPLPushErrorHandlerEx(&GdalComplaints::hear, this);
}

GdalComplaints::~GdalComplaints() {
  CPLPopErrorHandler();
}

void CPL_STDCALL GdalComplaints::hear(CPLErr severity, CPLErrorNum, const char* words) {
  auto& self = *static_cast<GdalComplaints*>(CPLGetErrorHandlerUserData());
  if (severity == CE_Failure && self.failure_.empty()) self.failure_ = words;
  if (severity == CE_Warning) self.warnings_.emplace_back(words);
}

std::string GdalComplaints::take_failure() {
  return std::exchange(failure_, {});
}

std::vector<std::string> GdalComplaints::take_warnings() {
  return std::exchange(warnings_, {});
}

std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path) {
  register_drivers_once();
  // Options that one driver does not know are no reason for a warning.
  return std::unique_ptr<GDALDataset>(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers, kOpenOptions, nullptr));
}

}  // namespace exactvo::datasets
