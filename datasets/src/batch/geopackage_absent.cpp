// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/geopackage.h"
#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets::batch {

struct GeoPackage::Inside {};

GeoPackage::GeoPackage(const std::filesystem::path& path, const std::string&) {
  throw DataError(DataCode::format_unavailable, path.string(), "", "a GeoPackage to write",
                  "a build with EXACTVO_WITH_GDAL=ON, or GeoJSON alone");
}

GeoPackage::~GeoPackage() = default;
void GeoPackage::add(std::string_view) {}
void GeoPackage::finish() {}

}  // namespace exactvo::datasets::batch
