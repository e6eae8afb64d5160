// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The two kinds of run behind `simulate`.

#include "exactvo/formation/recording.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

/// Kinematic robots with goals (Section V.A).
Recording run_kinematic(const Scenario& scenario, const SimulationOptions& options);

/// Second-order robots and a virtual leader (Sections IV and V.B). REQUIRES: scenario.formation.
Recording run_formation(const Scenario& scenario, const SimulationOptions& options);

}  // namespace exactvo::formation::detail
