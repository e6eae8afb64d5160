// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Laser hits and loose points become the cells of a grid that hold them. Every hit lies in a cell (exactly: cells are
/// compared by their rounded corners), and the cells become polygons (grid.h).

#include <vector>

#include "readers/raw_geometry.h"

namespace exactvo::datasets {

inline constexpr double kScanCell = 0.05;  ///< m, where the caller names no cell size

/// A range that means "nothing seen": 0 or less, NaN, or what lasers report beyond their reach (50, 81.83, 81.91 m and
/// more; 32.767 is the largest 16-bit number of millimetres).
bool is_no_return(double range);

struct Pose {
  geometry::Vec2 position;  ///< m
  double heading = 0.0;     ///< rad
};

geometry::Vec2 hit_at(const Pose& laser, double bearing, double range);

/// Finite hits only (std::logic_error otherwise). Refuses hits so far apart that their grid would not fit (E_SIZE).
void add_hits(const std::vector<geometry::Vec2>& hits, Collector& out);

}  // namespace exactvo::datasets
