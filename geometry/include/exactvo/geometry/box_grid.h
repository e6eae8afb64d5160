// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Boxes looked up by place: a uniform grid that lists in each cell the boxes that meet it. Built once for what stands
/// still; a query allocates nothing. Exact: every box that is near enough is found, each once.

#include <cstdint>
#include <vector>

#include "exactvo/geometry/box.h"

namespace exactvo::geometry {

/// Boxes by number, in the order in which they were given.
class BoxGrid {
 public:
  BoxGrid() = default;
  /// REQUIRES: no box is empty, all finite.
  explicit BoxGrid(std::vector<Box> boxes);

  /// How many boxes there are.
  std::size_t size() const { return boxes_.size(); }
  /// Box number i. REQUIRES: i < size().
  const Box& box(std::size_t i) const { return boxes_[i]; }

  /// Calls visit(i) for every box whose `distance_below` from x is at most `reach` (m, may be infinite), in an order
  /// that depends on the boxes alone.
  template <class Visit>
  void for_each_within(Vec2 x, double reach, const Visit& visit) const {
    const Cells asked = cells_of(window_round(x, reach));
    for_each_in(asked, [&](std::size_t i) {
      if (distance_below(boxes_[i], x) <= reach) visit(i);
    });
  }

  /// Calls visit(i) for every box that meets `window`.
  template <class Visit>
  void for_each_meeting(const Box& window, const Visit& visit) const {
    for_each_in(cells_of(window), [&](std::size_t i) {
      if (meet(boxes_[i], window)) visit(i);
    });
  }

 private:
  /// Columns and rows from `first` to `last`, both included.
  struct Cells {
    std::int32_t first_x = 0, first_y = 0, last_x = -1, last_y = -1;
  };
  Cells cells_of(const Box& box) const;
  /// Holds every point whose `distance_below` from x can be at most `reach`.
  static Box window_round(Vec2 x, double reach);

  /// A box that several cells list is visited in the first of those in `asked`.
  template <class Visit>
  void for_each_in(const Cells& asked, const Visit& visit) const {
    for (const std::uint32_t i : large_) visit(i);
    for (std::int32_t y = asked.first_y; y <= asked.last_y; ++y) {
      for (std::int32_t x = asked.first_x; x <= asked.last_x; ++x) {
        const std::size_t cell =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
        for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k) {
          const Cells& own = cells_[item_[k]];
          if (x == std::max(own.first_x, asked.first_x) && y == std::max(own.first_y, asked.first_y)) visit(item_[k]);
        }
      }
    }
  }

  std::vector<Box> boxes_;
  std::vector<Cells> cells_;
  Box extent_;
  double side_ = 1.0;  ///< m
  std::int32_t columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> start_;  ///< of a cell in `item_`
  std::vector<std::uint32_t> item_;
  std::vector<std::uint32_t> large_;  ///< items in this many cells that every query checks them
};

}  // namespace exactvo::geometry
