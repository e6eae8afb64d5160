// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

/// The remedies of a run: those asked for, else the controller's.
Remedies remedies_in_use(const SimulationOptions& options);

}  // namespace exactvo::formation::detail
