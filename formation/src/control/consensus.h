// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The terms of a formation's controller: the consensus law (14) and the preferred velocity towards the slot (17), as
/// the options of controller_options.h have them (paper, Section IV; docs/guide/errata.md). runs/formation_run.cpp adds
/// them up.

#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "motion/leader.h"

namespace exactvo::formation::detail {

/// Positions and velocities relative to each robot's slot: x^ = x_i - x_L - Delta_i, v^ = v_i - v_L.
struct RelativeState {
  std::vector<Vec2> position;  ///< m
  std::vector<Vec2> velocity;  ///< m/s
};

/// The options of a run's controller: those that the run was given, else the controller's with the scenario's switches.
/// On wheels there is no brake point ahead of the robot: it drives at what it chooses.
ControllerOptions controller_options_in_use(const Scenario& scenario, const SimulationOptions& options);

/// Less their mean.
std::vector<Vec2> recentred(std::vector<Vec2> offsets);

/// Delta_i as the controller uses them: recentred where the scenario and the controller options both say so.
std::vector<Vec2> offsets_in_use(const FormationSpec& spec, const ControllerOptions& options);
/// The offsets that a run uses; empty without a formation.
std::vector<Vec2> offsets_in_use(const Scenario& scenario, const SimulationOptions& options);

/// u_c of equation (14), m/s^2, with `position_sign` = -1, or +1 as (15) prints it.
Vec2 consensus_input(const FormationSpec& spec, const RelativeState& state, std::size_t robot, double position_sign);

/// v_pref of equation (17) under the options: printed, away from the slot at full speed (0 at the slot, where the
/// quotient is undefined); saturated, -min(kappa |x^|, v_s) x^ / |x^|; in the absolute frame v_L is added.
Vec2 preference(const FormationSpec& spec, const ControllerOptions& options, Vec2 relative_position,
                Vec2 leader_velocity, double max_speed);

}  // namespace exactvo::formation::detail
