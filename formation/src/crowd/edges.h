// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Static edges by place: every cell of a grid lists all edges within reach of any of its points, so that a robot asks
/// one cell.

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

  /// Where in `items` the edges of p's cell stand: all within reach of p, and some beyond.
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

}  // namespace exactvo::formation::crowd
