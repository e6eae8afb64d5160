// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What both kinds of run share: time steps, the end by time limit or by the caller, when the caller hears of them,
/// when everything is kept. That robots have arrived or diverged ends a run too: the loops in robot_run.cpp and
/// formation_run.cpp ask for that.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

/// Share of a step: a time this near to a row is that row's, since 6 * 0.05 is not 0.3 in doubles.
inline constexpr double kSameRow = 1e-6;

class RunSchedule {
 public:
  /// Ten times a second.
  static constexpr std::chrono::milliseconds kBeat{100};

  /// `beat`: how much wall time passes between two calls of `options.progress` at least.
  RunSchedule(const Scenario& scenario, const SimulationOptions& options, std::chrono::milliseconds beat = kBeat)
      : options_(&options),
        dt_(scenario.time_step),
        beat_(beat),
        steps_(static_cast<std::size_t>(std::ceil(scenario.time_limit / scenario.time_step - kSameRow))) {
    if (options.stop_at) last_decision_ = row_of(*options.stop_at);
  }

  double time(std::size_t step) const { return static_cast<double>(step) * dt_; }

  /// Whether `step` is the last row: the time is up, or `stop_at` is passed.
  bool ends_at(std::size_t step) const { return step == steps_ || (last_decision_ && step > *last_decision_); }

  /// Whether the caller wants to stop. Cheap: to be asked by what takes long within a step.
  bool is_stopped(double time) {
    is_stopped_ = is_stopped_ || !beat(time);
    return is_stopped_;
  }

  /// Whether the decision at `time` keeps every half-plane: all do where asked for, and the last one of `stop_at`.
  bool keeps_all(double time) const {
    return options_->record_all || (last_decision_ && row_of(time) == *last_decision_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// The last row at or before `time`, at most row 10^15, which no run has.
  std::size_t row_of(double time) const { return static_cast<std::size_t>(std::min(time / dt_ + kSameRow, 1e15)); }

  /// Calls the caller's progress function where it is due; false when the caller wants to stop.
  bool beat(double time) {
    if (!options_->progress || Clock::now() - last_ < beat_) return true;
    last_ = Clock::now();
    return options_->progress(time);
  }

  const SimulationOptions* options_;
  double dt_;
  std::chrono::milliseconds beat_;
  std::size_t steps_;
  std::optional<std::size_t> last_decision_;
  bool is_stopped_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace exactvo::formation::detail
