// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One obstacle, prepared for many distances: its edges by place. The same doubles as distance.h gives. Questions that
/// are exact there are exact here.

#include <vector>

#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// The edges of one obstacle, looked up by place.
class ObstacleIndex {
 public:
  /// O(n log n). REQUIRES: finite coordinates.
  explicit ObstacleIndex(const Obstacle& obstacle);

  /// The box of all edges.
  const Box& box() const { return box_; }

  /// `swept_distance` to the obstacle, m, where that is less than `enough`; else any number that is not less.
  double swept_distance(const Segment& path, double enough) const;

 private:
  bool is_inside(Vec2 x) const;
  /// The least distance to an edge, where that is less than `enough`.
  double edge_distance(const Segment& path, double enough) const;
  double signed_distance(Vec2 x, bool inside) const;

  std::vector<Segment> edges_;
  bool has_interior_;
  Box box_;
  double largest_ = 0.0;  ///< m, coordinate
  BoxGrid edges_by_place_;
};

}  // namespace exactvo::geometry
