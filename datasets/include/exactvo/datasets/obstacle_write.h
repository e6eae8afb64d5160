// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles to files. A file appears whole or not at all (atomic_file.h).
///
/// | format | extension | loses |
/// | --- | --- | --- |
/// | wkt | .wkt | ids, properties |
/// | geojson | .geojson, .json | nothing; longitude and latitude, or metres on request |
/// | gpkg | .gpkg | nothing; GeoPackage with one layer, `obstacles`; by GDAL |
/// | fgb | .fgb | nothing; FlatGeobuf; by GDAL |
/// | csv | .csv | nothing but types; columns id and WKT, then the properties; QGIS and GDAL read it |
/// | rings-json | (by name) | ids, properties; one polygon a file, no walls |
/// | menge-xml | .xml (by name) | ids, properties, holes |
/// | sumo-poly | .poly.xml | properties, holes |
///
/// Every other program takes GeoJSON's numbers for longitude and latitude (RFC 7946), whatever a member says. They are
/// therefore degrees, on the plane that the metres lie on; one without a place on earth is laid round longitude 0,
/// latitude 0. A member of the collection says how `read_obstacles` comes back to the same metres:
///
///     "local_metres": {"centre": [13.4, 52.5], "offset": [0, 0], "decimals": 3, "is_placed": true}
///
/// is the azimuthal equidistant projection on WGS 84 round `centre`, then `offset` added, m. If `decimals` is there,
/// all metres had this many. `reference_system`, a projected one as WKT, may replace `centre`.
///
/// Properties (tests quote the numbers):
///  (1) read_obstacles gives back the same shapes, bit for bit and in the same order, but for what is lost; through
///      GeoJSON in degrees bit for bit where the metres have at most six decimals, else within 20 nm within 100 km of
///      the centre;
///  (2) what is lost is named in the answer;
///  (3) the same obstacles give the same bytes.

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/local_plane.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// One geometry a line; rings closed. WKT holds no ids.
std::string to_wkt(const std::vector<formation::SceneObstacle>& obstacles);

/// How and with what obstacles are written.
struct WriteOptions {
  std::string format;                           ///< empty: as the extension says
  LocalPlane plane{};                           ///< that their metres lie on
  bool metres = false;                          ///< GeoJSON in metres, with `"units": "m"`: for ExactVO alone
  std::vector<FeatureProperties> properties{};  ///< none, or one an obstacle
};

/// The member "local_metres" of a collection whose metres have this many decimals; below 0: they have more.
std::string local_metres_member(const LocalPlane& plane, int decimals);

/// The names above that this build writes.
std::vector<std::string> writable_formats();

/// `format`, or where that is empty what the extension says, whatever its case. Throws DataError: E_OPTION for an
/// unknown name, E_FORMAT_UNKNOWN for an extension that says nothing. Call it before the work.
std::string format_to_write(const std::filesystem::path& path, const std::string& format = {});

/// Whole or not at all. Returns what the format could not hold, a line each ("3 holes dropped: ..."). Throws DataError
/// as `format_to_write`, E_COUNT where the format holds less than there is, E_FORMAT_UNAVAILABLE without GDAL.
std::vector<std::string> write_obstacles(const std::filesystem::path& path,
                                         const std::vector<formation::SceneObstacle>& obstacles,
                                         const WriteOptions& options = {});

}  // namespace exactvo::datasets
