// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Speed profiles of a leader that follows a polyline: ready-made ones, and what any of them comes to. Rounded.

#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// m; the length of a polyline.
double length_of(const std::vector<Vec2>& path);

/// From rest at `acceleration` (m/s^2, > 0) to `speed` (m/s, > 0), and down again to rest at the path's end; a triangle
/// where the path is too short to reach the speed.
std::vector<SpeedKnot> trapezoid(const std::vector<Vec2>& path, double speed, double acceleration);

/// A constant speed on each leg of the path (m/s, > 0), with jumps between. REQUIRES: one speed a leg.
std::vector<SpeedKnot> speed_of_legs(const std::vector<Vec2>& path, const std::vector<double>& speeds);

/// m/s and m after `time` >= 0. REQUIRES: at least one knot, times that do not fall.
double speed_at(const std::vector<SpeedKnot>& profile, double time);
/// m, after `time` >= 0. REQUIRES: as `speed_at`.
double distance_at(const std::vector<SpeedKnot>& profile, double time);

/// s; when `distance` (m) is first covered; infinite where it never is.
double time_to_cover(const std::vector<SpeedKnot>& profile, double distance);

/// m; how far a moving obstacle has come at `time` (s) from where it stands at t = 0.
Vec2 displacement_at(const MovingObstacle& obstacle, double time);

}  // namespace exactvo::formation
