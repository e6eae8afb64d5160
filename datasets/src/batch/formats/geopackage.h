// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The GeoPackage of a batch, written row after row by GDAL, without spatial indices: to make them takes SQLite four
/// times as long as all rows. The same rows give the same bytes.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace exactvo::datasets::batch {

class GeoPackage {
 public:
  GeoPackage() = default;
  virtual ~GeoPackage() = default;
  GeoPackage(const GeoPackage&) = delete;
  GeoPackage& operator=(const GeoPackage&) = delete;

  /// Rows as `append_row` (features.h) wrote them.
  virtual void add(std::string_view rows) = 0;
  /// Closes and syncs.
  virtual void finish() = 0;
};

/// Throws DataError (E_FILE_UNWRITABLE; E_FORMAT_UNAVAILABLE in a build without GDAL), as `add` and `finish` do.
/// Called through vector_library.h, except by tests.
std::unique_ptr<GeoPackage> make_geopackage(const std::filesystem::path& path, const std::string& provenance);

}  // namespace exactvo::datasets::batch
