// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A quick answer to whether a place is in the open: whether more squares of a grid than asked for hang together round
/// it, none of which any edge comes near to. One bit a square, in a window of 64 columns and 256 rows about the place.
/// Certified where it says yes; no leaves it open.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation::detail {

class OpenWindow {
 public:
  static constexpr int kColumns = 64, kRows = 256;

  /// Its lower left square has the corner (x, y) times `side`. REQUIRES: these products are exact, and so are those of
  /// the next 256 squares.
  OpenWindow(std::int32_t x, std::int32_t y, double side) : low_x_(x), low_y_(y), side_(side) {
    open_.fill(~std::uint64_t{0});
  }

  /// m
  geometry::Box box() const {
    return {side_ * geometry::Vec2{double(low_x_), double(low_y_)},
            side_ * geometry::Vec2{double(low_x_) + kColumns, double(low_y_) + kRows}};
  }

  /// Takes away the squares that have a point within `reach` of the edge, and those beside them: a whole square more
  /// than any rounding. Row by row: of the edge only what is as near to the row in y counts.
  void take_away(const geometry::Segment& edge, double reach) {
    const geometry::Vec2 low = edge.a.y <= edge.b.y ? edge.a : edge.b, high = edge.a.y <= edge.b.y ? edge.b : edge.a;
    const int first = index(low.y - reach, low_y_, kRows) - 1, last = index(high.y + reach, low_y_, kRows) + 1;
    for (int row = std::max(first, 0); row <= std::min(last, kRows - 1); ++row) {
      const double bottom = side_ * (double(low_y_) + row - 1.0) - reach;
      const double top = side_ * (double(low_y_) + row + 2.0) + reach;
      const double from = x_at(low, high, bottom), to = x_at(low, high, top);
      const int left = std::max(index(std::min(from, to) - reach, low_x_, kColumns) - 1, 0);
      const int right = std::min(index(std::max(from, to) + reach, low_x_, kColumns) + 1, kColumns - 1);
      if (left > right) continue;
      open_[static_cast<std::size_t>(row)] &= ~((~std::uint64_t{0} >> (kColumns - 1 - (right - left))) << left);
    }
  }

  /// Whether more than `count` squares that are left can be got to from the square in that column and row, itself among
  /// them or not: from square to square that shares a side or a corner. REQUIRES: inside the window.
  bool has_more_than(std::size_t count, int column, int row) const {
    std::array<std::uint64_t, kRows> got{};
    got[static_cast<std::size_t>(row)] = std::uint64_t{1} << column;
    for (std::size_t before = 0, all = 1; all > before;) {
      for (std::size_t k = 1; k < kRows; ++k) got[k] |= spread(wider(got[k - 1]) | wider(got[k]), open_[k]);
      for (std::size_t k = kRows - 1; k > 0; --k) got[k - 1] |= spread(wider(got[k]) | wider(got[k - 1]), open_[k - 1]);
      before = all;
      all = 0;
      for (const std::uint64_t bits : got) all += static_cast<std::size_t>(__builtin_popcountll(bits));
      if (all > count) return true;
    }
    return false;
  }

 private:
  /// The square that has the coordinate, from -2 to `most` + 1 where it is outside.
  int index(double at, std::int32_t low, int most) const {
    return static_cast<int>(std::clamp(std::floor(at / side_) - low, -2.0, most + 1.0));
  }

  /// The edge's x at the height y, or at the end that is nearest to it.
  static double x_at(geometry::Vec2 low, geometry::Vec2 high, double y) {
    if (!(y > low.y)) return low.x;
    if (!(y < high.y)) return high.x;
    return low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
  }

  static std::uint64_t wider(std::uint64_t bits) { return bits | bits << 1 | bits >> 1; }

  /// The open bits that hang together in a row with one of `bits`.
  static std::uint64_t spread(std::uint64_t bits, std::uint64_t open) {
    bits &= open;
    if (bits == 0) return 0;
    std::uint64_t up = bits, down = bits, open_up = open, open_down = open;
    for (int step = 1; step < kColumns; step *= 2) {
      up |= open_up & up << step;
      open_up &= open_up << step;
      down |= open_down & down >> step;
      open_down &= open_down >> step;
    }
    return up | down;
  }

  std::int32_t low_x_, low_y_;
  double side_;                            ///< m
  std::array<std::uint64_t, kRows> open_;  ///< a bit for each column, from the left
};

}  // namespace exactvo::formation::detail
