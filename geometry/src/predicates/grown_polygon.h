// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact questions about hull(vertices) (+) D(0, r) for a point or a segment from the robot. Each elementary sign is
/// taken in doubles with a static bound and, where that is undecided, exactly.

#include <cmath>
#include <cstddef>

#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry::detail {

/// The point scale * base - origin, as it stands and rounded. Its coordinates have a relative error of u.
struct Seen {
  Vec2 base, origin;
  double scale;
  Vec2 at;      ///< rounded
  double size;  ///< |x| + |y| of `at`
};
inline Seen seen(Vec2 base, Vec2 origin) {
  const Vec2 at = base - origin;
  return {base, origin, 1.0, at, std::fabs(at.x) + std::fabs(at.y)};
}
inline Seen along(Vec2 direction, double t) {
  const Vec2 at = t * direction;
  return {direction, {}, t, at, std::fabs(at.x) + std::fabs(at.y)};
}

/// Vertices counter-clockwise, at least one; they need not have an area.
class GrownPolygon {
 public:
  GrownPolygon(const Vec2* vertices, std::size_t count, Vec2 origin, double radius)
      : vertices_(vertices), count_(count), origin_(origin), radius_(radius) {}

  Place place_of(const Seen& q) const;

  /// Whether the segment from the robot to t_max * direction meets it.
  bool meets(Vec2 direction, double t_max) const;

  /// Whether any sign needed the exact stage since construction.
  bool was_exact() const { return was_exact_; }

 private:
  Seen vertex(std::size_t i) const { return seen(vertices_[i < count_ ? i : i - count_], origin_); }
  Sign turn(const Seen& a, const Seen& b, const Seen& c) const;
  Sign distance_to_segment(const Seen& q, const Seen& a, const Seen& b) const;
  struct Slab {
    enum { misses, meets, unknown } verdict = unknown;
    bool start_is_clear = false;  ///< the robot lies before all of S
    bool end_is_clear = false;    ///< the segment's end lies beyond all of S
  };
  Slab slab(Vec2 direction, double t_max) const;

  const Vec2* vertices_;
  std::size_t count_;
  Vec2 origin_;
  double radius_;
  mutable bool was_exact_ = false;
};

}  // namespace exactvo::geometry::detail
