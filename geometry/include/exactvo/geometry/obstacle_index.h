// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One obstacle, prepared for many distances: its edges by place, and for each height those that cross it. The same
/// doubles as distance.h gives. Questions are exact where they are there.

#include <cstdint>
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

  /// `swept_distance` to the obstacle, m, where that is less than `enough`; else some number that is not.
  double swept_distance(const Segment& path, double enough) const;

 private:
  void make_strips();
  std::size_t strip_at(double y) const;
  bool is_inside(Vec2 x) const;
  /// The least distance to an edge, where that is less than `enough`.
  double edge_distance(const Segment& path, double enough) const;
  double signed_distance(Vec2 x, bool inside) const;

  std::vector<Segment> edges_;
  Box box_;
  double largest_ = 0.0;  ///< m, coordinate
  BoxGrid edges_by_place_;
  // Of a polygon: strips of equal height, each with the edges that cross it. Few enough to list no edge too often.
  double height_ = 1.0;  ///< m
  std::vector<std::uint32_t> start_, item_;
};

}  // namespace exactvo::geometry
