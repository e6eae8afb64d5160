// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Moving obstacles: where they are, and the half-planes they ask of a robot that takes the whole responsibility
/// (equations (6), (7) and (10) with alpha = 1 and v relative to the obstacle).

#include <vector>

#include "decision.h"

namespace exactvo::formation::detail {

/// The convex hull of the obstacle as it stands at `time`.
geometry::ConvexShape shape_at(const MovingObstacle& obstacle, double time);

/// Half-planes against every moving obstacle, soft, certified while the obstacle keeps its velocity.
std::vector<RobotConstraint> moving_constraints(const Scenario& scenario, const Viewpoint& from, double time);

}  // namespace exactvo::formation::detail
