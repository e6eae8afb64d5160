// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles as a map, and over it what was made of them: facades, convex pieces, hulls and ellipses.

#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/obstacle_shapes.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// Solid grey with holes left free, and walls as lines.
Figure map_figure(const std::vector<formation::SceneObstacle>& obstacles, const std::string& title);

/// The same for decomposed obstacles: pieces filled in pale colours, facades as bold lines, hulls dashed, the smallest
/// ellipses, the facades' and the trap-free ones.
Figure shapes_figure(const std::vector<geometry::ObstacleShapes>& obstacles, const std::string& title);

}  // namespace exactvo::tools
