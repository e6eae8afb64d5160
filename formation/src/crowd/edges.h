// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Static edges: which are near a robot, and half-planes that keep it off them.
///
/// Every cell of a grid lists all edges within reach of any of its points, so that a robot asks one cell. Each edge is
/// a segment of its own, seen from both sides. With a and b its ends seen from the robot, r the radius and h(n) =
/// max(n.a, n.b) + r |n|, the half-plane n.v >= c excludes what meets the edge within the horizon t iff h(n) <= 0 and
/// h(n) <= t c: for any n (docs/guide/velocity-obstacles.md). The best of finitely many n is that at which the velocity
/// is deepest inside; the nearest edge comes first, and an edge that an earlier half-plane provably excludes needs
/// none.

#include <cstdint>
#include <utility>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::formation::crowd {

using geometry::Segment;
using geometry::Vec2;

class EdgeGrid {
 public:
  bool empty() const { return edges_.empty(); }
  const std::vector<Segment>& edges() const { return edges_; }
  void set_edges(std::vector<Segment> edges) { edges_ = std::move(edges); }
  /// Lays the cells out for robots that ask no farther than `reach`, m.
  void lay_out(double reach);
  std::size_t bytes() const;

  /// Calls what(number of an edge) for each within reach of p, and for some beyond.
  template <class Do>
  void for_near(Vec2 p, const Do& what) const {
    const Range cell = near(p);
    for (std::uint32_t k = cell.first; k < cell.last; ++k) what(items_[k]);
  }

  /// Where in `items` the edges of p's cell stand.
  struct Range {
    std::uint32_t first = 0, last = 0;
  };
  Range near(Vec2 p) const {
    const double x = (p.x - low_.x) * per_cell_, y = (p.y - low_.y) * per_cell_;
    if (!(x >= 0.0 && y >= 0.0 && x < columns_ && y < rows_)) return {};
    const auto cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    return {start_[cell], start_[cell + 1]};
  }
  const std::vector<std::uint32_t>& items() const { return items_; }

 private:
  template <class Do>
  void for_cells_of(const Segment& edge, const Do& what) const;
  void order_cells();

  std::vector<Segment> edges_;
  std::vector<std::uint32_t> start_, items_;
  Vec2 low_;
  double cell_ = 1.0, per_cell_ = 1.0, columns_ = 0.0, rows_ = 0.0, reach_ = 0.0;
};

/// The robot that asks for half-planes against edges and bodies.
struct ObstacleQuery {
  std::int32_t x = 0, y = 0;   ///< lattice, of `position`
  Vec2 position, velocity;     ///< m, m/s
  double radius = 0.0;         ///< m
  double still_horizon = 0.0;  ///< s, of edges and bodies at rest
  double horizon = 0.0;        ///< s, of bodies that move
  double max_speed = 0.0;      ///< m/s
  bool float_normals = false;  ///< normals are to be floats
};

/// A half-plane against an edge or a body.
struct ObstacleLine {
  Vec2 normal;                 ///< of the precision asked for
  double offset = 0.0;         ///< m/s, rounded up; <= 0 against what stands still
  std::uint32_t obstacle = 0;  ///< number of the edge or body
  bool touching = false;       ///< the disc meets it, or all but: nothing is promised of an edge
};

/// An edge by its squared distance, m^2, and its place in the grid's items.
using NearEdge = std::pair<double, std::uint32_t>;

/// Half-planes against all edges that can be met within the horizon, nearest first. Certified: a velocity that
/// satisfies them all meets no edge within it that is not touching. `near` is scratch.
void edge_lines(const EdgeGrid& grid, const ObstacleQuery& query, std::vector<NearEdge>& near,
                std::vector<ObstacleLine>& out);

}  // namespace exactvo::formation::crowd
