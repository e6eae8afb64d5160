// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Maps after Dergachev and Yakovlev ("Distributed Multi-agent Navigation Based on Reciprocal Collision Avoidance and
/// Locally Confined Multi-agent Path Finding", CASE 2021), rebuilt from a description: 64 x 64 cells, robots of radius
/// 0.3 cells, passages of one cell. Lengths in diameters of a robot.

#include "exactvo/formation/scenario.h"
#include "support/seeded_random.h"

namespace exactvo::bench {

/// A wall in the middle with one gap; half the robots go from each side to the other.
formation::Scenario gap_map(int robots, test::SeededRandom& random);

/// Sixteen rooms with a door between any two neighbours; robots go from anywhere to anywhere.
formation::Scenario room_map(int robots, test::SeededRandom& random);

}  // namespace exactvo::bench
