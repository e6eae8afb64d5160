// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

/// What `validate` finds in the fields alone: not whether robots start clear of obstacles.
std::vector<ScenarioProblem> field_problems(const Scenario& scenario);

}  // namespace exactvo::formation::detail
