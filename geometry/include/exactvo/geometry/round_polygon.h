// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A polygon round a disc, for what takes polygons only: routes, free space, the chains of ORCA.

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// Corners of a polygon round a disc.
inline constexpr int kRoundCorners = 32;

/// Share of the radius: how far corners lie beyond the rim, 1 / cos(pi / 32) - 1, rounded up. Between corners it is
/// less, 0 in the middle of an edge.
inline constexpr double kRoundExcess = 0.00484;

/// The regular polygon of 32 corners whose edges touch the disc, counter-clockwise. Certified: every point of the disc
/// lies in it, decided exactly for the doubles of its vertices; for that it is grown by a few roundings of its
/// coordinates. Corners are no farther from the rim than kRoundExcess of the radius and 2^-46 of the coordinates and
/// the radius. Throws std::invalid_argument where the radius is not above 0, a number is not finite, or the radius is
/// less than 2^-40 of the coordinates: its corners could not be distinguished.
Polygon polygon_round(const Disc& disc);

/// Whether every point of the disc lies in the polygon, of which holes are ignored. Exact; true only for polygons whose
/// edges all have the disc's centre on their left.
bool holds_disc(const Polygon& polygon, const Disc& disc);

}  // namespace exactvo::geometry
