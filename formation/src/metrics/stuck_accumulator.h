// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Who is stuck at the end of a run, from its rows as they are made (stuck.h).

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "exactvo/formation/stuck.h"

namespace exactvo::formation::detail {

/// Takes the rows of a run one after the other, and keeps the last two: where it ended, and what was decided last.
class StuckAccumulator {
 public:
  explicit StuckAccumulator(const Scenario& scenario) : scenario_(scenario), robots_(scenario.robots.size()) {}
  void add(std::shared_ptr<const Step> row);
  /// `run` has how the run ended, and what was known before it. REQUIRES: a row.
  std::vector<StuckReport> reports(const Recording& run) const;
  /// Robots at rest at the end of which each waits for the next (waiting.h); empty where there are none.
  std::vector<std::size_t> deadlock() const;

  /// A robot's least distance from its last goal, and when that was.
  struct Nearest {
    double time = 0.0;                                          ///< s
    double distance = std::numeric_limits<double>::infinity();  ///< m
  };
  struct OfRobot {
    std::optional<double> at_rest_since;  ///< s
    Nearest nearest;                      ///< of kinematic robots: a slot moves
  };

 private:
  const Scenario& scenario_;
  std::vector<OfRobot> robots_;
  std::shared_ptr<const Step> decided_, last_;
};

}  // namespace exactvo::formation::detail
