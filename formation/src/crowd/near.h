// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The neighbours of one robot, however many: by the order that packs have (packs.h).

#include <cstdint>
#include <utility>
#include <vector>

#include "crowd/kinds.h"
#include "crowd/robots.h"

namespace exactvo::formation::crowd {

/// A robot near another, by cut squared distance (lattice steps) and place in the sorted order.
using Near = std::pair<float, std::int32_t>;

/// Into `near`, nearest first: the k nearest, k the number of neighbours of the robot's kind, and all that can be met
/// within the step. `last`: the squared distance (lattice steps) of the k-th. True where k or more can be met.
bool neighbours_of(const Robots& robots, const ReachTable& table, std::size_t robot, std::vector<Near>& near,
                   float& last);

/// Lattice steps, from a squared distance or a key of a search: what the next step's search begins with.
std::int32_t hint_of(const ReachTable& table, float key, std::size_t kind);

}  // namespace exactvo::formation::crowd
