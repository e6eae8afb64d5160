// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The virtual leader: a point that walks a polyline as fast as it was told and rests at its end.

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

struct LeaderState {
  Vec2 position;  ///< m
  Vec2 velocity;  ///< m/s
};

LeaderState leader_at(const Leader& leader, double time);

/// s; when the end of the path is reached (0 for a single point, infinite at speed 0).
double leader_arrival(const Leader& leader);

/// s; from when on it rests for good, at the end of its path or because its speed is 0 from then on; else infinite.
double rests_from(const Leader& leader);

}  // namespace exactvo::formation::detail
