// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Single warnings known before a run. `warnings_before` (simulation.h) has all that warns, but takes
/// longer than crowds have time for.

#include <string>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {

/// Robots that have arrived before they move, though they do not start in their very goals: as a rule the scene is in
/// another unit of length. Empty where there are none; one of `warnings_before`. O(goals).
std::string arrived_at_start(const Scenario& scenario);

/// By how much a formation's slots are moved, where that is more than the arrival tolerance; else empty. No warning:
/// equation (4) needs it.
std::string recentring_notice(const Scenario& scenario, const SimulationOptions& options = {});

/// What a run assumes and cannot check; empty without `Scenario::uncertainty` and moving obstacles with a `max_speed`.
/// Part of its outcome.
std::string assumed_words(const Scenario& scenario);

}  // namespace exactvo::formation
