// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What `simulate` is timed on: the paper's scenes, the office, a hundred robots, and crowds of obstacles: maps drawn
/// by seed, and public maps where they stand beside the checkout.

#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::bench {

/// Robots that cross `obstacles` for fifteen seconds, at `count` starts and goals drawn by seed where there is room.
formation::Scenario crossing(std::string name, std::vector<formation::SceneObstacle> obstacles, std::size_t count);

/// Five scenes that anybody can make: floors, a maze, city blocks, a field of polygons and walls.
std::vector<formation::Scenario> generated_scenes();

/// Five of public maps: empty where ../shared/data is not beside the checkout.
std::vector<formation::Scenario> public_scenes();

/// A1 to A15, B0 to B3, the office and the hundred.
std::vector<formation::Scenario> project_scenes();

}  // namespace exactvo::bench
