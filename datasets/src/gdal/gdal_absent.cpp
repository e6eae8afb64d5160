// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/data_error.h"
#include "gdal/vector_library.h"

namespace exactvo::datasets {

void read_vector_file(const std::filesystem::path& path, Collector&) {
  throw DataError(DataCode::format_unavailable, path.string(), "",
                  "a vector file, and this build is without GDAL, which reads them",
                  "a build with EXACTVO_WITH_GDAL=ON, or plain WKT");
}

void read_in_system(int srid, const std::function<void(Collector&)>&, Collector& out) {
  throw DataError(
      DataCode::format_unavailable, out.file(), "",
      "SRID=" + std::to_string(srid) + ", a reference system, and this build is without GDAL, which knows them",
      "a build with EXACTVO_WITH_GDAL=ON, or metres");
}

Written to_gdal_file(const Obstacles&, const WriteOptions&, const std::string& driver, const std::string& file) {
  throw DataError(DataCode::format_unavailable, file, "", "a file that needs GDAL's driver " + driver,
                  "a build with EXACTVO_WITH_GDAL=ON, or another format");
}

PlaneTransform make_plane_transform(LocalPlane, std::string file) {
  throw DataError(DataCode::format_unavailable, file, "",
                  "metres to be brought to longitude and latitude, without GDAL",
                  "a build with EXACTVO_WITH_GDAL=ON, another format, or GeoJSON in metres");
}

GreyImage read_gdal_image(const std::filesystem::path& path) {
  throw DataError(DataCode::format_unavailable, path.string(), "", "a picture that needs GDAL",
                  "a build with EXACTVO_WITH_GDAL=ON, or PGM");
}

void read_jupedsim_sqlite_file(const std::filesystem::path& path, const SqliteTrajectories&) {
  throw DataError(DataCode::format_unavailable, path.string(), "",
                  "an SQLite file, and this build is without SQLite, which comes with GDAL",
                  "a build with EXACTVO_WITH_GDAL=ON, or JuPedSim's text");
}

std::unique_ptr<batch::GeoPackage> batch::make_geopackage(const std::filesystem::path& path, const std::string&) {
  throw DataError(DataCode::format_unavailable, path.string(), "", "a GeoPackage to write",
                  "a build with EXACTVO_WITH_GDAL=ON, or GeoJSON alone");
}

}  // namespace exactvo::datasets
