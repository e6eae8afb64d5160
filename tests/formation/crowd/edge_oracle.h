// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Half-planes against edges for one robot, one edge after the other: what packs are compared with, bit for bit.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "crowd/bodies.h"
#include "crowd/edge_rounding.h"
#include "crowd/edges.h"

namespace exactvo::formation::crowd {

using namespace edge_rounding;
using geometry::dot;

/// Out of line, since GCC 12 drops such conversions where it sees two side by side.
[[gnu::noinline]] inline double rounded_to_float(double x) {
  return static_cast<double>(static_cast<float>(x));
}

inline Vec2 nearest_point(const Segment& s) {
  const Vec2 along = s.b - s.a;
  const double length = geometry::squared_norm(along);
  return s.a + (length > 0.0 ? std::clamp(-dot(s.a, along) / length, 0.0, 1.0) : 0.0) * along;
}

inline double squared_distance(const Segment& s) {
  return geometry::squared_norm(nearest_point(s));
}

inline double magnitude(const Segment& s) {
  return std::fabs(s.a.x) + std::fabs(s.a.y) + std::fabs(s.b.x) + std::fabs(s.b.y);
}

/// The part of an edge within |x|, |y| <= far: what is beyond the range cannot be met, and a normal that is rounded
/// turns the far end of a long wall across the way. A new end is off the edge by a rounding error of the old ones.
inline Segment cut(const Segment& s, double far) {
  if (std::max({std::fabs(s.a.x), std::fabs(s.a.y), std::fabs(s.b.x), std::fabs(s.b.y)}) <= far) return s;
  double from = 0.0, to = 1.0;
  const auto clip = [&](double a, double b) {
    if (a == b) return;
    const double one = (-far - a) / (b - a), other = (far - a) / (b - a);
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  };
  clip(s.a.x, s.b.x);
  clip(s.a.y, s.b.y);
  if (!(from <= to)) return s;
  const Vec2 along = s.b - s.a;
  return {from > 0.0 ? s.a + from * along : s.a, to < 1.0 ? s.a + to * along : s.b};
}

/// The edge from the robot, and what is asked.
class Cone {
 public:
  Cone(const Segment& seen, double range, const BodyQuery& query)
      : seen_(cut(seen, kCutRanges * range)),
        query_(query),
        size_(magnitude(seen) + query.radius),
        error_(kSupportError * size_) {
    const double u = query.float_normals ? 0x1p-24 : kUnit;
    grown_ = query.radius + kRoundingRoom * u * (magnitude(seen_) + query.radius) + kSupportRoom * size_;
  }

  /// At least h(n), exactly that of the doubles given.
  double support_above(Vec2 n) const {
    const double length = std::sqrt(geometry::squared_norm(n));
    return std::max(dot(n, seen_.a), dot(n, seen_.b)) + query_.radius * length + error_;
  }

  BodyLine best_line() {
    // The cut-offs at the ends of the edge.
    try_normal(direction(query_.still_horizon * query_.velocity - seen_.a));
    try_normal(direction(query_.still_horizon * query_.velocity - seen_.b));
    const Vec2 across = direction(geometry::perp(seen_.b - seen_.a));
    try_normal(across);
    try_normal(-across);
    try_legs(seen_.a);
    try_legs(seen_.b);
    BodyLine line = line_with(found_);
    if (least_ < std::numeric_limits<double>::infinity() && set_offset(line)) return line;
    return facing();
  }

 private:
  /// The two tangents from the robot to the disc round an end.
  void try_legs(Vec2 centre) {
    const double squared = geometry::squared_norm(centre), square = squared - grown_ * grown_;
    if (!(square > 0.0)) return;
    const double leg = std::sqrt(square), scale = 1.0 / squared;
    for (const double side : {leg, -leg}) {
      const Vec2 n = {-(grown_ * centre.x + side * centre.y), side * centre.x - grown_ * centre.y};
      try_normal(scale * n, error_);
    }
  }

  /// Valid where no point of the grown edge lies on its side of the robot; `room` for what a leg is rounded by.
  void try_normal(Vec2 n, double room = 0.0) {
    const double support = std::max(dot(n, seen_.a), dot(n, seen_.b)) + grown_;
    if (!(support <= room)) return;
    const double depth = support - query_.still_horizon * dot(n, query_.velocity);
    if (!(depth < least_)) return;
    least_ = depth;
    found_ = n;
  }

  /// With a normal of the precision asked for, and no offset yet.
  BodyLine line_with(Vec2 normal) const {
    BodyLine line;
    line.normal = query_.float_normals ? Vec2{rounded_to_float(normal.x), rounded_to_float(normal.y)} : normal;
    return line;
  }

  /// False where the normal as rounded does not separate robot and edge.
  bool set_offset(BodyLine& line) const {
    const double support = support_above(line.normal);
    if (!(support <= 0.0)) return false;
    line.offset = std::min(0.0, (support + kSharedVertex * error_) / query_.still_horizon * kTowardsZero);
    return true;
  }

  /// Not nearer to the edge: where it is too near for anything else.
  BodyLine facing() const {
    Vec2 n = direction(-nearest_point(seen_));
    if (n == Vec2{}) n = direction(geometry::perp(seen_.b - seen_.a));
    if (n == Vec2{}) n = {1.0, 0.0};
    BodyLine line = line_with(n);
    line.touching = !(support_above(line.normal) <= 0.0);
    return line;
  }

  Segment seen_;
  const BodyQuery& query_;
  double size_, error_, grown_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
  Vec2 found_;
};

/// Whether an earlier half-plane excludes all that meets this edge.
inline bool is_covered(const Cone& cone, const std::vector<BodyLine>& lines, double horizon) {
  return std::any_of(lines.begin(), lines.end(), [&](const BodyLine& line) {
    const double support = cone.support_above(line.normal);
    return !line.touching && support <= horizon * line.offset * kAwayFromZero;
  });
}

/// Half-planes against all edges that can be met within the horizon, nearest first; `obstacle` is an edge's number.
inline std::vector<BodyLine> edge_lines(const EdgeGrid& grid, const BodyQuery& query) {
  std::vector<BodyLine> out;
  std::vector<std::pair<double, std::uint32_t>> near;  // by squared distance, m^2, and place in the grid's items
  const double range = (query.still_horizon * query.max_speed + query.radius) * kWiden;
  const auto seen = [&](std::uint32_t edge) {
    return Segment{grid.edges()[edge].a - query.position, grid.edges()[edge].b - query.position};
  };
  const EdgeGrid::Range cell = grid.near(query.position);
  for (std::uint32_t place = cell.first; place < cell.last; ++place) {
    const double squared = squared_distance(seen(grid.items()[place]));
    if (squared <= range * range) near.emplace_back(squared, place);
  }
  std::sort(near.begin(), near.end());
  for (const auto& [squared, at] : near) {
    const std::uint32_t edge = grid.items()[at];
    Cone cone(seen(edge), range, query);
    if (is_covered(cone, out, query.still_horizon)) continue;
    out.push_back(cone.best_line());
    out.back().obstacle = edge;
  }
  return out;
}

}  // namespace exactvo::formation::crowd
