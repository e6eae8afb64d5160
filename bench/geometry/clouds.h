// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The inputs: numbered streams, the same on every machine.

#include <cmath>
#include <cstdint>
#include <vector>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::bench {

/// SplitMix64 as uniform numbers in [0, 1).
class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = (state_ ^ (state_ >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

inline std::vector<geometry::Vec2> square_cloud(int n, std::uint64_t seed) {
  Stream stream(seed);
  std::vector<geometry::Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double x = stream.uniform();
    points.push_back({x, stream.uniform()});
  }
  return points;
}

/// A convex polygon with exactly n corners, rotated and uneven.
inline std::vector<geometry::Vec2> convex_ring(int n, std::uint64_t seed) {
  Stream stream(seed);
  const double turn = stream.uniform();
  std::vector<geometry::Vec2> ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * geometry::kPi * (i + 0.8 * stream.uniform()) / n + turn;
    ring.push_back({3.0 * std::cos(angle), 2.0 * std::sin(angle)});
  }
  return ring;
}

}  // namespace exactvo::bench
