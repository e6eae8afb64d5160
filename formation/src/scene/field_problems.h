// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "exactvo/formation/simulation.h"
#include "scene/decision_rules.h"

namespace exactvo::formation::detail {

/// What `validate` finds in the fields alone: not whether robots start clear of obstacles.
std::vector<ScenarioProblem> field_problems(const Scenario& scenario);

/// The same for the numbers of a decision and the tolerance of arrival (m) alone.
std::vector<ScenarioProblem> field_problems(const DecisionRules& rules, double arrival_tolerance);

/// What the proof of braking needs, for rules with an acceleration. `fastest`: m/s, of all robots; `is_given`: the
/// braking time is not the usual one. REQUIRES: finite numbers above 0.
std::vector<ScenarioProblem> braking_problems(const DecisionRules& rules, double fastest, bool is_given);

/// The same for a robot's radius (m) and greatest speed (m/s): "/radius" and "/max_speed".
std::vector<ScenarioProblem> field_problems(double radius, double max_speed);

/// The option by which robots of a formation on wheels would not drive at what they choose, within the horizons that
/// braking needs: one that is off, or "acceleration_bound". Empty where there is none.
std::string unfit_for_wheels(const ControllerOptions& options);

}  // namespace exactvo::formation::detail
