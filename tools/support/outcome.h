// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How a run ended, in words that do not sound like success where it was none.

#include <string>

#include "support/run.h"

namespace exactvo::tools {

/// "touched an obstacle by 0.12 m and another robot by 0.03 m"; empty where nothing was touched.
std::string touch_words(const formation::Metrics& metrics);

/// What the recording says, and a collision before it: "all robots arrived", "COLLISION: touched an obstacle by
/// 0.12 m; all robots arrived", "diverged: ...".
std::string outcome_words(const FinishedRun& run);

}  // namespace exactvo::tools
