// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Things by the square cells that they are in, wherever they are: memory grows with their number, not with how far
/// apart they are.

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::detail {

/// Numbers of the type `Number` by cell.
template <class Number>
class Cells {
 public:
  /// `side`: m, > 0.
  explicit Cells(double side) : side_(side) {}

  void add(geometry::Vec2 place, Number number) { lists_[cell_of(place)].push_back(number); }
  /// Into every cell of the box.
  void add(const geometry::Box& box, Number number) {
    for_each_cell(box, [&](const Cell& cell) { lists_[cell].push_back(number); });
  }
  /// Calls visit(number) for every entry of a cell that meets the box; for some more than once.
  template <class Visit>
  void for_each_in(const geometry::Box& box, const Visit& visit) const {
    for_each_cell(box, [&](const Cell& cell) {
      const auto found = lists_.find(cell);
      if (found == lists_.end()) return;
      for (const Number number : found->second) visit(number);
    });
  }
  /// The same; of each cell the entry that was added last comes first.
  template <class Visit>
  void for_each_in_latest_first(const geometry::Box& box, const Visit& visit) const {
    for_each_cell(box, [&](const Cell& cell) {
      const auto found = lists_.find(cell);
      if (found == lists_.end()) return;
      for (auto entry = found->second.rbegin(); entry != found->second.rend(); ++entry) visit(*entry);
    });
  }
  /// As `for_each_in`, of cells about a place.
  template <class Visit>
  void for_each_about(geometry::Vec2 here, double reach, const Visit& visit) const {
    for_each_in(geometry::Box{here, here}.grown(reach), visit);
  }

 private:
  using Cell = std::pair<std::int64_t, std::int64_t>;
  /// What lies beyond the numbers of cells shares the outermost.
  std::int64_t number(double x) const {
    constexpr double kFarthest = 0x1p62;
    return static_cast<std::int64_t>(std::clamp(std::floor(x / side_), -kFarthest, kFarthest));
  }
  Cell cell_of(geometry::Vec2 p) const { return {number(p.x), number(p.y)}; }
  template <class Visit>
  void for_each_cell(const geometry::Box& box, const Visit& visit) const {
    const auto [low_x, low_y] = cell_of(box.low);
    const auto [high_x, high_y] = cell_of(box.high);
    for (std::int64_t y = low_y; y <= high_y; ++y)
      for (std::int64_t x = low_x; x <= high_x; ++x) visit(Cell{x, y});
  }

  double side_;
  std::unordered_map<Cell, std::vector<Number>, boost::hash<Cell>> lists_;
};

}  // namespace exactvo::formation::detail
