// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Division of an obstacle into facades (paper, Section III.B, Fig. 2): a set of line segments that stands for it.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

struct FacadeOptions {
  /// m, >= 0. Vertices are dropped while the facades stay within this distance of the obstacle; 0 keeps every corner
  /// (collinear vertices are still merged).
  double tolerance = 0.0;
};

/// A facade set and what was certified of it.
struct FacadeSet {
  std::vector<Segment> facades;
  /// m; every point of the obstacle's boundary lies within this distance of the facades: certified (rounded up), and
  /// every point of a facade lies within it of the obstacle.
  double deviation = 0.0;
};

/// Splits an obstacle at its corners, after CGAL's Polyline_simplification_2 where a tolerance is given.
FacadeSet divide_into_facades(const Obstacle& obstacle, const FacadeOptions& options = {});

}  // namespace exactvo::geometry
