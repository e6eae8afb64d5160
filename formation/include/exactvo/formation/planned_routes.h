// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The routes that robots with guidance set out on (geometry/routes.h), for pictures: planned as a run plans them, from
/// each robot's start to its first goal and from goal to goal. A run plans again where a robot was pushed off its
/// route; such routes are not here.
///
/// That a route exists, and that none does, is exact; the points are rounded.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/routes.h"

namespace exactvo::formation {

/// The route of one robot to one of its goals.
struct PlannedRoute {
  std::size_t robot = 0;  ///< index
  std::size_t goal = 0;   ///< the goal's number, from 0
  /// m, with start and end. If the goal is out of reach: to the nearest place, or empty (`Scenario::unreachable`).
  std::vector<Vec2> points;
  std::string why_not;                      ///< why the goal is out of reach, in words; else empty
  std::vector<geometry::ChainPoint> chain;  ///< then: the closed chain that separates them; empty if an end is not free
};

/// The routes of every robot and goal, in their order; none in a run without guidance. Costs what the run spends on
/// planning.
/// REQUIRES: a valid scenario.
std::vector<PlannedRoute> planned_routes(const Scenario& scenario, const SimulationOptions& options);

/// The route of one robot from where it is, and where along it the robot heads.
struct RouteAhead {
  PlannedRoute route;                  ///< to its present goal
  std::optional<Vec2> heads_for = {};  ///< m; the farthest point of the route that it can see
  double length = 0.0;                 ///< m, of the route
};

/// As it would be planned now, at `position`: a run keeps the route that it has as long as some of it is in sight, and
/// goes round moving obstacles that stand. Empty in a run without guidance. REQUIRES: a valid scenario, a robot and a
/// goal of it.
std::optional<RouteAhead> route_ahead(const Scenario& scenario, const SimulationOptions& options, std::size_t robot,
                                      std::size_t goal, Vec2 position);

}  // namespace exactvo::formation
