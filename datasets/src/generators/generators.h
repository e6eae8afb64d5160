// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The generators behind generators.h, one function a kind. Each draws in the square [0, side] x [0, side].

#include <vector>

#include "exactvo/geometry/shapes.h"
#include "generators/counter_random.h"
#include "readers/grid.h"

namespace exactvo::datasets {

/// Corners are whole multiples of this, m.
inline constexpr double kGeneratorGrid = 0x1p-10;

/// To the grid.
geometry::Vec2 on_generator_grid(geometry::Vec2 p);

/// A unit vector of a random direction, by the rational parametrisation of the circle: no sine, no cosine.
geometry::Vec2 random_direction(CounterRandom& random);

using GeneratedShapes = std::vector<geometry::Obstacle>;
GeneratedShapes random_polygon(CounterRandom& random);
GeneratedShapes random_star(CounterRandom& random);
GeneratedShapes random_walls(CounterRandom& random);
GeneratedShapes random_needle(CounterRandom& random);

// generated_plans.cpp
GeneratedShapes random_maze(CounterRandom& random);
GeneratedShapes random_blocks(CounterRandom& random);
GeneratedShapes random_floor(CounterRandom& random);

}  // namespace exactvo::datasets
