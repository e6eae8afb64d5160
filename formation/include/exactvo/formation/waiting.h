// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which robots wait for which, from the half-planes that a row was decided on.
///
/// Robot i waits for robot j if all three hold: j's half-plane excludes the preferred velocity of i or has a multiplier
/// above 0; i drives less than `kHeldBelow` of its preferred velocity, measured along it; and the gap between their
/// rims is less than the radius of i, or than one and a half margins between robots if that is more. A cycle of such
/// robots is a deadlock: none goes before the next does. Exact about what was recorded; that a cycle stays one is a
/// prediction.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// A robot is held up if it gets less than this share of its preferred velocity.
inline constexpr double kHeldBelow = 0.3;

/// For each robot, the robots that it waits for; the one that holds it most comes first.
using WaitForGraph = std::vector<std::vector<std::size_t>>;

/// Which robot waits for which. In a formation no robot waits before the leader has come to the end of its path; in the
/// last row of a run, which decides nothing, no robot waits either. REQUIRES: a row of a run of this scenario.
WaitForGraph waiting_in(const Scenario& scenario, const Step& row);

/// The cycles found by going from each robot to the one that holds it most. They are disjoint; each begins with its
/// lowest number, and they are in the order of these numbers.
std::vector<std::vector<std::size_t>> deadlocks_in(const WaitForGraph& graph);

/// Whether the robot drives at less than a fifteenth of its greatest speed.
bool stands(const Robot& robot, Vec2 velocity);

/// Whether this robot, those that it waits for, and those that they wait for in turn, all stand.
bool is_dead(const Scenario& scenario, const WaitForGraph& graph, const Step& row, std::size_t robot);

/// "R13 waits for R6, which waits for R13: a deadlock of two". A long cycle names only its first robots.
std::string deadlock_words(const Scenario& scenario, const std::vector<std::size_t>& cycle);

/// For a robot in a deadlock the same, beginning with it. For other robots "R3 waits for R1, which rests at its goal",
/// "queue of 4: R9 waits for R2, which moves". Empty if the robot waits for no other.
std::string waiting_words(const Scenario& scenario, const Step& row, const WaitForGraph& graph, std::size_t robot);

/// Why a robot with the mode `staying` stays: "its goal is out of reach", "R2 was first at its goal, 0.3 m from that of
/// R1", "its goal is out of reach or taken" where the row does not tell which, "its slot cannot be filled". REQUIRES: a
/// row of a run of this scenario, not its last.
std::string why_it_stays(const Scenario& scenario, const Step& row, std::size_t robot);

}  // namespace exactvo::formation
