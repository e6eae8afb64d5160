// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// What a scenario asks for that cannot be had, in words, one line each: goals, or slots at the leader's end, inside
/// obstacles or nearer to them than the robot's radius allows, shut off from the start by obstacles with gaps narrower
/// than the robot (walled_in.h), or where a moving obstacle comes to rest; pairs of them nearer than two robots fit; a
/// leader whose end lies beyond the time limit, or that is faster than a robot; a robot that starts faster than it may
/// go, or inside the hull of a moving obstacle; a moving obstacle faster than a robot. `offsets` are those in use;
/// empty without a formation. Sufficient, not necessary: margins, other robots and what a method can find are not
/// considered.
std::vector<std::string> preflight_warnings(const Scenario& scenario, const std::vector<Vec2>& offsets);

}  // namespace exactvo::formation::detail
