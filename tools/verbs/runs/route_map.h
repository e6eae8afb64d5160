// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where a robot is among the obstacles, its route from there and the place that it heads for; of a goal out of reach
/// the closed chain that separates them.

#include <string>

#include "exactvo/formation/planned_routes.h"
#include "explain/decision.h"
#include "figures/figure.h"

namespace exactvo::tools {

Figure route_map_figure(const Decision& decision, const formation::RouteAhead& ahead);

/// One line: "Route: 12.3 m to (8, 3); it heads for (2.1, 0.4), 3.2 m away, the farthest point of it in sight."
std::string route_words(const Decision& decision, const formation::RouteAhead& ahead);

}  // namespace exactvo::tools
