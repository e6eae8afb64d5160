// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Fewer segments for a chain of points, with certified distances.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

double largest_coordinate(const std::vector<Vec2>& points);

/// An upper bound of the distance from x to s. `largest` bounds the magnitudes of the coordinates. Certified.
double distance_upper_bound(const Segment& s, Vec2 x, double largest);

/// Douglas and Peucker (1973) between i and j: keeps points until all others are certified within the tolerance of the
/// segments between the kept ones. Returns the largest certified distance. j may be points.size(), which stands for the
/// first point again.
double refine_gap(const std::vector<Vec2>& points, std::vector<bool>& kept, std::size_t i, std::size_t j,
                  double tolerance, double largest);

}  // namespace exactvo::geometry::detail
