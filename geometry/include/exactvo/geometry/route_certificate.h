// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Checks the answers of routes.h by code that shares nothing with what made them but plain types: in rationals (GMP),
/// from the obstacles, the question and the answer alone. Exact.
///
/// Properties (tests quote the numbers):
///  (1) every answer of `RoutePlan::query` is valid;
///  (2) no two valid answers to one question are of different kinds: a route cannot cross a valid chain, and a blocked
///      end has no route;
///  (3) an answer of which a point was moved onto or over an obstacle, or a link lengthened to two radii, is not valid;
///  (4) the doubles next to fractions are checked, and the length; the lower bound is only checked not to exceed it.

#include <string>
#include <vector>

#include "exactvo/geometry/routes.h"

namespace exactvo::geometry {

/// The question.
struct RouteQuestion {
  double radius = 0.0;  ///< m, >= 0; 0: a point, which only its ends may touch obstacles with
  /// m.
  Vec2 start, goal;  ///< m
};

/// Empty where the answer is proven; else what is wrong with it, in a few words with the number of the point:
/// "point 3: nearer to edge 1 of obstacle 7 than the radius". Time: points times edges for a route.
/// REQUIRES: finite numbers, radius >= 0.
std::string check(const std::vector<Obstacle>& obstacles, const RouteQuestion& question, const RouteAnswer& answer);

}  // namespace exactvo::geometry
