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
    for_each_list(box, [&](const std::vector<Number>& list) {
      for (const Number number : list) visit(number);
    });
  }
  /// The same; of each cell the entry that was added last comes first.
  template <class Visit>
  void for_each_in_latest_first(const geometry::Box& box, const Visit& visit) const {
    for_each_list(box, [&](const std::vector<Number>& list) {
      for (auto entry = list.rbegin(); entry != list.rend(); ++entry) visit(*entry);
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
  /// Calls visit(list) for the cells of the box that have entries, row by row. Where the box has more than kManyCells
  /// cells, and more than there are lists (small robots with a large margin), it goes through the lists.
  template <class Visit>
  void for_each_list(const geometry::Box& box, const Visit& visit) const {
    constexpr double kManyCells = 1024.0;
    const auto [low_x, low_y] = cell_of(box.low);
    const auto [high_x, high_y] = cell_of(box.high);
    const double cells = (static_cast<double>(high_x) - static_cast<double>(low_x) + 1.0) *
                         (static_cast<double>(high_y) - static_cast<double>(low_y) + 1.0);
    if (cells <= std::max(kManyCells, static_cast<double>(lists_.size())))
      return for_each_cell(box, [&](const Cell& cell) {
        if (const auto found = lists_.find(cell); found != lists_.end()) visit(found->second);
      });
    std::vector<std::pair<std::int64_t, std::int64_t>> met;  // y, x
    for (const auto& [cell, list] : lists_)
      if (low_x <= cell.first && cell.first <= high_x && low_y <= cell.second && cell.second <= high_y)
        met.emplace_back(cell.second, cell.first);
    std::sort(met.begin(), met.end());
    for (const auto& [y, x] : met) visit(lists_.at({x, y}));
  }

  double side_;
  std::unordered_map<Cell, std::vector<Number>, boost::hash<Cell>> lists_;
};

}  // namespace exactvo::formation::detail
