// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The scenes on which half-planes are audited, and the audit in rationals.

#include <string>

#include "exactvo/vo/velocity_obstacle.h"
#include "geometry/exact_oracle.h"
#include "geometry/random_grown.h"

namespace exactvo::test {

inline vo::VelocityObstacle velocity_obstacle(const geometry::GrownShape& s, double tau) {
  return vo::VelocityObstacle(s.shape, s.origin, s.radius, tau);
}

/// Aimed at S, past it, away from it, behind it, or nothing.
inline geometry::Vec2 random_velocity(SeededRandom& random, const geometry::GrownShape& s, double tau) {
  const geometry::Vec2 aim = geometry::support_point(s, random.direction()) / tau;
  switch (random.integer(0, 4)) {
    case 0:
      return random.uniform(-1.0, 1.0) * aim;
    case 1:
      return random.uniform(1.0, 5.0) * aim;
    case 2:
      return geometry::norm(aim) * random.uniform(0.0, 3.0) * random.direction();
    case 3:
      return {};
    default:
      return aim;
  }
}

/// Lossless, to be pasted into a test.
inline std::string text_of(const geometry::GrownShape& s, double tau, geometry::Vec2 v) {
  using geometry::hex_text;
  return to_string(s.shape) + "  origin " + hex_text(s.origin.x) + " " + hex_text(s.origin.y) + "  radius " +
         hex_text(s.radius) + "  tau " + hex_text(tau) + "  v " + hex_text(v.x) + " " + hex_text(v.y);
}

}  // namespace exactvo::test
