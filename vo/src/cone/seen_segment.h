// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A segment grown by the robot and seen from it. What `support` and `nearest_normals` answer of any shape, they answer
/// of it in the same bits, with the ends subtracted once and nothing looked up by kind: maps are made of segments.

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "cone/direction_search.h"
#include "cone/tangents.h"

namespace exactvo::vo::detail {

struct SeenSegment {
  const GrownShape& whole;
  const geometry::Segment& segment;
  Vec2 a, b;  ///< m, the ends from the robot, rounded

  /// REQUIRES: `s` outlives it and holds a segment.
  explicit SeenSegment(const GrownShape& s)
      : whole(s), segment(std::get<geometry::Segment>(s.shape)), a(segment.a - s.origin), b(segment.b - s.origin) {}
};

inline geometry::SupportValue support(const SeenSegment& s, Vec2 n) {
  const Vec2 at_a{n.x * s.a.x, n.y * s.a.y}, at_b{n.x * s.b.x, n.y * s.b.y};
  const double grown = s.whole.radius * std::sqrt(squared_norm(n));
  return {std::max(at_a.x + at_a.y, at_b.x + at_b.y) + grown,
          std::max(std::fabs(at_a.x) + std::fabs(at_a.y), std::fabs(at_b.x) + std::fabs(at_b.y)) + grown};
}

inline std::optional<Tangents> tangents(const SeenSegment& s) {
  return tangents(s.whole);
}

inline Vec2 middle_of(const SeenSegment& s) {
  return 0.5 * (s.segment.a + s.segment.b);
}

/// Calls visit(normal) until it is true: what `nearest_normals` lists, one after the other.
template <class Visit>
void for_each_nearest_normal(const SeenSegment& s, Vec2 y, const Visit& visit) {
  const Vec2 away = y - nearest_on(s.a, s.b, y);
  if (away != Vec2{} && visit(unit(away))) return;
  const Vec2 side = side_of(s.a, s.b);
  if (visit(side)) return;
  visit(-side);
}

/// False where doubles cannot tell. With n the unit normal of the nearest point, the distance of the robot from the
/// segment is at least -max(n.a, n.b) / |n|, and `nearest` is that without the radius. The ends are off by u of
/// themselves, |n| by 4 u, the products and sums by 4 u of M = |a| + |b|, and the radius's part by 4 u of it: less than
/// 16 u of M + the radius in all, where nothing underflows. 64 u stand for it.
inline bool is_surely_apart(const SeenSegment& s, double room, double nearest) {
  constexpr double kRounding = 64.0 * geometry::kUnitRoundoff;
  const double size = std::fabs(s.a.x) + std::fabs(s.a.y) + std::fabs(s.b.x) + std::fabs(s.b.y);
  return nearest - room > kRounding * (size + s.whole.radius) + geometry::kSupportUnderflow;
}

}  // namespace exactvo::vo::detail
