// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The obstacles of a scene by place: how near a motion comes to any of them, by looking at the edges round it alone.
/// The same doubles as distance.h gives, obstacle by obstacle. Questions are exact where they are there.

#include <vector>

#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

class ObstacleIndex {
 public:
  void add(const Obstacle& obstacle);
  /// Call once, after the last `add`.
  void build();

  /// The least of `swept_distance` to any obstacle, m, where that is less than `enough`; else some number that is not.
  double swept_distance(const Segment& path, double enough) const;

 private:
  /// A polygon's edges by the stretch of y that they cross.
  struct Strips {
    Box box;
    std::uint32_t first_edge = 0, last_edge = 0;  ///< of `edges_`
    double height = 1.0;                          ///< m
    std::vector<std::uint32_t> start, item;
  };

  Strips strips_of(std::size_t first_edge, std::size_t last_edge) const;
  bool is_inside(const Strips& polygon, Vec2 x) const;
  /// The least distance to an edge, where that is less than `enough`.
  template <class Query>
  double edge_distance(const Query& query, const Box& round, double enough) const;

  std::vector<Segment> edges_;
  std::vector<std::uint32_t> obstacle_of_;  ///< of each edge
  std::uint32_t obstacles_ = 0;
  std::vector<Strips> polygons_;
  BoxGrid edges_by_place_;
  BoxGrid polygons_by_place_;
};

}  // namespace exactvo::geometry
