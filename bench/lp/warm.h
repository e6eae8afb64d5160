// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a warm start is worth: decisions of a recorded scenario in order of time, each told which lines bound in the
/// decision of the same robot one step before.

#include <string>

namespace exactvo::bench {

/// Prints ns a solve with and without hints and how often the active set stays. REQUIRES: is_recorded_set(name).
void run_warm(const std::string& name, int rounds);

}  // namespace exactvo::bench
