// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles to files, in metres. A file appears whole or not at all (atomic_file.h).
///
/// | format | extension | loses |
/// | --- | --- | --- |
/// | wkt | .wkt | ids |
/// | geojson | .geojson, .json | nothing |
/// | gpkg | .gpkg | nothing; GeoPackage with one layer, `obstacles`; by GDAL |
/// | fgb | .fgb | nothing; FlatGeobuf; by GDAL |
/// | csv | .csv | nothing; columns id and WKT, which QGIS and GDAL read |
/// | rings-json | (by name) | ids; one polygon a file, no walls |
/// | menge-xml | .xml (by name) | ids, holes |
/// | sumo-poly | .poly.xml | holes |
///
/// Properties (tests quote the numbers):
///  (1) read_obstacles gives back the same shapes, bit for bit and in the same order, but for what is lost;
///  (2) what is lost is named in the answer;
///  (3) the same obstacles give the same bytes.

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// One geometry a line; rings closed. WKT holds no ids.
std::string to_wkt(const std::vector<formation::SceneObstacle>& obstacles);

/// A FeatureCollection with `"units": "m"`; ids become the property `id`.
std::string to_geojson(const std::vector<formation::SceneObstacle>& obstacles);

/// The names above that this build writes.
std::vector<std::string> writable_formats();

/// `format`, or where that is empty what the extension says, whatever its case. Throws DataError: E_OPTION for an
/// unknown name, E_FORMAT_UNKNOWN for an extension that says nothing. To be asked before the work.
std::string format_to_write(const std::filesystem::path& path, const std::string& format = {});

/// Whole or not at all. Returns what the format could not hold, a line each ("3 holes dropped: ..."). Throws DataError
/// as `format_to_write`, E_COUNT where the format holds less than there is, E_FORMAT_UNAVAILABLE without GDAL.
std::vector<std::string> write_obstacles(const std::filesystem::path& path,
                                         const std::vector<formation::SceneObstacle>& obstacles,
                                         const std::string& format = {});

}  // namespace exactvo::datasets
