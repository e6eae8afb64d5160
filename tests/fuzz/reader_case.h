// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One case of the readers' fuzz targets and of their corpus: bytes as a file of a format, and what must hold.

#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::datasets::test {

/// The formats that have a target, and the extension of a case.
struct FuzzedFormat {
  /// The name of target and corpus; "scenario" reads a scenario, "trajectories" a file whose format is chosen by its
  /// content, "recording" and "crowd-recording" runs, and all others obstacles.
  const char* name;
  const char* extension;
  const char* reader = nullptr;  ///< of `readable_formats()`; that of `name` where none is said
};
const std::vector<FuzzedFormat>& fuzzed_formats();

/// Reads `bytes` from a file in `folder`. A case of "ros-map" is the yaml, a line "%picture%", and the bytes of the
/// picture, which is named map.pgm, map.png and map.bmp at once; after a line "%obstacles%" of a "scenario" stands what
/// obstacles.wkt, .geojson, .geojsonl and .csv hold. Empty if all is well: obstacles that are valid and
/// books that balance, rows that rise in time, or a DataError with a code; else what went wrong.
std::string read_case(const std::string& format, const std::string& bytes, const std::filesystem::path& folder);

}  // namespace exactvo::datasets::test
