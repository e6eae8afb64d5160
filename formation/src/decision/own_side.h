// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Own-side lines: half-planes of robots that only measure each other, up to bounds (guide, uncertainty).
///
/// F = [x, x + (tau - T) v] is the way of a robot that brakes from now on (scene/braking.h). Rule B: between the ways
/// of two robots, at least R apart, the line half-way between their nearest points has R / 2 and half of the rest on
/// each side. Each robot chooses a velocity whose whole way [x, x + tau u] stays on its own side; braking does,
/// whatever the other one does, and both then have such ways again.
///
/// The line is that of the true ways; a robot keeps to its side of every line that this can be. The other's way is
/// within E of the foreseen one, at distance l. Then the true distance is within E of l, the true normal within gamma =
/// acos((l - E) / (l + E)) of the foreseen one, and s = max(0, (l - E - R) / 2) is the robot's to use. For normals n_a
/// that divide this cone into parts of 2 eta, that across F among them,
///
///     n_a . (x + tau u) >= min over F of n_a . y - s cos eta
///
/// Any n of a part is a n_a + b n_b with a + b <= 1 / cos eta, and the minimum over F is at one end for all three: so n
/// . (x + tau u) >= min over F of n . y - s. Certified up to roundings: these and the room of lines use the skin up,
/// which is part of R.

#include <array>
#include <cstddef>

#include "exactvo/geometry/half_plane.h"
#include "scene/decision_rules.h"

namespace exactvo::formation::detail {

/// m, and the share of the way of braking that roundings of fast robots need: so much room a line leaves beside this
/// way, so that a robot held from all sides has a velocity between doubles. In each step some of the skin, 10^-6 m, may
/// go into it.
inline constexpr double kRoomOfLines = 0x1p-44, kRoomOfWays = 0x1p-46;

/// The way on which another robot may brake.
struct ForeseenWay {
  geometry::Segment way;  ///< m
  double off = 0.0;       ///< m: its true way is within this of it, end by end
};

/// From a place and a velocity measured `age` (s) ago within `bounds`, of a robot whose velocity changes by
/// `rules.acceleration` at most.
ForeseenWay foreseen_way(const DecisionRules& rules, const Measurements& bounds, Vec2 position, Vec2 velocity,
                         double age);

/// Half-planes of velocities.
class OwnSide {
 public:
  /// Of a robot there against one whose way is foreseen. `radii`: m, together. The velocity after a step of braking
  /// satisfies all.
  OwnSide(const DecisionRules& rules, Vec2 position, Vec2 velocity, const ForeseenWay& other, double radii);
  const geometry::HalfPlane* begin() const { return lines_.data(); }
  const geometry::HalfPlane* end() const { return lines_.data() + count_; }

 private:
  std::array<geometry::HalfPlane, 24> lines_;  // at most: a full turn in three pieces
  std::size_t count_ = 0;
};

}  // namespace exactvo::formation::detail
