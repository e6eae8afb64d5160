// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Scenarios as they stand at a later moment: the text has robots at that moment, but the leader and moving obstacles
/// where their paths begin.
///
/// See also: scenario_file.h reads scenarios that begin where their text says.

#include <filesystem>
#include <functional>
#include <string>

#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// Moves the leader and moving obstacles to where they are at the moment. Their paths and speeds are valid by then;
/// robots may still overlap anything.
using AdvanceScenario = std::function<void(formation::Scenario&)>;

/// As parse_scenario, but robots are held against what moves only after `advance`, so that the scenario is valid at
/// that moment, whether or not it was at its beginning. Throws DataError.
formation::Scenario parse_scenario_at(const std::string& text, const std::string& file_name,
                                      const std::filesystem::path& base_dir, const AdvanceScenario& advance);

}  // namespace exactvo::datasets
