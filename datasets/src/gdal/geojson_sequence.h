// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The records of GeoJSON one by one. GDAL gives no geometry, or one with parts missing, where coordinates are
/// malformed, and says nothing: an obstacle would vanish. What the text holds is therefore looked at here, by RFC 7946,
/// section 3.1.
///
/// And sequences: features or geometries one after the other, on lines of their own or not, or begun by RS (RFC 8142).
/// GDAL's driver leaves a malformed line out, or refuses the whole file for the first one; here each is told by its
/// line, and the others are read. The geometries themselves are GDAL's to make.

#include <ogr_geometry.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/obstacle_file.h"
#include "gdal/geojson_scan.h"
#include "json/json_text.h"

namespace exactvo::datasets {

struct GeoJsonFault {
  std::string pointer;  ///< JSON pointer within the record
  std::string found;
  std::string expected;
};

/// The text of a feature, or of a geometry that stands alone, parsed once.
class GeoJsonText {
 public:
  GeoJsonText() = default;
  explicit GeoJsonText(std::string text);

  /// The first fault of its geometry. None where there is no geometry, or an empty one. A point is no obstacle, but a
  /// malformed one may have been meant for something else. What does not parse (GDAL takes NaN and Infinity) is a fault
  /// only where coordinates were not `read`.
  std::optional<GeoJsonFault> fault(bool read) const;
  /// The same of a record of a sequence, which is a feature or a geometry. None where the text does not parse.
  std::optional<GeoJsonFault> fault_as_record() const;
  /// Byte for byte but for white space; nothing of what is no feature or no JSON.
  FeatureProperties properties() const;

 private:
  std::string text_;
  Json json_;             ///< discarded where the text is no JSON
  bool is_utf8_ = false;  ///< else every byte beyond ASCII has become a question mark in `json_`
};

/// Whether a member "type" says that it is of a feature or a geometry.
bool is_type_of_record(const std::string& type);

/// ", /geometry/coordinates/0" or "", to be put behind the record's place.
std::string place_within(const GeoJsonFault& fault);

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
