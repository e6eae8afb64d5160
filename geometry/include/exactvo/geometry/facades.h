// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Division of an obstacle into facades (paper, Section III.B, Fig. 2): a set of line segments that stands for it.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// How an obstacle is divided.
struct FacadeOptions {
  /// m, >= 0. Vertices are dropped while the facades stay within this distance of the obstacle; 0 keeps every corner
  /// (collinear vertices are still merged).
  double tolerance = 0.0;
};

/// A facade set and what was certified of it.
struct FacadeSet {
  std::vector<Segment> facades;  ///< m, of all rings and chains
  /// m; every point of the obstacle's boundary lies within this distance of the facades: certified (rounded up), and
  /// every point of a facade lies within it of the obstacle.
  double deviation = 0.0;
};

/// Splits an obstacle at its corners. With tolerance 0 this is exact: the facades' union is the obstacle's boundary.
///
/// With a tolerance, CGAL's Polyline_simplification_2 chooses which corners go, so that facades of rings that kept
/// apart do not cross each other; every choice is then certified, and a corner comes back where the bound does not
/// hold. A wall that crosses itself and rings that touch are thinned by Douglas and Peucker's rule instead.
///
/// A ring's facades follow each other from its lexicographically least corner, an open chain's from its first point.
/// Deterministic. REQUIRES: every ring and chain has a point, all finite; tolerance finite and >= 0.
///
/// Properties: (1) deviation <= tolerance; (2) every end of a facade is a vertex of the obstacle; (3) where a ring
/// starts does not matter.
FacadeSet divide_into_facades(const Obstacle& obstacle, const FacadeOptions& options = {});

}  // namespace exactvo::geometry
