// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What one robot decides about: ten obstacles, a velocity, a wish. Discs alone, as in a crowd, or mixed with
/// ellipses, polygons and segments, as walls and their enclosures come in.

#include <array>
#include <vector>

#include "instances.h"

namespace exactvo::bench {

inline constexpr std::size_t kSeen = 10;

struct Scene {
  std::array<geometry::GrownShape, kSeen> seen;
  double time_horizon = 0.0;  ///< s
  double max_speed = 0.0;     ///< m/s
  geometry::Vec2 velocity;    ///< m/s, now
  geometry::Vec2 preferred;   ///< m/s
};

enum class Surroundings { discs, mixed };

/// Obstacles of about 1 m, up to 8 m from the robot's rim and all round it; a wish within 0.6 rad of the velocity. The
/// same on every machine whose C library rounds sine and cosine alike.
std::vector<Scene> random_scenes(Surroundings surroundings, std::size_t count, std::uint64_t seed);

}  // namespace exactvo::bench
