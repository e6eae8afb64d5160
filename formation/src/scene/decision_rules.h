// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a decision needs of a scenario and its options, and nothing else: numbers, without robots and obstacles. A run
/// makes them once.

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/infinity.h"

namespace exactvo::formation::detail {

/// The fields that a Scenario has too mean the same.
struct DecisionRules {
  Method method = Method::ivo;                        ///< how obstacles are avoided
  Guidance guidance = Guidance::none;                 ///< as in force (`guidance_of`)
  SpeedBoundKind speed_bound = SpeedBoundKind::disc;  ///< how every robot's max_speed is meant
  Horizons horizons;                                  ///< of the velocity obstacles
  Margins margins;                                    ///< beside radii and facades
  double time_step = 0.05;                            ///< s, > 0
  double neighbour_distance = 15.0;                   ///< m, > 0
  bool separate = false;                              ///< robots that overlap part, and do not come nearer
  double acceleration = geometry::kInfinity;          ///< m/s^2, of each robot; on wheels if others measure it
  std::optional<Measurements> measurements = {};      ///< where robots measure each other
  double braking_time = 0.0;                          ///< s, tau of braking; 0: velocities jump

  bool has_brakes() const { return braking_time > 0.0; }
  /// The velocity after a step of braking, of this one: what is allowed whatever else is (`braking.h`). It keeps its
  /// direction, which subnormal numbers cannot: a robot that brakes for long comes to rest.
  Vec2 braked(Vec2 velocity) const {
    const Vec2 left = (1.0 - time_step / braking_time) * velocity;
    return std::max(std::fabs(left.x), std::fabs(left.y)) < 0x1p-500 ? Vec2{} : left;
  }
  /// s: within this time nothing may be met that a robot did not look at.
  double least_look() const { return std::max(time_step, braking_time); }
  /// s: horizons against static obstacles are not shorter.
  double least_horizon() const { return std::max({horizons.least, 2.0 * time_step, braking_time}); }
};

inline DecisionRules rules_of(const Scenario& scenario, const SimulationOptions& options) {
  DecisionRules rules{
      options.method,     guidance_of(scenario, options), scenario.speed_bound, scenario.horizons, scenario.margins,
      scenario.time_step, scenario.neighbour_distance};
  rules.separate = scenario.separate;
  if (scenario.acceleration) rules.acceleration = scenario.acceleration->max;
  if (scenario.uncertainty) rules.measurements = scenario.uncertainty->measurements;
  rules.braking_time = braking_time_of(scenario);
  return rules;
}

}  // namespace exactvo::formation::detail
