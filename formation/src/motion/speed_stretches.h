// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A speed profile as stretches of constant acceleration.

#include <limits>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// From one knot to the next, or after the last one: speed changes at a constant rate.
struct SpeedStretch {
  double start, duration;  ///< s; the last duration is infinite
  double speed, rate;      ///< m/s, m/s^2
  double distance(double t) const { return t * (speed + 0.5 * rate * t); }
};

/// Visits every stretch of the profile in turn, from t = 0 on, until `take` returns true.
template <typename Take>
void for_each_stretch(const std::vector<SpeedKnot>& profile, const Take& take) {
  if (take(SpeedStretch{0.0, profile.front().time, profile.front().speed, 0.0})) return;
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const SpeedKnot& a = profile[k - 1];
    const double duration = profile[k].time - a.time;
    const double rate = duration > 0.0 ? (profile[k].speed - a.speed) / duration : 0.0;
    if (take(SpeedStretch{a.time, duration, a.speed, rate})) return;
  }
  take(SpeedStretch{profile.back().time, std::numeric_limits<double>::infinity(), profile.back().speed, 0.0});
}

}  // namespace exactvo::formation::detail
