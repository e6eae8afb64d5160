// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/outcome.h"

#include <fmt/format.h>

namespace exactvo::tools {

using formation::touched;

std::string touch_words(const formation::Metrics& m) {
  if (!touched(m)) return "";
  std::string text = "touched ";
  if (touched(m.min_obstacle_clearance)) text += fmt::format("an obstacle by {:.2g} m", -*m.min_obstacle_clearance);
  if (!touched(m.min_robot_clearance)) return text;
  if (touched(m.min_obstacle_clearance)) text += " and ";
  return text + fmt::format("another robot by {:.2g} m", -*m.min_robot_clearance);
}

std::string outcome_words(const FinishedRun& run) {
  const formation::Metrics& m = run.metrics;
  const std::string& end = run.file.recording.outcome;
  return touched(m) ? "COLLISION: " + touch_words(m) + "; " + end : end;
}

}  // namespace exactvo::tools
