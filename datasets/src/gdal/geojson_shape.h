// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// GDAL gives no geometry, or one with parts missing, where GeoJSON's coordinates are malformed, and says nothing: an
/// obstacle would vanish. What the text holds is therefore looked at here, by RFC 7946, section 3.1.

#include <optional>
#include <string>

#include "exactvo/datasets/obstacle_file.h"
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

}  // namespace exactvo::datasets
