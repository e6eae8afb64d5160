// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the virtual leader and moving obstacles are on their timed paths: they walk a polyline and rest at its end.

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

struct LeaderState {
  Vec2 position;  ///< m
  Vec2 velocity;  ///< m/s
};

LeaderState leader_at(const TimedPath& path, double time);

/// s; when the end of the path is reached (0 for a single point, infinite at speed 0).
double leader_arrival(const TimedPath& path);

/// s; from when on it rests for good, at the end of its path or because its speed is 0 from then on; else infinite.
double rests_from(const TimedPath& path);

}  // namespace exactvo::formation::detail
