// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A set of numbers that is emptied in no time: each number remembers the round in which it was marked.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exactvo::geometry::routing {

class Marks {
 public:
  /// `round` for tests: how many times it was emptied before.
  explicit Marks(std::size_t count = 0, std::uint32_t round = 1) : round_(round), marked_in_(count, 0) {}

  void clear() {
    if (++round_ != 0) return;
    std::fill(marked_in_.begin(), marked_in_.end(), 0u);
    round_ = 1;
  }
  void add(int i) { marked_in_[static_cast<std::size_t>(i)] = round_; }
  bool has(int i) const { return marked_in_[static_cast<std::size_t>(i)] == round_; }

 private:
  std::uint32_t round_;
  std::vector<std::uint32_t> marked_in_;
};

}  // namespace exactvo::geometry::routing
