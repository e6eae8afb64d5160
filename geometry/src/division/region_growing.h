// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Groups of points that lie along lines (CGAL Shape_detection; its interface changes with 5.6, so it is used here
/// alone).

#include <cstddef>
#include <vector>

#include "exactvo/geometry/scan.h"

namespace exactvo::geometry::detail {

/// Disjoint groups of indices, each along a line and in order along it. Points in no group are left out.
/// REQUIRES: at least one point, all finite; options valid.
std::vector<std::vector<std::size_t>> points_along_lines(const std::vector<Vec2>& points, const PointOptions& options);

}  // namespace exactvo::geometry::detail
