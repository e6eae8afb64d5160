// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/decide.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "decision/feasible.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "half_plane/plain.h"

namespace exactvo::bench {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::GrownShape;
using geometry::HalfPlane;
using geometry::perp;
using geometry::squared_norm;
using geometry::Vec2;

/// The lines of a decision as `solve_feasible` wants them.
struct Lines {
  static constexpr std::size_t kRoom = (kSeen + lp::kSinglePadding - 1) / lp::kSinglePadding * lp::kSinglePadding;
  alignas(64) double x[kRoom];
  alignas(64) double y[kRoom];
  alignas(64) double c[kRoom];

  /// False where an obstacle has no half-plane: overlap, or a few ulps from it.
  template <class HalfPlaneOf>
  bool fill(const Scene& scene, const HalfPlaneOf& half_plane_of) {
    for (std::size_t k = 0; k < kSeen; ++k) {
      const std::optional<HalfPlane> h = half_plane_of(scene.seen[k], scene.time_horizon, scene.velocity);
      if (!h) return false;
      x[k] = h->normal.x;
      y[k] = h->normal.y;
      c[k] = h->offset;
    }
    return true;
  }
  lp::SingleProblem problem(const Scene& scene) const {
    return {x, y, c, kSeen, kSeen, scene.preferred, scene.max_speed};
  }
};

/// The velocity nearest the wish on the boundary of line `k`, inside the lines before it and the disc.
std::optional<Vec2> nearest_on_line(const Lines& lines, std::size_t k, double speed, Vec2 wish) {
  const Vec2 n{lines.x[k], lines.y[k]}, along = perp(n), foot = lines.c[k] * n;
  const double room = speed * speed - lines.c[k] * lines.c[k];
  if (room < 0.0) return std::nullopt;
  double low = -std::sqrt(room), high = -low;
  for (std::size_t i = 0; i < k; ++i) {
    const Vec2 other{lines.x[i], lines.y[i]};
    const double slope = dot(other, along), short_by = lines.c[i] - dot(other, foot);
    if (slope == 0.0) {
      if (short_by > 0.0) return std::nullopt;
      continue;
    }
    const double cut = short_by / slope;
    if (slope > 0.0)
      low = std::max(low, cut);
    else
      high = std::min(high, cut);
    if (low > high) return std::nullopt;
  }
  return foot + std::clamp(dot(wish, along), low, high) * along;
}

Vec2 incremental(const Lines& lines, double speed, Vec2 wish) {
  const double squared = squared_norm(wish);
  Vec2 v = squared > speed * speed ? (speed / std::sqrt(squared)) * wish : wish;
  for (std::size_t k = 0; k < kSeen; ++k) {
    if (lines.x[k] * v.x + lines.y[k] * v.y >= lines.c[k]) continue;
    const std::optional<Vec2> on_line = nearest_on_line(lines, k, speed, wish);
    if (!on_line) return {};
    v = *on_line;
  }
  return v;
}

}  // namespace

Vec2 proven_velocity(const Scene& scene) {
  Lines lines;
  if (!lines.fill(scene, [](const GrownShape& s, double tau, Vec2 v) { return vo::half_plane(s, tau, v); })) return {};
  Vec2 v;
  return solve_feasible(lines.problem(scene), v) ? v : Vec2{};
}

Vec2 plain_velocity(const Scene& scene) {
  Lines lines;
  if (!lines.fill(scene, plain_half_plane)) return {};
  return incremental(lines, scene.max_speed, scene.preferred);
}

}  // namespace exactvo::bench
