// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A uniform grid over the obstacles' pieces: which may come near a segment, and which triangle to start a walk from.
/// Conservative: what it names is a superset. A BoxGrid would look at the whole box of a segment; here only cells
/// beside the segment are visited, and a long wall lies only in the cells beside it.

#include <algorithm>
#include <cmath>
#include <vector>

#include "routes/cell_map.h"

namespace exactvo::geometry::routing {

class EdgeGrid {
 public:
  explicit EdgeGrid(const CellMap& map);

  /// A triangle near x.
  int triangle_near(Vec2 x) const { return hints_[cell(column(x.x), row(x.y))]; }

  /// Calls f(piece) for every piece that may come within r of the segment ab, some of them more than once; a piece is
  /// an edge of the graph, or beyond those an isolated vertex. Stops where f returns false, and returns that.
  template <typename F>
  bool for_each_near(Vec2 a, Vec2 b, double r, const F& f) const {
    const double reach = r + slack_for(a, b, r);
    const int first = column(std::min(a.x, b.x) - reach), last = column(std::max(a.x, b.x) + reach);
    for (int i = first; i <= last; ++i) {
      const auto [low, high] = rows_in_column(a, b, reach, i);
      for (int j = low; j <= high; ++j)
        for (int k = starts_[cell(i, j)]; k < starts_[cell(i, j) + 1]; ++k)
          if (!f(items_[k])) return false;
    }
    return true;
  }

 private:
  /// More than rounding makes of a coordinate, and of a line's height over a column, wherever the segment lies.
  double slack_for(Vec2 a, Vec2 b, double r) const {
    constexpr double kRounding = 0x1p-40;
    return kRounding * std::max({largest_, std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y), r});
  }
  int column(double x) const { return clamped((x - low_.x) / size_, columns_); }
  int row(double y) const { return clamped((y - low_.y) / size_, rows_); }
  static int clamped(double k, int count) {
    return static_cast<int>(std::clamp(std::floor(k), 0.0, static_cast<double>(count - 1)));
  }
  std::size_t cell(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(j);
  }
  /// The rows that ab, widened by `reach`, has in a column.
  std::pair<int, int> rows_in_column(Vec2 a, Vec2 b, double reach, int column) const;
  void add_all(const CellMap& map);

  Vec2 low_;
  double size_ = 1.0, largest_ = 0.0;  ///< m: a cell's side; the largest coordinate
  int columns_ = 1, rows_ = 1;
  std::vector<int> hints_, starts_, items_;
};

}  // namespace exactvo::geometry::routing
