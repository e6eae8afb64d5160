// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Shapes from a fuzzer's bytes: small whole numbers, where ties and contacts are, or any doubles.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/support.h"

namespace exactvo::fuzz {

using geometry::Vec2;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }

  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }

  /// A number of any magnitude, NaN and infinities included where `any`; else finite and within 2^+-60.
  double number(bool any = false) {
    const std::uint8_t kind = byte();
    if (kind < 160) return static_cast<double>(static_cast<std::int8_t>(byte())) / (kind % 2 == 0 ? 1.0 : 8.0);
    std::uint64_t bits = 0;
    for (int k = 0; k < 8; ++k) bits = bits << 8 | byte();
    double x = 0.0;
    std::memcpy(&x, &bits, sizeof x);
    if (any) return x;
    return std::isfinite(x) && (x == 0.0 || (std::fabs(x) > 0x1p-60 && std::fabs(x) < 0x1p60)) ? x : 1.0;
  }
  double length(bool any = false) { return any ? number(true) : std::fabs(number()); }
  Vec2 point(bool any = false) {
    const double x = number(any);
    return {x, number(any)};
  }

  /// At most eight.
  std::vector<Vec2> points(bool any = false) {
    std::vector<Vec2> out;
    const int count = 1 + byte() % 8;
    for (int i = 0; i < count; ++i) out.push_back(point(any));
    return out;
  }

  geometry::ConvexShape shape() {
    switch (byte() % 4) {
      case 0: {
        const Vec2 c = point();
        return geometry::Disc{c, length()};
      }
      case 1: {
        const Vec2 a = point();
        return geometry::Segment{a, point()};
      }
      case 2:
        return geometry::convex_hull(points());
      default: {
        const Vec2 c = point();
        const double l11 = number(), l21 = number();
        return geometry::Ellipse{c, l11, l21, number()};
      }
    }
  }
  geometry::GrownShape grown() {
    geometry::GrownShape s{shape(), {}, 0.0};
    s.origin = point();
    s.radius = length();
    return s;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace exactvo::fuzz
