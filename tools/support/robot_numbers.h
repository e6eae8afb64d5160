// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which numbers the command line takes for a robot wherever velocity obstacles are asked for: within these, squares
/// and the squares of sums stay far within doubles. (How fast a robot may drive is its `max_speed`, in the scenario.)

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "exactvo/geometry/vec2.h"
#include "exactvo/vo/free_velocities.h"
#include "support/usage.h"

namespace exactvo::tools {

/// The bound of coordinates, velocities and radii: m, m/s.
inline constexpr double kLargestNumber = vo::kMostApex;

/// The bounds of horizons, s: lengths over them, and velocities times them, keep their squares within doubles too.
inline constexpr double kLeastHorizon = 0x1p-100;
inline constexpr double kMostHorizon = 0x1p100;

inline bool is_horizon(double seconds) {
  return seconds >= kLeastHorizon && seconds <= kMostHorizon;
}

inline bool is_radius(double metres) {
  return metres >= 0.0 && metres <= kLargestNumber;
}

inline bool is_in_range(geometry::Vec2 v) {
  return std::fabs(v.x) <= kLargestNumber && std::fabs(v.y) <= kLargestNumber;
}

inline constexpr const char* kRadii = "a length from 0 m to 2^100 m";

/// "X,Y", of the option of that name. Throws UsageError.
inline geometry::Vec2 parse_point(const std::string& option, const std::string& text) {
  geometry::Vec2 v;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &v.x, &v.y, &rest) != 2 || !is_in_range(v))
    throw UsageError(option, text, fmt::format("two numbers within {:g}, X,Y", kLargestNumber));
  return v;
}

}  // namespace exactvo::tools
