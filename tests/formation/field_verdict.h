// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether one random field was reached and safe.

#include <cstdio>
#include <string>

#include "exactvo/datasets/random_fields.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::test {

struct FieldVerdict {
  std::string field;
  bool reached = false;
  double obstacle_clearance = 0.0, robot_clearance = 0.0;  ///< m; 1e9 where there is nothing to be clear of
  std::size_t uncertified = 0;
  double last_arrival = 0.0;     ///< s; 0 where not reached
  double formation_error = 0.0;  ///< m
  double wall_time = 0.0;        ///< s

  bool safe() const { return obstacle_clearance > 0.0 && robot_clearance > 0.0 && uncertified == 0; }
  bool good() const { return reached && safe(); }
  std::string text() const {
    char line[200];
    std::snprintf(line, sizeof line, "%s: %s, clearance %.4f / %.4f m, %zu uncertified, error %.3g m", field.c_str(),
                  reached ? "reached" : "NOT reached", obstacle_clearance, robot_clearance, uncertified,
                  formation_error);
    return line;
  }
};

inline FieldVerdict judge_field(const formation::Scenario& scenario, const formation::SimulationOptions& options) {
  constexpr double kNothingNear = 1e9;
  const formation::Recording recording = formation::simulate(scenario, options);
  const formation::Metrics m = formation::measure(scenario, recording);
  return {scenario.name,
          m.all_arrived,
          m.min_obstacle_clearance.value_or(kNothingNear),
          m.min_robot_clearance.value_or(kNothingNear),
          m.uncertified_half_planes,
          m.last_arrival_time.value_or(0.0),
          m.formation_position_error.value_or(0.0),
          m.wall_time};
}

}  // namespace exactvo::test
