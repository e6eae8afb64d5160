// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One robot's choice of a velocity at one moment, in detail: what each half-plane stands for and what it did.
/// Rounded, for readers; the proofs are elsewhere (geometry/predicates.h).
///
/// Neighbours: explanation.h says it in words, figures/velocity_space.h draws it.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/support.h"

namespace exactvo::tools {

using geometry::Vec2;

struct Decision {
  formation::Scenario scenario;
  std::string method;     ///< in words, with the controller where there is one
  std::size_t robot = 0;  ///< index
  double time = 0.0;      ///< s, when the decision was taken
  formation::RobotStep step;

  const formation::Robot& who() const { return scenario.robots[robot]; }
};

/// The convex set that the robot must not reach, seen from it.
geometry::GrownShape grown_shape(const formation::RecordedConstraint& constraint);

/// m/s by which v lies on the forbidden side of the half-plane's line; negative on the allowed side.
double violation_of(const formation::RecordedConstraint& constraint, Vec2 v);

/// From the robot's rim to the shape, m, to about a thousandth of its size; negative inside.
double distance_to(const geometry::GrownShape& s);

/// When a robot that keeps the velocity v first touches the shape, s; nothing where it never does.
/// REQUIRES: the origin lies outside.
std::optional<double> time_to_contact(const geometry::GrownShape& s, Vec2 v);

/// What holds the choice where it is: chosen - preferred = sum of factor * normal, with every factor >= 0. These are
/// the conditions of Karush, Kuhn and Tucker: they show that no allowed velocity lies nearer to the preferred one.
struct Balance {
  struct Force {
    std::optional<std::size_t> constraint;  ///< index into step.constraints; none for the speed bound
    Vec2 normal;                            ///< into the allowed side
    double factor = 0.0;                    ///< m/s
  };
  std::vector<Force> forces;
  double remainder = 0.0;  ///< m/s: what the sum leaves over; about 0 where the balance explains the choice
};
Balance balance(const Decision& decision);

}  // namespace exactvo::tools
