// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The suite `routes`: published shortest-path problems on Moving AI maps, for points and for discs.

#include <filesystem>
#include <string>
#include <vector>

#include "run.h"

namespace exactvo::bench {

inline constexpr const char* kRoutesSuite = "routes";

struct RouteProblems {
  std::filesystem::path map;  ///< NAME.map; NAME.lengths.tsv stands beside it
  double radius = 0.0;        ///< cells; 0: a point
  std::string scene() const;
};

/// Problems on every map with lengths in a folder, a few per map or all. Throws std::runtime_error where there is none.
std::vector<RouteProblems> route_problems_in(const std::filesystem::path& folder, Extent extent);

/// `robots`: problems; `arrived`: those with a route; `path`: the routes' lengths over the published ones, which are of
/// points. A success: of a point, no length is below the published one and no lower bound above; of a disc, no length
/// is below. `cpu_per_step`: us per query. Throws datasets::DataError, std::runtime_error for lengths that mean
/// nothing.
RunResult run_routes(const RouteProblems& problems);

}  // namespace exactvo::bench
