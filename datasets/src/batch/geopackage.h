// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The GeoPackage of a batch, written row after row: GDAL makes the tables (package_schema.h), SQLite takes the rows,
/// and the spatial indices are packed at the end (packed_rtree.h). The same rows give the same bytes.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace exactvo::datasets::batch {

class GeoPackage {
 public:
  /// Throws DataError (E_FILE_UNWRITABLE; E_FORMAT_UNAVAILABLE in a build without GDAL), as the others do.
  GeoPackage(const std::filesystem::path& path, const std::string& provenance);
  ~GeoPackage();
  GeoPackage(const GeoPackage&) = delete;
  GeoPackage& operator=(const GeoPackage&) = delete;

  /// Rows as `append_row` (features.h) wrote them.
  void add(std::string_view rows);
  /// Closes and syncs.
  void finish();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace exactvo::datasets::batch
