// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where on earth a plane of metres lies, and the way from its metres to longitude and latitude on WGS 84.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets {

/// Longitude and latitude that became (0, 0), degrees.
struct ProjectionOrigin {
  double longitude = 0.0;  ///< east is positive
  double latitude = 0.0;   ///< north is positive
};

/// A plane is azimuthal equidistant round `origin`, of a reference system of its own, or nowhere on earth.
struct LocalPlane {
  std::optional<ProjectionOrigin> origin;  ///< on WGS 84
  std::string reference_system;  ///< WKT of a projected system in metres; empty where `origin` says it or none does
  geometry::Vec2 offset;         ///< m; added after the projection round `origin`

  /// Whether its place on earth is known.
  bool is_placed() const { return origin.has_value() || !reference_system.empty(); }
};

/// How far from its middle a plane without a place on earth may reach, m: there distances on the earth differ from
/// those on the plane by 0.4 %.
inline constexpr double kLargestUnplaced = 1e6;

/// Brings metres to degrees. A plane that is nowhere on earth is laid round longitude 0, latitude 0.
class MetresToDegrees {
 public:
  /// Throws DataError: E_FORMAT_UNAVAILABLE in a build without GDAL, E_PROJECTION for a reference system that PROJ does
  /// not bring to degrees. `file` is what errors name.
  MetresToDegrees(LocalPlane plane, std::string file);
  /// x is longitude, y latitude, rounded to 13 decimals: 5 nm on the ground. The points are one shape: longitudes are
  /// within [-180, 180] where it does not cross the antimeridian, else they go on beyond 180. Throws DataError
  /// (E_PROJECTION) for points without a place, and beyond kLargestUnplaced.
  std::vector<geometry::Vec2> operator()(std::vector<geometry::Vec2> points) const;

 private:
  std::function<std::vector<geometry::Vec2>(std::vector<geometry::Vec2>)> transform_;
};

/// For a plane without a place: an offset that brings `points` near (0, 0), a multiple of 100 km; 0 where they are.
geometry::Vec2 offset_for(geometry::Vec2 low, geometry::Vec2 high);

}  // namespace exactvo::datasets
