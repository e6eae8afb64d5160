// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/outcome.h"

#include <fmt/format.h>

#include <optional>

namespace exactvo::tools {

namespace {

bool is_overlap(const std::optional<double>& clearance) {
  return clearance && *clearance < -formation::kContactDepth;
}

}  // namespace

bool touched(const formation::Metrics& m) {
  return is_overlap(m.min_obstacle_clearance) || is_overlap(m.min_robot_clearance);
}

std::string touch_words(const formation::Metrics& m) {
  if (!touched(m)) return "";
  std::string text = "touched ";
  if (is_overlap(m.min_obstacle_clearance)) text += fmt::format("an obstacle by {:.2g} m", -*m.min_obstacle_clearance);
  if (!is_overlap(m.min_robot_clearance)) return text;
  if (is_overlap(m.min_obstacle_clearance)) text += " and ";
  return text + fmt::format("another robot by {:.2g} m", -*m.min_robot_clearance);
}

std::string outcome_words(const FinishedRun& run) {
  const formation::Metrics& m = run.metrics;
  const std::string& end = run.file.recording.outcome;
  return touched(m) ? "COLLISION: " + touch_words(m) + "; " + end : end;
}

}  // namespace exactvo::tools
