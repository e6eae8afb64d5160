// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Three scenes to start from, which the page shows where no run was given.

#include <vector>

#include "explorer/packed_run.h"
#include "explorer/page.h"

namespace exactvo::tools {

/// A wall and why ORCA stops before it, four robots on a circle, a formation through a gap: run at once, with every
/// half-plane, and two sentences each.
std::vector<MadeRun> guided_scenes(const PackedRunLimits& limits = {});

}  // namespace exactvo::tools
