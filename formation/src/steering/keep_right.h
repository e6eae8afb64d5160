// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Rule R1 (docs/guide/liveness.md): a robot that others hold up turns to the right of where it wants to go, the more
/// the longer it is held up. All turn the same way, so that they pass each other instead of standing face to face.
/// Heuristic: the rule changes preferred velocities only.

#include <algorithm>

#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::detail {

using geometry::Vec2;

struct KeepRight {
  static constexpr double kSmoothing = 0.2;  ///< weight of the last step in the mean
  static constexpr double kLeast = 0.03;     ///< rad: of a robot that meets others and is not held up
  static constexpr double kLeastOnWheels = 0.15;  ///< rad: the same on wheels, where nothing stands near
  static constexpr double kMost = 1.3;       ///< rad: of one that stands
  static constexpr double kPatience = 0.5;   ///< of robots that do not know whether another is near: one that sets out
                                             ///< misses its preferred speed for a step or two
  static constexpr double kNearGoal = 4.0;   ///< radii: from there on less, else a robot goes round its goal

  double held_up = 0.0;  ///< smoothed share of the preferred speed that is missing, 0 to 1

  /// `velocity`: m/s, of the last step; `least`: rad; `patience`: up to this `held_up`, below 1, it does not turn;
  /// `way`: m, to its end, of a robot of this radius; `meets_others`: false where none can be what holds it up.
  Vec2 turned(Vec2 preferred, Vec2 velocity, double least, double patience, double way, double radius,
              bool meets_others = true) {
    if (preferred == Vec2{}) return preferred;
    const double missing = meets_others ? 1.0 - dot(velocity, preferred) / squared_norm(preferred) : 0.0;
    held_up += kSmoothing * (std::clamp(missing, 0.0, 1.0) - held_up);
    const double far = std::min(1.0, way / (kNearGoal * radius));
    const double impatience = std::max(0.0, held_up - patience) / (1.0 - patience);
    const double angle = (meets_others ? least : 0.0) + kMost * impatience;
    return angle > 0.0 ? geometry::rotated(preferred, -far * angle) : preferred;
  }
};

}  // namespace exactvo::formation::detail
