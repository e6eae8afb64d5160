// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where robots were, row by row, as far back as memory allows: they can go back as they came (liveness, rule R3).

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::detail {

class History {
 public:
  /// 2^23 positions are 128 MiB: more than 40 s of 10,000 robots, and a day of three.
  explicit History(std::size_t most_positions = std::size_t{1} << 23) : most_(most_positions) {}

  /// `row`: m, of each robot.
  void add(std::vector<geometry::Vec2> row) { rows_.push_back(std::move(row)); }

  std::size_t first() const { return first_; }
  /// REQUIRES: a row was added.
  std::size_t last() const { return first_ + rows_.size() - 1; }
  /// REQUIRES: first() <= row <= last().
  const std::vector<geometry::Vec2>& operator[](std::size_t row) const { return rows_[row - first_]; }
  const std::vector<geometry::Vec2>& back() const { return rows_.back(); }

  /// Forgets the oldest rows that are too many, but none from `needed` on, nor the last.
  void forget_before(std::size_t needed) {
    while (rows_.size() > 1 && first_ < needed &&
           rows_.size() * std::max<std::size_t>(1, rows_.back().size()) > most_) {
      rows_.pop_front();
      ++first_;
    }
  }

 private:
  std::size_t most_;
  std::size_t first_ = 0;
  std::deque<std::vector<geometry::Vec2>> rows_;
};

}  // namespace exactvo::formation::detail
