// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The routes of a recorded run, planned again as the run did.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "exactvo/formation/planned_routes.h"

namespace exactvo::tools {

/// What the run was made with, as far as routes depend on it; nothing where it had none.
std::optional<formation::SimulationOptions> guided_options(const datasets::RunInfo& info);

/// Nothing where the run had none, or where it is larger than these limits: planning again must cost little. `vertices`
/// are those of obstacles.
std::optional<std::vector<formation::PlannedRoute>> routes_of(const datasets::RecordingFile& run,
                                                              std::size_t robots = 50, std::size_t vertices = 20'000);

}  // namespace exactvo::tools
