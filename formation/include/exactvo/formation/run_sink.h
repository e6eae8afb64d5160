// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Takes a run as it is made, so that a run of any length needs constant memory.

#include <cstddef>
#include <iosfwd>
#include <vector>

#include "exactvo/formation/recording.h"

namespace exactvo::formation {

class Crowd;

/// The robots of a run between two steps, in the order of the scenario.
struct RunState {
  std::size_t steps = 0;                ///< taken so far
  double time = 0.0;                    ///< s
  const std::vector<Vec2>& positions;   ///< m
  const std::vector<Vec2>& velocities;  ///< m/s, of the step before
  const Crowd* crowd = nullptr;         ///< robot i of the scenario has id i; null where the run is not on a crowd
};

/// Takes a run as it is made. An exception that a sink throws ends the run and is passed on.
class RunSink {
 public:
  virtual ~RunSink() = default;

  // --- Where decisions are kept (simulation.h) ---

  /// First of all. `run` has what is known before the first row: warnings, motion, time_step, tracking_gain,
  /// relative_frame, controller_options, offsets, all_half_planes.
  virtual void begin(const Recording& /*run*/) {}
  /// Bodies come in the order of their numbers, each before the first row or plan that names it.
  virtual void add_body(const vo::Body& /*body*/) {}
  /// What a robot sees on its way to a goal, before the first row that goes there.
  virtual void add_goal_bodies(const GoalBodies& /*of_goal*/) {}
  /// A joint plan, before the row in which it was made.
  virtual void add_plan(const JointPlan& /*plan*/) {}
  /// Rows come in the order of time; the last one is the final state.
  virtual void add_row(Step /*row*/) {}

  // --- Of robots with goals, whether decisions are kept or not ---

  /// The start, and after every step.
  virtual void add_state(const RunState& /*now*/) {}
  /// Before a step, when all have their preferred velocities: `Crowd::explain` says what it will decide.
  virtual void before_step(const RunState& /*now*/) {}
  /// For a snapshot, after a step: what it needs to go on from here. What it has taken so far must be safe then.
  virtual void save(std::ostream& /*to*/) {}
  /// In the place of the first `add_state` in a run that goes on from a snapshot: what `save` wrote.
  virtual void restore(const RunState& /*now*/, std::istream& /*from*/) {}
};

}  // namespace exactvo::formation
