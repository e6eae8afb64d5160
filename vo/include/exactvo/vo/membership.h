// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Many velocities against one velocity obstacle: what `VelocityObstacle::contains` answers, prepared once.
///
/// Exact. Preparing takes about as long as `VelocityObstacle::legs`; then three products decide nearly every velocity,
/// whatever the shape, without data-dependent branches. With A and B points of S near its tangents and m across their
/// chord:
///
///       \ A.-------.B /      beyond the chord and between the rays through A and B:  collides
///        \ |   S   | /       outside a leg, or before the tangent of S along m:      does not
///         \ `-----' /        between the two: left to `VelocityObstacle::contains`
///          \   |m  /
///           \  v  /
///              o
///
/// Properties (tests quote the numbers):
///  (1) the answer is that of `VelocityObstacle::contains`, for every velocity;
///  (2) what it leaves to `contains` shrinks with the cap of S before the chord.
///
/// Neighbour: velocity_obstacle.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo {

/// A velocity obstacle with what its question needs, computed once.
class Membership {
 public:
  /// REQUIRES: !obstacle.overlaps().
  explicit Membership(VelocityObstacle obstacle);

  /// The velocity obstacle it was made of.
  const VelocityObstacle& obstacle() const { return obstacle_; }

  /// Whether v collides within the horizon. Exact. What it decides by itself is not in geometry::stage_counts.
  bool contains(Vec2 v) const {
    const double band = band_ * (std::fabs(v.x) + std::fabs(v.y)) + kUnderflow;
    const double beside = std::max(dot(left_, v), dot(right_, v));
    const double ahead = dot(across_, v);
    // Bits, not branches: no predictor can guess which it will be. NaN and infinity make none of it true.
    const int misses = static_cast<int>(beside > band) | static_cast<int>(ahead > before_ + band);
    const int meets = static_cast<int>(beside < -band) & static_cast<int>(ahead < beyond_ - band);
    if ((misses | meets) != 0) return meets != 0;
    return obstacle_.contains(v);
  }

 private:
  void prepare_misses(const Legs& legs);
  void prepare_meetings(const Legs& legs);

  /// More than what underflow takes from a product or two.
  static constexpr double kUnderflow = 0x1p-1000;
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  Vec2 left_, right_;        ///< certified: h_S <= 0
  Vec2 across_;              ///< m
  double before_ = kNever;   ///< m/s, at least h_S(m) / tau: S lies beyond
  double beyond_ = -kNever;  ///< m/s, at most m.x / tau on the chord
  double band_ = kNever;     ///< of |v.x| + |v.y|: the rounding, and how far the rays through A and B are from the legs
  VelocityObstacle obstacle_;
};

}  // namespace exactvo::vo
