// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Moving obstacles: where they are, and the half-planes they ask of a robot that takes the whole responsibility
/// (equations (6), (7) and (10) with alpha = 1 and v relative to the obstacle).

#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/shapes.h"
#include "exactvo/vo/constraint.h"

namespace exactvo::formation::detail {

struct Constraint;
struct DecisionRules;
struct Viewpoint;
class Scene;

/// Brings the bodies of moving obstacles to where they are at `time`, and says where that is.
void move_obstacles(const std::vector<MovingObstacle>& obstacles, double time, Scene& scene,
                    std::vector<MovedObstacle>& moved);

/// Appends the half-plane against body number `body`, moving obstacle number `index`, if that is in sight: soft,
/// certified while the obstacle keeps its velocity.
void add_moving_constraint(const DecisionRules& rules, const Viewpoint& from, vo::BodyTable& bodies,
                           vo::BodyTable::Number body, std::size_t index, std::vector<Constraint>& out);

/// The same for every moving obstacle. REQUIRES: `move_obstacles` for this time.
void add_moving_constraints(const DecisionRules& rules, const Viewpoint& from, Scene& scene,
                            std::vector<Constraint>& out);

/// The half-plane against moving obstacle `index`, of which it is known that it is no faster than `speed` (m/s), of a
/// robot that stands after `steps` steps (braking.h, lemma 8): hard. Whether there is one, or none is needed.
bool add_mover_constraint(const DecisionRules& rules, const Viewpoint& from, double speed, std::size_t steps,
                          Vec2 velocity, Scene& scene, std::size_t index, std::vector<Constraint>& out);

}  // namespace exactvo::formation::detail
