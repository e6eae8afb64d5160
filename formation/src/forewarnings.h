// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// What a scenario asks for that nothing can reach, in words, a line each: goals, or slots at the leader's end, inside
/// obstacles or nearer to them than the robot's radius allows, pairs of them nearer than two robots fit, and a leader
/// whose end lies beyond the time limit. `offsets` are those in use; empty without a formation. Sufficient, not
/// necessary: a goal in a closed room is not found so.
std::vector<std::string> forewarnings(const Scenario& scenario, const std::vector<Vec2>& offsets);

}  // namespace exactvo::formation::detail
