// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "exactvo/formation/metrics.h"

namespace exactvo::formation::detail {

/// How a run ended, from its measurements and from what the run says: collisions first, so that nothing sounds like
/// success where it was none; long detours of a formation last.
std::string outcome_words(const Metrics& m, const std::string& end);

}  // namespace exactvo::formation::detail
