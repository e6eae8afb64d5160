// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Numbers of edges by their two ends, in either order. Never iterated over: nothing depends on the hash's order.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace exactvo::geometry::routing {

class EdgeNumbers {
 public:
  explicit EdgeNumbers(std::size_t expected) { numbers_.reserve(expected); }

  /// The number of the edge between a and b: the one that it has, or else `next`. REQUIRES: a, b >= 0.
  int emplace(int a, int b, int next) { return numbers_.emplace(key_of(a, b), next).first->second; }
  void set(int a, int b, int number) { numbers_[key_of(a, b)] = number; }
  /// REQUIRES: it has one.
  int at(int a, int b) const { return numbers_.at(key_of(a, b)); }

 private:
  static std::uint64_t key_of(int a, int b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
  }
  std::unordered_map<std::uint64_t, int> numbers_;
};

}  // namespace exactvo::geometry::routing
