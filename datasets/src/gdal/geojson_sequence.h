// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A GeoJSON sequence: a feature or a geometry a line, or records begun by RS (RFC 8142). GDAL's driver leaves a
/// malformed line out, or refuses the whole file for the first one; here each is told by its line, and the others are
/// read. The geometries themselves are GDAL's to make.

#include <ogr_geometry.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

struct GeoJsonRecord {
  std::string place;                   ///< "line 3": where it begins
  std::unique_ptr<OGRGeometry> shape;  ///< none for a feature without one, and for a fault
  std::optional<DataError> fault;      ///< E_JSON_SYNTAX, E_FORMAT_SYNTAX
};

class GeoJsonSequence {
 public:
  /// `path` is that of a file that can be read.
  explicit GeoJsonSequence(const std::filesystem::path& path);

  /// The next record that is not blank; none at the end. Memory is that of one record.
  std::optional<GeoJsonRecord> next();

 private:
  std::string name_;
  std::ifstream file_;
  char separator_ = '\n';
  std::size_t lines_ = 0;  ///< before the next record
};

/// Whether the first line is a feature or a geometry by itself, and more follows: GDAL may take such a file for GeoJSON
/// of one feature, and then says nothing of the rest.
bool begins_as_sequence(const std::filesystem::path& path);

}  // namespace exactvo::datasets
