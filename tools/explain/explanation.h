// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A decision in words: which constraints bind, and why.

#include <string>

#include "explain/decision.h"

namespace exactvo::tools {

/// Several lines, each ended by a newline. Constraints carry the numbers that the figure shows.
std::string explanation(const Decision& decision);

}  // namespace exactvo::tools
