// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The steps of obstacle_shapes.cpp, and how a step says that it holds or why not.

#include <exception>
#include <vector>

#include "enclosure/ellipse_solver.h"
#include "exactvo/geometry/obstacle_shapes.h"

namespace exactvo::geometry::detail {

inline constexpr const char* kNotInside = "a point lies outside";

/// What the facades must keep to: a polygon's rings, or a wall's one chain.
std::vector<const std::vector<Vec2>*> courses_of(const Obstacle& obstacle);

/// Runs `action`; a failure inside becomes the verdict's reason.
template <class Action>
void attempt(Verdict& verdict, const Action& action) {
  try {
    action();
  } catch (const std::exception& failure) {
    verdict = {false, failure.what()};
  }
}

inline Verdict verdict(bool holds, const char* reason) {
  return holds ? Verdict{true, {}} : Verdict{false, reason};
}

/// An ellipse holds every point iff it holds the corners of their hull.
Verdict verdict_of(const Ellipse& ellipse, const ObstacleShapes& out);

/// Facades of the courses, certified to follow them.
void divide(const ShapeOptions& options, ObstacleShapes& out);

/// Convex pieces; of a wall its own edges.
void split(const ShapeOptions& options, ObstacleShapes& out);

/// The ellipse that traps no robot on its way, or on any. REQUIRES: hull and smallest ellipse are in `out`.
void enclose_free_of_traps(const ShapeOptions& options, ObstacleShapes& out);

}  // namespace exactvo::geometry::detail
