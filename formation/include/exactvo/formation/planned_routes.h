// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The routes that robots with guidance set out on (geometry/routes.h), for pictures: planned as a run plans them, from
/// each robot's start to its first goal and from goal to goal. A run plans again where a robot was pushed off its
/// route; such routes are not here.
///
/// That a route exists, and that none does, is exact; the points are rounded.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {

/// Of one robot to one of its goals.
struct PlannedRoute {
  std::size_t robot = 0;     ///< index
  std::size_t goal = 0;      ///< which of its goals, from 0
  std::vector<Vec2> points;  ///< m, with start and end; empty where there is no route
  std::string why_not;       ///< then: why the goal is out of reach, in words
};

/// Of every robot and goal, in their order; nothing in a run without guidance. Costs what the run spends on planning.
/// REQUIRES: a valid scenario.
std::vector<PlannedRoute> planned_routes(const Scenario& scenario, const SimulationOptions& options);

}  // namespace exactvo::formation
