// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One robot's velocity space at one moment: each truncated velocity obstacle with its legs and cut-off, the
/// half-planes with their forbidden side hatched, the speed bound, what was preferred and what was chosen.

#include "explain/decision.h"
#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

Figure velocity_space_figure(const Decision& decision);

}  // namespace exactvo::tools
