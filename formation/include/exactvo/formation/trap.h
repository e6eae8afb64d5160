// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// When does a robot get stuck? The trap test (docs/guide/trap-test.md): a robot that slides along the boundary of an
/// enclosure grown by its radius, heading for a goal behind it, comes to rest where the way to the goal is normal to
/// the boundary and the goal lies nearer than the centre of curvature (D < rho).
///
/// Exact: the function `stall_possible` for an ellipse or disc (predicate F: the goal on or inside the evolute),
/// `start_clear` and `goal_clear`. Rounded: everything with a length in it, `stall_possible` for polygons and segments
/// (a flat edge traps wherever the goal's foot lies within it), and whether a goal lies deeper inside a grown enclosure
/// than the arrival tolerance, which `TrapFinding::stall_possible` counts as well. Heuristic: two enclosures that
/// overlap, and the edges of the method `orca`. Nothing here is a certificate that a run arrives.

#include <optional>
#include <vector>

#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/enclosure.h"

namespace exactvo::formation {

/// A point where a robot that heads for the goal can rest against the shape.
struct Equilibrium {
  Vec2 position;                   ///< m, of the robot's centre
  Vec2 normal;                     ///< unit, out of the shape
  double radius_of_curvature = 0;  ///< m, rho of the grown boundary; infinite on a flat edge and in a concave corner
  double distance = 0;             ///< m, D to the goal
  bool stable = false;             ///< D < rho: the robot stays; otherwise it slides off at the slightest offset
  /// False where `trap_test` proves that obstacles shut the robot of the scenario off from there. Elsewhere true.
  bool reachable = true;
  double rate_at(double max_speed) const;  ///< 1/s: offsets grow like e^{rate t}; negative where stable
};

/// Every equilibrium of a robot of `robot_radius` heading for `goal` on the far side of `shape`, ordered by angle.
/// REQUIRES: the goal outside the grown shape.
std::vector<Equilibrium> equilibria(const geometry::ConvexShape& shape, double robot_radius, Vec2 goal);

/// Whether some start may stall at `shape` on the way to `goal`. Exact for ellipses and discs. A segment has two free
/// sides.
bool stall_possible(const geometry::ConvexShape& shape, Vec2 goal);

/// ((a |gx|)^(2/3) + (b |gy|)^(2/3)) / (a^2 - b^2)^(2/3) - 1: how far the goal lies outside the evolute, relatively;
/// negative inside, infinite for a circle. Rounded; 0 crossing decided by `stall_possible`.
double evolute_margin(const geometry::Ellipse& ellipse, Vec2 goal);

/// An enclosure as one robot sees it.
struct TrapPlace {
  geometry::Enclosure enclosure;  ///< its shape, and what it stands for
  /// Counts the enclosures of the robot's first goal, as `index` of its recorded half-planes does; with the method
  /// `orca` the edges of the scene.
  std::size_t number = 0;
  std::optional<geometry::Segment> facade;  ///< m; the one facade that the enclosure was built on (ivo-edge), or edge
};

/// What the trap test says of one robot, one goal and one enclosure, or two that overlap.
struct TrapFinding {
  std::size_t robot = 0;  ///< in the order of the scenario
  Vec2 goal;              ///< m
  TrapPlace place;        ///< the enclosure, or the edge
  /// Where the finding is about two enclosures that overlap once they are grown by the robot: the other one. Their
  /// boundaries cross at concave vertices, where a robot can rest although neither enclosure alone would stop it.
  std::optional<TrapPlace> overlapping;
  bool start_clear = false;  ///< the start lies outside the grown enclosure (for two: outside both)
  bool goal_clear = false;   ///< so does the goal
  /// One enclosure: `stall_possible` of its shape, exact for an ellipse or disc, or the goal inside it by more than the
  /// arrival tolerance, rounded. Two enclosures, or an edge: whether there are `equilibria`, heuristic.
  bool stall_possible = false;
  /// For an ellipse its evolute margin. For two enclosures where a robot rests: minus the sine of the angle by which
  /// the way to the goal lies inside the cone of rest, at the vertex where that angle is largest. Near 0 the verdict is
  /// close.
  std::optional<double> margin;
  std::vector<Equilibrium> equilibria;  ///< for two enclosures: the vertices at which a robot rests
  /// s; for a robot that goes straight from the start and meets the boundary: how long it slides before the way is
  /// free. Nothing where it misses the shape, or would come to rest.
  std::optional<double> slide_time;
};

/// Every robot against every enclosure that the method builds for it, then every two of them that overlap once they are
/// grown by the robot (`TrapFinding::stall_possible` says what is exact). For two enclosures a pair of crossings closer
/// together than a hundredth of the radius can be missed. A goal inside a grown enclosure, by more than the arrival
/// tolerance, is a stall: the robot stops at the boundary. An enclosure is judged for a robot from anywhere; places
/// that the robot cannot get to from its start, such as those outside of a room that it is in, are marked
/// (`Equilibrium::reachable`, exact for a disc smaller by a thousandth of the radius, moving obstacles left out). Not
/// judged: the pieces that an enclosure gives way to while the robot is inside it (`start_clear` is false there).
///
/// The method `orca` builds no enclosures: there each edge of each obstacle stands for itself, seen from its free side,
/// together with the corner at its end where that is a concave one; a robot may rest on the edge over the goal's foot,
/// or in the corner where it touches both edges and nothing else of the obstacle. With `orca` that is rounded, and
/// heuristic: an edge knows nothing of the rest of its obstacle, nor where the robot comes from. Passages too narrow
/// between two obstacles, and slots within one, are not judged there. REQUIRES: a valid scenario.
std::vector<TrapFinding> trap_test(const Scenario& scenario, const SimulationOptions& options = {});

}  // namespace exactvo::formation
