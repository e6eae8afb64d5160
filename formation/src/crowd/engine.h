// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One step of a crowd: sort, find neighbours, make half-planes, solve, round to the lattice: that is what each robot
/// wishes. Then the second level (hard_level.h) makes wishes into motions that keep all robots apart, and they move.
///
/// What a robot wishes is decided in one of two ways that give the same bits: in a pack of sixteen that share their
/// candidates, or alone, with any number of neighbours: where it stands too densely for a pack, where more can be met
/// within the step than its kind has neighbours, where more half-planes against edges or bodies come up than a pack has
/// room for, where another stands in its very place, and for `explain`.

#include <chrono>
#include <memory>
#include <vector>

#include "crowd/bodies.h"
#include "crowd/edges.h"
#include "crowd/kinds.h"
#include "crowd/lines.h"
#include "crowd/reserved_ways.h"
#include "crowd/robots.h"
#include "crowd/wheels.h"
#include "exactvo/formation/crowd.h"

namespace exactvo::formation {

/// What does not depend on the arithmetic.
class CrowdCore {
 public:
  explicit CrowdCore(const CrowdOptions& given)
      : options(given), bodies(given.position_step, given.time_step), tasks(given.threads) {}
  virtual ~CrowdCore() = default;

  virtual void take_kinds() = 0;
  virtual void set_preferred(const std::vector<Vec2>& by_id) = 0;
  virtual void forget_preference(RobotId robot) = 0;
  virtual std::vector<Vec2> preferred() const = 0;
  /// Robots are sorted; writes next_mx, next_my, next_kept, hint. Of several ranks each decides for its share.
  virtual StepReport decide() = 0;
  /// Something that a decision follows from has changed.
  void changed() { decided = false; }
  virtual CrowdExplanation explain(std::size_t robot) = 0;
  virtual std::size_t bytes() const = 0;

  /// m, exact.
  Vec2 position_of(std::size_t robot) const {
    return {options.position_step * robots.x[robot], options.position_step * robots.y[robot]};
  }
  /// m/s
  Vec2 velocity_of(std::int32_t mx, std::int32_t my) const {
    return {options.position_step * mx / options.time_step, options.position_step * my / options.time_step};
  }

  CrowdOptions options;
  std::vector<CrowdKind> kinds;
  crowd::Robots robots;
  crowd::EdgeGrid edges;              ///< laid out
  crowd::Bodies bodies;               ///< laid out
  crowd::ReservedWays reserved_ways;  ///< laid out
  crowd::Wheels wheels;               ///< of all kinds, as take_kinds has it
  crowd::Tasks tasks;
  Steering steering;
  CrowdPhases phases;
  std::size_t range = 0;  ///< robots a task; 0: chosen automatically. The results are the same.
  bool decided = false;   ///< next_mx, next_my, next_kept are those of the present state, for `explain`
};

/// s
inline double edge_horizon(const CrowdKind& kind) {
  return kind.edge_horizon > 0.0 ? kind.edge_horizon : kind.time_horizon;
}

/// An engine in float or double, as the options say.
std::unique_ptr<CrowdCore> make_core(const CrowdOptions& options);

/// Adds the time it lives to a phase, where phases are timed.
class Timed {
 public:
  Timed(bool on, double& phase) : phase_(on ? &phase : nullptr), start_(on ? now() : 0.0) {}
  ~Timed() {
    if (phase_) *phase_ += now() - start_;
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  double* phase_;
  double start_;
};

}  // namespace exactvo::formation
