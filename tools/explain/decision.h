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
  /// False: of what neither binds nor is violated, only half-planes against what could be met within a step.
  bool has_all_half_planes = true;
  std::vector<std::size_t> waits_for = {};     ///< robots (formation/waiting.h)
  std::string waiting = {};                    ///< the same in words; empty where it waits for none
  std::vector<formation::SeenBody> seen = {};  ///< of each half-plane, what it keeps clear of

  const formation::Robot& who() const { return scenario.robots[robot]; }
};

/// The decision of one robot in a row of a run that has these bodies.
Decision decision_of(const formation::Scenario& scenario, const std::string& method, std::size_t robot,
                     const formation::Step& row, const std::vector<vo::Body>& bodies, bool has_all_half_planes);

/// The convex set that the robot must not reach, seen from it.
geometry::GrownShape grown_shape(const formation::SeenBody& seen);

/// m/s by which v lies on the forbidden side of the half-plane's line; negative on the allowed side.
double violation_of(const formation::DecisionConstraint& constraint, Vec2 v);

/// What the chosen velocity does to a half-plane. That a linear program counts it as active says nothing of the line
/// itself: where half-planes contradict each other, the active ones are those that are violated most.
enum class Effect { slack, binding, violated };

Effect effect_of(const Decision& decision, const formation::DecisionConstraint& constraint);

/// "slack", "binding", "violated".
std::string name(Effect effect);

/// From the robot's rim to the shape, m, to about a thousandth of its size; negative inside.
double distance_to(const geometry::GrownShape& s);

/// When a robot that keeps the velocity v first touches the shape, s; nothing where it never does.
/// REQUIRES: the origin lies outside.
std::optional<double> time_to_contact(const geometry::GrownShape& s, Vec2 v);

/// Which constraints bind, and why: several lines, each ended by a newline. Constraints carry the numbers that the
/// figure shows.
std::string explanation(const Decision& decision);

}  // namespace exactvo::tools
