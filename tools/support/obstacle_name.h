// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "exactvo/formation/scenario.h"

namespace exactvo::tools {

/// How answers, figures and pages name an obstacle: its id, behind "wall" or "polygon" where that is only a number.
inline std::string obstacle_name(const formation::SceneObstacle& obstacle) {
  if (obstacle.id.find_first_not_of("0123456789-") != std::string::npos) return obstacle.id;
  return (geometry::has_interior(obstacle.shape) ? "polygon " : "wall ") + obstacle.id;
}

}  // namespace exactvo::tools
