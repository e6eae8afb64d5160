// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a decision needs of a scenario and its options, and nothing else: numbers, without robots and obstacles. A run
/// makes them once.

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

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
};

inline DecisionRules rules_of(const Scenario& scenario, const SimulationOptions& options) {
  return {options.method,     guidance_of(scenario, options), scenario.speed_bound, scenario.horizons, scenario.margins,
          scenario.time_step, scenario.neighbour_distance,    scenario.separate};
}

}  // namespace exactvo::formation::detail
