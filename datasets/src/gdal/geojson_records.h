// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The features and geometries of a GeoJSON file: of a collection, of a sequence (one after the other, on lines of
/// their own or not, or begun by RS, RFC 8142), or the one that is the whole file. GDAL's driver skips entries of a
/// collection that are no objects and malformed lines, follows links to the network, and keeps no more than it has a
/// place for; here each record is told by its place, and the others are read. The geometries themselves are GDAL's to
/// make.

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
  std::size_t number = 0;                ///< among the features, from 0
  std::string place{};                   ///< "feature 2"; of a sequence "line 3", or "line 3, column 70" behind another
  std::unique_ptr<OGRGeometry> shape{};  ///< none for a feature without one, and for a fault
  std::optional<DataError> fault{};      ///< E_JSON_SYNTAX, E_FORMAT_SYNTAX, E_SIZE
  GeoJsonText text{};                    ///< of one without a fault
};

class GeoJsonRecords {
 public:
  /// `path` is that of a file that can be read. `is_sequence`: it is one, whatever it holds; else it is one if it holds
  /// several records, or several objects where `name_says_sequence`. Throws DataError: E_JSON_SYNTAX where it is no
  /// JSON, E_FORMAT_SYNTAX for a collection without features, E_SIZE.
  GeoJsonRecords(const std::filesystem::path& path, bool is_sequence, bool name_says_sequence);

  bool is_sequence() const { return kind_ == Kind::sequence; }
  /// By its member "type".
  bool is_geojson() const { return is_sequence() || is_geojson_; }
  /// What a collection has beside its features; null of other files.
  const Json& members() const { return kind_ == Kind::collection ? head_ : none_; }
  /// What the file says of its reference system, WGS 84 where it says nothing. Throws DataError (E_PROJECTION) for a
  /// link to one, which is not followed.
  OGRSpatialReference reference_system() const;

  /// The next record that is not blank; none at the end. Memory is that of one record. Throws DataError where a
  /// collection is no JSON (E_JSON_SYNTAX) or parsing a feature would take more memory than a reader may (E_SIZE).
  std::optional<GeoJsonRecord> next();
  /// To the first one.
  void rewind();

 private:
  enum class Kind { sequence, collection, alone };

  std::optional<GeoJsonRecord> next_of_sequence();
  std::optional<GeoJsonRecord> next_of_collection();
  void fill(GeoJsonRecord& record, const std::string& text, bool is_spoilt) const;
  DataError syntax_fault(const GeoJsonRecord& record, const std::string& text) const;
  int take_byte();
  void begin_record();
  std::string next_text();
  std::string next_entry();
  bool ends_line(const JsonNesting& nesting) const;

  std::filesystem::path path_;
  std::string name_;
  Kind kind_ = Kind::sequence;
  bool is_geojson_ = false;
  std::string text_;  ///< of a record that is alone
  Json head_, none_;  ///< null of a sequence
  std::ifstream file_;
  bool has_separators_ = false;   ///< RS before each record
  bool spans_lines_ = false;      ///< the first one does: then only the end of an object ends a record
  std::size_t line_ = 1;          ///< of the next byte
  std::size_t column_ = 1;        ///< of the next byte
  std::size_t bytes_ = 0;         ///< taken
  std::size_t begin_line_ = 1;    ///< of the record that was read last
  std::size_t begin_column_ = 1;  ///< beyond 1 only behind another record
  bool is_spoilt_ = false;        ///< more than white space follows its object, which GDAL's parser skips
  JsonMembers members_;           ///< up to the next byte of a collection
  std::size_t records_ = 0;       ///< given, but for entries that are no objects
  std::size_t entries_ = 0;       ///< of a collection, given
};

}  // namespace exactvo::datasets
