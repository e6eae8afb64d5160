// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a user adds to the decisions of a run (simulation.h): own steering, and own half-planes. The run calls both
/// once per step, before any robot decides.
///
/// In a decision half-planes against obstacles and robots come first: a user's half-plane never relaxes one
/// of these. What the user states as hard comes next, then what the user states as soft. A decision is therefore
/// made in up to three stages, and the first that has an answer counts (`OwnStage`).
///
/// See also: crowd.h takes preferred velocities by itself, navigator.h decides for one robot in a loop of the user's.

#include <cstddef>
#include <functional>
#include <vector>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::formation {

using geometry::Vec2;

/// Robots `first` to `last - 1` of a run, before a step. The lists are of all robots, in the order of the scenario.
struct RobotSlice {
  std::size_t first = 0;                ///< in the order of the scenario
  std::size_t last = 0;                 ///< one behind the last one
  double time = 0.0;                    ///< s
  const std::vector<Vec2>& positions;   ///< m
  const std::vector<Vec2>& velocities;  ///< m/s
};

/// Sets the preferred velocities (m/s, finite) of the robots of the slice: `preferred[first]` to `preferred[last - 1]`.
/// They hold what the run would prefer, straight for the next corner of the route or for the goal. The other entries
/// have no meaning. A velocity beyond the speed bound is preferred all the same: the nearest one that is allowed is
/// chosen. All robots are one slice, but over ranks (crowd_run.h) each rank has a slice of its own.
using RunSteering = std::function<void(const RobotSlice& robots, std::vector<Vec2>& preferred)>;

/// A half-plane of velocities that a user asks of a robot in one step.
struct OwnHalfPlane {
  std::size_t robot = 0;           ///< in the order of the scenario
  geometry::HalfPlane half_plane;  ///< of velocities, m/s; finite, the normal not 0
  bool hard = true;                ///< false: gives before hard ones do
};

/// Adds half-planes for the step that follows. `preferred`: m/s, as RunSteering leaves them.
using RunHalfPlanes = std::function<void(const RobotSlice& robots, const std::vector<Vec2>& preferred,
                                         std::vector<OwnHalfPlane>& half_planes)>;

/// Which stage a decision with half-planes of a user was made in.
enum class OwnStage {
  none,     ///< there were none
  held,     ///< all others and the user's hard ones hold; where soft ones gave, by the least possible
  gave,     ///< all others hold; the user's cannot, and their largest violation is the least possible
  left_out  ///< the others alone leave no room: the decision is made as if the user had asked for nothing
};

/// Whether half-planes against obstacles and robots all hold in a decision of the stage: only the user's may give.
constexpr bool holds_bodies(OwnStage stage) {
  return stage == OwnStage::held || stage == OwnStage::gave;
}

/// A half-plane of a user in a decision. One that no double satisfies together with the others is recorded moved
/// outward: by some nanometres per second, or by more if that does not make room.
struct OwnConstraint {
  geometry::HalfPlane half_plane;  ///< of velocities, m/s
  bool hard = true;                ///< as the user stated it
  bool active = false;             ///< binds the chosen velocity
  double multiplier = 0.0;         ///< as DecisionConstraint::multiplier
};

}  // namespace exactvo::formation
