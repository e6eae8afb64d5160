// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Swept clearances of a recording: every robot against obstacles, moving obstacles and the other robots, over each
/// step as it was driven. Certified lower bounds, all roundings taken off.

#include <memory>
#include <optional>
#include <vector>

#include "exactvo/formation/metrics.h"

namespace exactvo::formation::detail {

struct Clearances {
  std::vector<std::optional<double>> to_obstacles;  ///< m, per robot; moving ones included
  std::optional<double> between_robots;             ///< m
  std::vector<Collision> collisions;                ///< in the order of their beginnings
};

/// Takes the rows of a run one after the other, and keeps none.
class ClearanceSweep {
 public:
  /// Of `run` what is known before the first row: motion, time step, tracking gain. Both must outlive it.
  ClearanceSweep(const Scenario& scenario, const Recording& run);
  ~ClearanceSweep();
  void add(const Step& row);
  /// Over all rows so far.
  Clearances result() const;

 private:
  class Sweep;
  std::unique_ptr<Sweep> sweep_;
};

}  // namespace exactvo::formation::detail
