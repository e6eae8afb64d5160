// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles that are discs. Velocity obstacles, clearances and the audit take the disc itself, exactly; routes, free
/// space, places drawn at random, and the edges of ORCA take the polygon round it (geometry/round_polygon.h): they keep
/// off it by up to kRoundExcess of its radius more than they must.

#include <string>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// A disc that stands still. Throws std::invalid_argument as `geometry::polygon_round`.
SceneObstacle disc_obstacle(std::string id, const geometry::Disc& disc);

/// A disc that moves. Throws std::invalid_argument as `geometry::polygon_round`.
MovingObstacle moving_disc(std::string id, const geometry::Disc& disc, TimedPath motion);

/// m: from x to the disc's rim or the shape's edges; negative inside (geometry/distance.h). Rounded.
double signed_distance(const SceneObstacle& obstacle, Vec2 x);
/// The same for a moving obstacle at its place at t = 0.
double signed_distance(const MovingObstacle& obstacle, Vec2 x);

/// A shape and the length by which it grows. A disc gives its centre, as a segment of length 0, and its radius. Other
/// shapes give themselves and 0.
struct Core {
  geometry::Obstacle shape;  ///< m
  double grown = 0.0;        ///< m
};
/// The exact shape of an obstacle.
Core core_of(const SceneObstacle& obstacle);
/// The same for a moving obstacle at its place at t = 0.
Core core_of(const MovingObstacle& obstacle);

/// A velocity that is taken at a time and kept until the next one.
struct TimedVelocity {
  double time = 0.0;  ///< s, >= 0
  Vec2 velocity;      ///< m/s
};

/// The motion from `start` (m) with these velocities, up to `end` (s); at rest before the first. Velocities that begin
/// after the end are left out; where the last goes on, the path goes on as far as it takes beyond `end`, so that the
/// obstacle does not rest at its time. Rounded. REQUIRES: times that do not fall, end > 0.
TimedPath path_of(Vec2 start, const std::vector<TimedVelocity>& velocities, double end);

}  // namespace exactvo::formation
