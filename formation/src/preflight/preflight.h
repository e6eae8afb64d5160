// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "exactvo/formation/passing.h"
#include "exactvo/formation/scenario.h"
#include "reach/reachability.h"

namespace exactvo::formation::detail {

/// Warnings about what a scenario asks for and cannot get, one line each:
///   - a goal, or a slot at the leader's end, that lies inside an obstacle or nearer to one than the robot's radius;
///     that is proven out of reach (reachability.h), from the start or the last goal that is not; that is out of reach
///     past the polygons round discs, and perhaps not past the discs, said as "has no route to it" and "no proof"; or
///     that a moving obstacle covers where it comes to rest;
///   - two goals or slots too near to each other for both robots; last goals nearer than radii and margin take; a goal
///     on the way that another robot at its last goal leaves no room in, if no plan makes it;
///   - two robots that must pass each other but provably have no room, or not enough for the gaps that plans keep
///     (passing.h), unless a warning above names one of them already;
///   - a leader that reaches its end after the time limit, that moves faster than a robot can, or whose path was
///     planned and does not lead where it should or leaves no room for the formation;
///   - robots that start within the arrival tolerance of their goals, though not in the very goal;
///   - a robot that starts faster than its max_speed, or inside the hull of a moving obstacle;
///   - a moving obstacle that is faster than a robot.
/// Speeds count over the part of a motion that happens before the path's end and the time limit. `offsets` are the
/// formation's in use; empty without one. Rounded but for `reach`. Where nothing is said a goal may still be out of
/// reach: margins, the other robots and the limits of a method are not considered.
std::vector<std::string> preflight_warnings(const Scenario& scenario, const std::vector<Vec2>& offsets,
                                            Reachability& reach);

/// What can be said before a run of a formation whose robots follow what they choose too slowly to keep it, a sentence
/// for each of:
///   - bodies that cut the corners of their brake points by more than the margin between robots, as the gain k3 is low;
///   - a bound on the acceleration with which a robot stops later than half-planes look ahead at least.
/// Nothing of a controller without brake points. REQUIRES: a formation. Heuristic: a run may keep its
/// distances in spite of a warning, and may not without one.
std::vector<std::string> controller_warnings(const Scenario& scenario, const ControllerOptions& options);

/// `robots_without_passing` and, of other pairs, `robots_without_gaps_to_pass` (passing.h): what a plan finds no way
/// for. Looks once at who has little room, where no two have.
std::vector<NoPassing> robots_without_passing_by_plan(const Scenario& scenario);

}  // namespace exactvo::formation::detail
