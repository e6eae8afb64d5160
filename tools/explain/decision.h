// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One robot's choice of a velocity at one moment, in detail: what each half-plane stands for and what it did.
/// Rounded, for readers; the proofs are elsewhere (geometry/predicates.h).
///
/// See also: explanation.cpp says it in words, figures/velocity_space.h draws it.

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
  std::vector<vo::Body> bodies;  ///< of the run

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

/// Which constraints bind, and why: several lines, each ended by a newline. Constraints carry the numbers that the
/// figure shows.
std::string explanation(const Decision& decision);

}  // namespace exactvo::tools
