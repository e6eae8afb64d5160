// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What robots of a run measure of each other: places and velocities of some rows before, off by random errors within
/// the bounds. The same run has the same errors.

#include <deque>
#include <vector>

#include "exactvo/formation/recording.h"
#include "scene/decision_rules.h"

namespace exactvo::formation::detail {

class Measuring {
 public:
  /// Both must outlive it. REQUIRES: rules with measurements.
  Measuring(const DecisionRules& rules, const std::vector<Robot>& robots) : rules_(rules), robots_(robots) {}

  /// Each robot of the next row measures all others in sight, nearest first.
  void look(const std::vector<Vec2>& positions, const std::vector<Vec2>& velocities);
  /// For each robot, what it measured in this row.
  const std::vector<std::vector<MeasuredRobot>>& measured() const { return measured_; }

 private:
  struct Row {
    std::vector<Vec2> positions, velocities;
  };

  const DecisionRules& rules_;
  const std::vector<Robot>& robots_;
  std::size_t row_ = 0;   ///< the next
  std::deque<Row> rows_;  ///< the oldest that may be measured first
  std::vector<std::vector<MeasuredRobot>> measured_;
};

}  // namespace exactvo::formation::detail
