// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The consensus law (14) and the preferences of the three controllers (paper, Section IV; docs/guide/errata.md).

#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "leader.h"

namespace exactvo::formation::detail {

/// Positions and velocities relative to each robot's slot: x^ = x_i - x_L - Delta_i, v^ = v_i - v_L.
struct RelativeState {
  std::vector<Vec2> position;  ///< m
  std::vector<Vec2> velocity;  ///< m/s
};

/// Delta_i as the controller uses them: recentred unless the paper is taken as printed.
std::vector<Vec2> offsets_in_use(const FormationSpec& spec, Controller controller);

/// u_c of equation (14), m/s^2, with `position_sign` = -1, or +1 as (15) prints it.
Vec2 consensus_input(const FormationSpec& spec, const RelativeState& state, std::size_t robot, double position_sign);

/// Equation (17) as printed: away from the slot at full speed; 0 at the slot, where the printed quotient is undefined.
Vec2 printed_preference(Vec2 relative_position, double max_speed);

/// v_L - min(kappa |x^|, v_s) x^ / |x^|.
Vec2 saturated_preference(const FormationSpec& spec, Vec2 relative_position, Vec2 leader_velocity);

}  // namespace exactvo::formation::detail
