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
  double minor_to_major = 0.5;  ///< b = this * a; > 0; used unless fixed_minor > 0
  double fixed_minor = 0.0;     ///< m; > 0: b is this length
  double margin = 0.05;         ///< m; by how much the facade lies inside: depth >= margin along the major axis
};

/// The ellipse of one facade, axis along the facade. Containment certified.
Ellipse facade_ellipse(const Segment& facade, const FacadeEllipseOptions& options = {});

/// Equation (8), corrected: d = robot_radius + the least depth of the facade's points in the ellipse, m. Rounded.
double clearance_of_equation_8(const Segment& facade, const Ellipse& enclosure, double robot_radius);

/// How good an enclosure is. The fit asks for the best first, with `slack` and `margin` of EnclosureOptions; then for
/// the same with `least_slack` and `least_margin`; then for containment alone. It stops at the first that holds.
enum class EnclosureGrade {
  trap_free,       ///< goal outside the evolute with the asked slack and margin
  trap_free_thin,  ///< the same with the least slack and margin
  containing,      ///< encloses, but a stall is possible: no certificate; `fit_trap_free` has start and goal outside
  tight            ///< a convex piece or a facade itself, no ellipse: start or goal lies too near
};

/// "trap-free", "trap-free-thin", "containing", "tight".
const char* name(EnclosureGrade grade);

/// How an enclosure is fitted to one robot and goal.
struct EnclosureOptions {
  double margin = 0.08;         ///< m; points lie in the ellipse of semi-axes a - margin, b - margin
  double slack = 0.5;           ///< sigma: the evolute condition holds with (1 + slack) on its right side
  double least_margin = 0.02;   ///< m; asked for second, in the place of `margin`
  double least_slack = 0.02;    ///< asked for second, in the place of `slack`
  double clear_of_ends = 0.02;  ///< m; start and goal must be this far outside the grown enclosure
  double most_inflation =
      8.0;  ///< an ellipse may have this many times the area of the obstacle's hull grown by the robot
};

/// An ellipse, and how good it is.
struct FittedEllipse {
  Ellipse ellipse;                                    ///< certified to contain the points
  EnclosureGrade grade = EnclosureGrade::containing;  ///< the first that held
};

/// The smallest trap-free ellipse that the search finds round `points`, for a robot of `robot_radius` going from
/// `start` to `goal`; nothing if even `containing` can't hold (start or goal within the grown ellipse). `grade` is the
/// best grade that the ellipse satisfies. Containment, start and goal outside, and the evolute condition are checked
/// exactly on what is returned. REQUIRES: at least one point, all finite.
std::optional<FittedEllipse> fit_trap_free(const std::vector<Vec2>& points, double robot_radius, Vec2 start, Vec2 goal,
                                           const EnclosureOptions& options = {});

/// An obstacle in parts: the facades that enclosures are built on, and what replaces it if none fits: convex shapes
/// that cover it, or the edges of a polygon with holes.
struct ObstacleParts {
  std::vector<Segment> facades;     ///< m, in the order of divide_into_facades
  std::vector<ConvexShape> pieces;  ///< convex pieces of a polygon without holes, else its facades
};

/// Facades (facades.h) and convex pieces (hull.h) of one obstacle.
ObstacleParts parts_of(const Obstacle& obstacle);

/// A shape that stands for obstacles.
struct Enclosure {
  ConvexShape shape;                             ///< an Ellipse; where grade is tight, a piece
  std::vector<std::size_t> obstacles;            ///< indices of the obstacles that it stands for, ascending
  EnclosureGrade grade = EnclosureGrade::tight;  ///< the first that held
  /// Whether predicate F certified that a robot heading for the goal can't stall at this enclosure alone.
  bool trap_free() const { return grade == EnclosureGrade::trap_free || grade == EnclosureGrade::trap_free_thin; }
};

/// Encloses the obstacles in the way of one robot and goal: what the straight way meets, then what the detours round
/// those enclosures meet, and so on. Whatever overlaps once grown by the robot (two such can trap at their concave
/// vertex) is merged and fitted again, until nothing overlaps or no ellipse
/// holds both (then they stay as they are). What is not in the way, or can't be enclosed, stands as
/// its pieces, tight: an ellipse there could only shut a passage. Every facade is covered by what is returned.
/// Deterministic; heuristic but for what `fit_trap_free` checks.
std::vector<Enclosure> enclose(const std::vector<ObstacleParts>& obstacles, double robot_radius, Vec2 start, Vec2 goal,
                               const EnclosureOptions& options = {});

}  // namespace exactvo::geometry
