// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far lengths and areas on a plane are from those on the ground.
///
/// The azimuthal equidistant projection round c keeps distances from c. Across, a place at the distance r is stretched
/// by r / m(r), where the reduced length m of the geodesic from c solves m'' + K m = 0, m(0) = 0, m'(0) = 1, with the
/// Gaussian curvature K. On an ellipsoid of semi-axes a > b it is at most that of the equator, 1 / b^2, so m(r) >=
/// b sin(r / b) (Sturm) and the stretch is at most x / sin x, x = r / b; at least 1, as K > 0. A curve within a disc
/// round c is therefore at least as long on the plane as on the ground and at most x / sin x times that, and areas grow
/// by the same bounds. A disc on the plane is convex, and one of that size on the ground as well, so distances within
/// it have them too.

#include <ogr_spatialref.h>

#include <vector>

#include "exactvo/datasets/obstacle_file.h"

namespace exactvo::datasets {

/// The distortion of the azimuthal equidistant projection within r metres of its centre, on an ellipsoid with the
/// semi-minor axis b, m. Rounded up. REQUIRES: 0 <= r <= b / 2.
Distortion distortion_round_centre(double r, double b);

/// Measured at `places`, degrees, by differences over 100 m in both directions. `to_units`: from degrees on the
/// ellipsoid of `geographic`; `metres_a_unit`: what its results are counted in. Infinite where it fails.
Distortion measured_distortion(OGRCoordinateTransformation& to_units, const OGRSpatialReference& geographic,
                               double metres_a_unit, const std::vector<geometry::Vec2>& places);

/// "lengths and areas are at most 0.002 % larger than on the ground".
std::string words_of(const Distortion& distortion);

/// Two digits, rounded up: "0.0021 %".
std::string percent_text(double share);

}  // namespace exactvo::datasets
