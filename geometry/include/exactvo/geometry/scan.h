// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Division of range scans and of unordered points into facades. (Polygons and polylines: facades.h.)
///
/// Certified: every hit lies within `deviation` of its facade, and deviation <= tolerance. Heuristic: which hits share
/// a facade, so how many facades there are.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// How a scan is divided.
struct ScanOptions {
  double range_jump = 0.3;   ///< m, > 0; consecutive hits farther apart belong to different walls
  double tolerance = 0.05;   ///< m, >= 0; hits stay within this of their facade
  double merge_turn = 0.15;  ///< rad, in [0, pi]; facades that meet at less are joined while the tolerance holds
};

/// How loose points are divided.
struct PointOptions {
  double neighbour_radius = 0.3;  ///< m, > 0; points this near may belong to the same wall
  double tolerance = 0.05;        ///< m, > 0; points stay within this of their facade
  double normal_angle = 0.44;     ///< rad, in (0, pi/2]; by how much a point's normal may differ from its wall's
  std::size_t least_points = 3;   ///< >= 2; smaller groups are left as single points
};

/// Facades, and which hit belongs to which.
struct DividedPoints {
  std::vector<Segment> facades;                       ///< ends are hits; a lone hit is a facade of length 0
  std::vector<std::optional<std::size_t>> facade_of;  ///< for each hit; nothing where it is not finite
  double deviation = 0.0;                             ///< m; certified
};

/// An ordered scan: cut at range jumps and at hits that are not finite (no return), each run split at its farthest hit
/// (iterative end-point fit) and neighbouring facades merged again (split and merge; Nguyen et al., A comparison of
/// line extraction algorithms using 2D laser rangefinder for indoor mobile robotics, 2005).
DividedPoints divide_scan(const std::vector<Vec2>& hits, const ScanOptions& options = {});

/// Unordered points: CGAL's region growing on normals fitted to each point's neighbours, every region then put in
/// order along its line and split as a scan. Points that are not finite are ignored. Deterministic.
DividedPoints divide_points(const std::vector<Vec2>& points, const PointOptions& options = {});

}  // namespace exactvo::geometry
