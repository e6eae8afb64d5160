// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The records of a GeoJSON file one by one: the features of a collection, what the file holds alone, or a sequence of
/// features or geometries, on lines of their own or not, or begun by RS (RFC 8142). GDAL is not asked: of coordinates
/// that it cannot make out, and of lines, it leaves things out without a word. What other programs write beyond JSON
/// is taken: NaN and Infinity as null, bytes that are no UTF-8 as question marks, control characters within strings.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "exactvo/datasets/data_error.h"
#include "gdal/degree_box.h"
#include "gdal/geojson_geometry.h"
#include "json/json_text.h"

namespace exactvo::datasets {

/// A feature or a geometry, unless it has a fault.
struct GeoJsonRecord {
  std::size_t number = 0;
  std::string place;  ///< "feature 3"; of a sequence "line 3", or "line 3, column 70" behind another record
  const Json& json;   ///< while it is taken
  std::optional<DataError> fault{};  ///< E_JSON_SYNTAX, E_FORMAT_SYNTAX, E_SIZE, ...
};

/// A sequence whose first line is malformed is one by its name alone.
bool is_sequence_name(const std::filesystem::path& path);

using TakeRecord = std::function<void(const GeoJsonRecord&)>;

class GeoJsonFile {
 public:
  /// Looks through the file once, in the memory of its largest record. Throws DataError: E_JSON_SYNTAX, with line and
  /// column, E_NUMBER, E_NESTING, E_SIZE, and E_FORMAT_SYNTAX where it is no GeoJSON.
  explicit GeoJsonFile(const std::filesystem::path& path);

  /// The members of the outermost object, without a collection's features; of a sequence none.
  const Json& members() const { return members_; }
  /// The box of the rings and lines of a collection, its numbers taken for degrees.
  const std::optional<DegreeBox>& box() const { return box_; }
  /// Throws as the constructor does, if the file has changed.
  void for_each(const TakeRecord& take) const;

 private:
  void take_feature(std::size_t number, const Json& json, const std::optional<GeoJsonFault>& fault,
                    const TakeRecord& take) const;

  std::filesystem::path path_;
  Json members_;
  enum class Layout { collection, one_record, sequence } layout_ = Layout::sequence;
  bool begins_with_record_ = false;
  std::optional<DegreeBox> box_;
};

}  // namespace exactvo::datasets
