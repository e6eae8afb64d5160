// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What both kinds of run share: when they end, when the caller hears of them, when everything is kept.

#include <chrono>
#include <cmath>
#include <cstddef>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

class RunClock {
 public:
  RunClock(const Scenario& scenario, const SimulationOptions& options)
      : options_(&options),
        dt_(scenario.time_step),
        // A limit that is a multiple of the step up to rounding is that multiple.
        steps_(static_cast<std::size_t>(std::ceil(scenario.time_limit / scenario.time_step - 1e-9))) {}

  double time(std::size_t step) const { return static_cast<double>(step) * dt_; }

  /// Whether `step` is the last row: the time is up, `stop_at` is passed, or the caller wants to stop.
  bool ends_at(std::size_t step) {
    const bool passed = options_->stop_at >= 0.0 && time(step) > options_->stop_at;
    return step == steps_ || passed || !beat(time(step));
  }

  /// Whether the decision at `time` keeps every half-plane: all do where asked for, and the last before `stop_at`.
  bool keeps_all(double time) const {
    return options_->record_all || (options_->stop_at >= 0.0 && time + dt_ > options_->stop_at);
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// Calls the caller's progress function about ten times a second of wall time; false when the caller wants to stop.
  bool beat(double time) {
    constexpr std::chrono::milliseconds kInterval{100};
    if (!options_->progress || Clock::now() - last_ < kInterval) return true;
    last_ = Clock::now();
    return options_->progress(time);
  }

  const SimulationOptions* options_;
  double dt_;
  std::size_t steps_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace exactvo::formation::detail
