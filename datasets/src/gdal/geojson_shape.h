// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// GDAL gives no geometry, or one with parts missing, where GeoJSON's coordinates are malformed, and says nothing: an
/// obstacle would vanish. What the text holds is therefore looked at here, by RFC 7946, section 3.1.

#include <filesystem>
#include <optional>
#include <string>

#include "json_text.h"

namespace exactvo::datasets {

struct GeoJsonFault {
  std::string pointer;  ///< JSON pointer within the record
  std::string found;
  std::string expected;
};

/// The first fault of a feature's geometry, or of a geometry that stands alone. None where there is no geometry, or an
/// empty one; points are not looked at: they are no obstacles.
std::optional<GeoJsonFault> geojson_fault(const Json& record);

/// The same of text. What does not parse (GDAL takes NaN and Infinity) is a fault only where coordinates were not
/// `read`.
std::optional<GeoJsonFault> geojson_fault(const std::string& record, bool read);

/// ", /geometry/coordinates/0" or "", to be put behind the record's place.
std::string place_within(const GeoJsonFault& fault);

/// Throws DataError (E_FORMAT_SYNTAX) for the first faulty record of a file of lines, or of records begun by RS (RFC
/// 8142), and for a record that is neither feature nor geometry: GDAL leaves those out.
void refuse_faulty_records(const std::filesystem::path& path);

}  // namespace exactvo::datasets
