// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A GeoJSON sequence: features or geometries one after the other, on lines of their own or not, or begun by RS (RFC
/// 8142). GDAL's driver leaves a malformed line out, or refuses the whole file for the first one; here each is told by
/// its line, and the others are read. The geometries themselves are GDAL's to make.

#include <ogr_geometry.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "exactvo/datasets/data_error.h"
#include "gdal/geojson_scan.h"
#include "gdal/geojson_shape.h"

namespace exactvo::datasets {

struct GeoJsonRecord {
  std::string place;                   ///< "line 3", or "line 3, column 70" behind another: where it begins
  std::unique_ptr<OGRGeometry> shape;  ///< none for a feature without one, and for a fault
  std::optional<DataError> fault;      ///< E_JSON_SYNTAX, E_FORMAT_SYNTAX, E_SIZE
  GeoJsonText text{};                  ///< of one without a fault
};

struct GeoJsonPlace {
  std::size_t line = 1;
  std::size_t column = 1;  ///< beyond 1 only behind another record
};

class GeoJsonSequence {
 public:
  /// `path` is that of a file that can be read.
  explicit GeoJsonSequence(const std::filesystem::path& path);

  /// The next record that is not blank; none at the end. Memory is that of one record.
  std::optional<GeoJsonRecord> next();

 private:
  int take_byte();
  void begin_record();
  std::string next_text();
  bool ends_line(const JsonNesting& nesting) const;

  std::string name_;
  std::ifstream file_;
  bool has_separators_ = false;  ///< RS before each record
  bool spans_lines_ = false;     ///< the first one does: then only the end of an object ends a record
  std::size_t line_ = 1;         ///< of the next byte
  std::size_t column_ = 1;       ///< of the next byte
  std::size_t bytes_ = 0;        ///< taken
  GeoJsonPlace begin_;           ///< of the record that was read last
  bool is_spoilt_ = false;       ///< more than white space follows its object, which GDAL's parser skips
  bool has_begun_ = false;       ///< some record was read
};

}  // namespace exactvo::datasets
