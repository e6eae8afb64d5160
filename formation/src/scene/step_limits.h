// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How near robots and what they avoid can come to each other within a time step, whatever is decided.

#include <algorithm>
#include <cmath>

#include "exactvo/vo/reciprocal.h"
#include "scene/decision_rules.h"
#include "scene/moment.h"

namespace exactvo::formation::detail {

/// The farthest velocity of a box bound, in greatest speeds.
inline const double kBoxDiagonal = std::sqrt(2.0);

/// m: how much nearer two that have these speeds (m/s) together can come.
inline double reach_within(double time_step, double speeds) {
  constexpr double kRounding = 1.0 + 1e-6;  // clearances are rounded
  return kRounding * time_step * speeds;
}

/// m: how much nearer a robot and what stands still can come. `max_speed`: m/s.
inline double reach_of_step(double time_step, double max_speed) {
  return reach_within(time_step, kBoxDiagonal * max_speed);
}

/// m: how much nearer two robots of these greatest speeds (m/s) can come.
inline double reach_of_pair(double time_step, double max_speed, double other_max_speed) {
  return reach_within(time_step, kBoxDiagonal * max_speed + kBoxDiagonal * other_max_speed);
}

/// s: within this a robot in contact is asked to part: never less than a step.
inline double contact_time(double time_step, const Horizons& horizons) {
  return std::max(time_step, vo::ReciprocalOptions{}.contact_time * moment(horizons));
}

/// m: `neighbour_distance`, or, if that is more, the distance of centres within which two can meet in a time step, or
/// while they brake, whose radii and greatest speeds add up to these (m, m/s).
inline double sight_of(const DecisionRules& rules, double radii, double speeds) {
  constexpr double kOfABox = 1.4143;  // the diagonal of a bound on each coordinate
  constexpr double kSpare = 1.001;    // roundings, and what is kept at contact
  return std::max(rules.neighbour_distance, kSpare * (radii + kOfABox * speeds * rules.least_look()));
}

}  // namespace exactvo::formation::detail
