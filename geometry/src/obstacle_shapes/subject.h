// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the steps of obstacle_shapes.cpp share: what is looked at, and how a step says that it holds or why not.

#include <exception>
#include <vector>

#include "enclosure/ellipse_solver.h"
#include "exactvo/geometry/obstacle_shapes.h"

namespace exactvo::geometry::detail {

inline constexpr const char* kNotInside = "a point lies outside";

/// What must lie in the enclosures, and the course that the facades must keep to.
struct Subject {
  std::vector<Vec2> points;                ///< every vertex
  std::vector<std::vector<Vec2>> courses;  ///< rings and chains
  bool closed = false;                     ///< courses are rings
};

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
void divide(const Subject& subject, const ShapeOptions& options, ObstacleShapes& out);

/// Convex pieces; of a wall its own edges.
void split(const Subject& subject, const ShapeOptions& options, ObstacleShapes& out);

/// The ellipse that traps no robot on its way, or on any. REQUIRES: hull and smallest ellipse are in `out`.
void enclose_free_of_traps(const ShapeOptions& options, ObstacleShapes& out);

}  // namespace exactvo::geometry::detail
