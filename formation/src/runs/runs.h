// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The two kinds of run behind `simulate`: each hands its rows to the sink and writes all else into the recording.

#include "exactvo/formation/recording.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

class Guide;

/// Kinematic robots with goals (Section V.A). Without a guide robots head straight for their goals.
void run_kinematic(const Scenario& scenario, const SimulationOptions& options, Guide* guide, Recording& recording,
                   RunSink& sink);

/// Second-order robots and a virtual leader (Sections IV and V.B). REQUIRES: scenario.formation.
void run_formation(const Scenario& scenario, const SimulationOptions& options, Recording& recording, RunSink& sink);

}  // namespace exactvo::formation::detail
