// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

/// The remedies of a run: those of the options, else the controller's with the scenario's switches.
Remedies remedies_in_use(const Scenario& scenario, const SimulationOptions& options);

}  // namespace exactvo::formation::detail
