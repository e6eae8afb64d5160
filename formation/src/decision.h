// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Equation (12)/(13): from half-planes and a preferred velocity to the chosen one, with the record of why.

#include <vector>

#include "static_field.h"

namespace exactvo::formation::detail {

/// A half-plane against another robot, already this robot's half of the pair.
struct RobotConstraint {
  RecordedConstraint recorded;
  double distance = 0.0;  ///< m, between the centres
};

/// All half-planes of every robot against every other within `neighbour_distance`, nearest first: entry i belongs to
/// robot i. `positions` and `velocities` are those the pairs are built at; both halves of a pair share their normal bit
/// for bit. A robot that does not cooperate gets none, and who meets it takes the whole avoiding.
std::vector<std::vector<RobotConstraint>> robot_constraints(const Scenario& scenario, const SimulationOptions& options,
                                                            const std::vector<Vec2>& positions,
                                                            const std::vector<Vec2>& velocities);

/// s: within this a robot in contact is asked to part: never less than a step.
double contact_time(const Scenario& scenario);

lp::SpeedBound speed_bound(const Scenario& scenario, double max_speed);

struct DecisionInput {
  Vec2 preferred;        ///< m/s
  double max_speed = 0;  ///< m/s
  const std::vector<StaticConstraint>* statics = nullptr;
  const std::vector<RobotConstraint>* robots = nullptr;
  bool keep_all = false;
};

/// Fills `chosen`, `status`, `violation`, `constraints` and `uncertified` of the step; the other fields are the
/// caller's.
void decide(const Scenario& scenario, const DecisionInput& in, RobotStep& step);

}  // namespace exactvo::formation::detail
