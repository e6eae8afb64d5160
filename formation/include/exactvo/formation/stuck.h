// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Why a robot did not arrive: what binds at the end of its run, and, where that is one shape, the equilibrium it rests
/// on (trap.h). Rounded.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/trap.h"

namespace exactvo::formation {

struct BindingConstraint {
  RecordedConstraint constraint;
  Vec2 normal;                     ///< unit, out of the shape at the point nearest the robot
  double clearance = 0.0;          ///< m, rim to shape
  double radius_of_curvature = 0;  ///< m, of the shape grown by the robot, at that normal; infinite on a flat edge
};

struct StuckReport {
  std::size_t robot = 0;
  Vec2 position;                           ///< m, where it ended
  double goal_distance = 0.0;              ///< m, D
  double speed = 0.0;                      ///< m/s, of the last decision
  std::vector<BindingConstraint> binding;  ///< of the last decision
  /// Where one shape binds and the robot rests against it: position, rho, D, stability.
  std::optional<Equilibrium> equilibrium;
  std::string text;  ///< all of it in a sentence or two
};

/// A report for every robot that is not at its goal or slot in the last row; none of a formation that diverged or whose
/// leader is still under way. REQUIRES: a recording of this scenario.
std::vector<StuckReport> explain_stuck(const Scenario& scenario, const Recording& recording);

}  // namespace exactvo::formation
