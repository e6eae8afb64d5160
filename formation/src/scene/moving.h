// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Moving obstacles: where they are, and the half-planes they ask of a robot that takes the whole responsibility
/// (equations (6), (7) and (10) with alpha = 1 and v relative to the obstacle).

#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation::detail {

struct Constraint;
struct Viewpoint;
class Scene;

/// The convex hull of the obstacle as it stands at `time`.
geometry::ConvexShape shape_at(const MovingObstacle& obstacle, double time);

/// Brings the bodies of moving obstacles to where they are at `time`, and says where that is.
void move_obstacles(const Scenario& scenario, double time, Scene& scene, std::vector<MovedObstacle>& moved);

/// Appends half-planes against every moving obstacle, soft, certified while the obstacle keeps its velocity. REQUIRES:
/// `move_obstacles` for this time.
void add_moving_constraints(const Scenario& scenario, const Viewpoint& from, Scene& scene,
                            std::vector<Constraint>& out);

}  // namespace exactvo::formation::detail
