// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Enclosures (paper, Section III.B, equation (8), Fig. 3): an ellipse round one facade or round a cluster of them, so
/// that the velocity obstacle built on it is safe for all it encloses. Which ellipse decides whether the robot
/// gets round (docs/guide/trap-test.md).
///
/// Containment is certified for every enclosure returned: each enclosed point lies in the closed shape by predicate E.
/// The fit itself is heuristic: a search over orientation, offset and semi-minor axis, not a proven minimum.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// How the semi-minor axis of a single facade's ellipse is chosen (half-length L of the facade).
struct FacadeEllipseOptions {
  double minor_to_major = 0.5;  ///< b = this * a; used unless fixed_minor > 0
  double fixed_minor = 0.0;     ///< m; > 0: b is this length
  double margin = 0.05;         ///< m; by how much the facade lies inside: depth >= margin along the major axis
};

/// The ellipse of one facade, axis along the facade. Containment certified.
Ellipse facade_ellipse(const Segment& facade, const FacadeEllipseOptions& options = {});

/// Equation (8), corrected: d = robot_radius + the least depth of the facade's points in the ellipse, m. Rounded.
double clearance_of_equation_8(const Segment& facade, const Ellipse& enclosure, double robot_radius);

/// Why an enclosure is as it is: the rung of the ladder on which the fit stopped.
enum class EnclosureGrade {
  trap_free,       ///< goal outside the evolute with the asked slack and margin
  trap_free_thin,  ///< the same with the least slack and margin
  containing,      ///< encloses, start and goal outside, but a stall is possible: no certificate
  tight            ///< the facade itself, no ellipse: start or goal lies too near
};

struct Enclosure {
  ConvexShape shape;                 ///< an Ellipse, or a Segment where grade is tight
  std::vector<std::size_t> facades;  ///< indices of what it encloses
  EnclosureGrade grade = EnclosureGrade::tight;
  /// Whether predicate F certified that a robot heading for the goal can't stall at this enclosure alone.
  bool trap_free() const { return grade == EnclosureGrade::trap_free || grade == EnclosureGrade::trap_free_thin; }
};

struct EnclosureOptions {
  double margin = 0.08;        ///< m; points are kept this far inside
  double slack = 0.5;          ///< sigma: the evolute condition holds with (1 + slack) on its right side
  double least_margin = 0.02;  ///< m; second rung
  double least_slack = 0.02;   ///< second rung
  double clear_of_start = 0.02;  ///< m; start and goal must be this far outside the grown enclosure
};

/// The smallest trap-free ellipse that the search finds round `points`, for a robot of `robot_radius` going from `start`
/// to `goal`; nothing if even `containing` can't hold (start or goal within the grown ellipse).
/// The grade returned says which rung held.
struct FittedEllipse {
  Ellipse ellipse;
  EnclosureGrade grade = EnclosureGrade::containing;
};
std::optional<FittedEllipse> fit_trap_free(const std::vector<Vec2>& points, double robot_radius, Vec2 start, Vec2 goal,
                                           const EnclosureOptions& options = {});

/// Encloses all facades for one robot and goal: fits each, merges whatever overlaps (grown enclosures that meet can trap at their
/// concave vertex) and fits again until nothing overlaps; a cluster that can't be enclosed falls back to its facades,
/// tight. Deterministic.
std::vector<Enclosure> enclose(const std::vector<Segment>& facades, double robot_radius, Vec2 start, Vec2 goal,
                               const EnclosureOptions& options = {});

}  // namespace exactvo::geometry
