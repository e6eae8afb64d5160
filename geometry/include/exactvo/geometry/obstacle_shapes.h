// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Everything that geometry/ knows to make of one obstacle, in one call, each shape with a verdict on what it contains:
/// facades, convex pieces, hull, smallest ellipse, an ellipse round every facade (paper, equation (8)), an ellipse
/// at which no robot can stall, and measurements.
///
/// Every verdict is decided by exact predicates on the doubles that are returned: `certified` never rests on how a
/// shape was found. All are decided here except those of the pieces of a polygon, which hull.h proves before it returns
/// them.
/// Nothing throws for an obstacle, valid or not: an invalid one has its problems and nothing else, and a shape that
/// can't be had has a failed verdict that says why. Deterministic; no time in it.
///
/// See also: validity.h (the problems), facades.h, hull.h, enclosure.h (the parts, one by one).

#include <optional>
#include <string>
#include <vector>

#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/facades.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/shapes.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::geometry {

/// The way of a robot for which a trap-free ellipse is made to measure.
struct StartAndGoal {
  Vec2 start;  ///< m
  Vec2 goal;   ///< m
};

/// What is made of an obstacle, and how.
struct ShapeOptions {
  FacadeOptions facades;                                   ///< tolerance 0 keeps every corner
  PartitionMethod partition = PartitionMethod::automatic;  ///< of polygons without holes
  FacadeEllipseOptions facade_ellipses;                    ///< equation (8)
  double robot_radius = 0.0;                               ///< m, >= 0; in clearances, and in the fit along `way`
  std::optional<StartAndGoal> way;                         ///< none: the ellipse is trap-free for every goal
  EnclosureOptions enclosure;                              ///< of the fit along `way`
  bool check_validity = true;                              ///< false: the caller knows the obstacle to be valid
};

/// Whether a shape contains what it stands for. Exact.
struct Verdict {
  bool certified = false;  ///< proven by exact predicates
  std::string reason;      ///< why not; empty where certified
};

/// The ellipse of one facade.
struct FacadeEnclosure {
  Ellipse ellipse;         ///< certified by ObstacleShapes::facade_ellipses_contain
  double clearance = 0.0;  ///< m; d of equation (8), rounded
};

/// What became of the search for a trap-free ellipse. Without a `way` it is found or has failed.
enum class TrapFreeAnswer {
  found,      ///< the ellipse is there
  no_room,    ///< start or goal within radius, `clear_of_ends` and `least_margin` of the hull
  too_large,  ///< found, but only beyond `most_inflation`
  failed      ///< not found although neither of these applies, or the arithmetic overflowed
};

/// An ellipse round the whole obstacle at which no robot stalls, whatever its radius.
struct TrapFreeEllipse {
  std::optional<Ellipse> ellipse;                ///< where found
  EnclosureGrade grade = EnclosureGrade::tight;  ///< the first that held (enclosure.h)
  /// Certified: no goal outside the ellipse can make a robot stall there. The evolute lies in the ellipse, which for
  /// semi-axes a >= b is a^2 <= 2 b^2. Without it the certificate, if any, is for the goal of `way`.
  bool for_every_goal = false;
  TrapFreeAnswer answer = TrapFreeAnswer::failed;  ///< found, or why not
};

/// Rounded, for people; never part of a proof.
struct ShapeMeasurements {
  std::size_t vertices = 0;         ///< of all rings
  std::size_t holes = 0;            ///< rings but the outer ones
  double area = 0.0;                ///< m^2, holes taken off; 0 for walls and points
  double perimeter = 0.0;           ///< m, of all rings
  double hull_area = 0.0;           ///< m^2
  double ellipse_area = 0.0;        ///< m^2, of the smallest ellipse
  double least_ellipse_area = 0.0;  ///< m^2; no enclosing ellipse is smaller: a dual value, certified; 0 where flat
  double trap_free_area = 0.0;      ///< m^2; 0 without the ellipse
  /// m; a goal farther than this from the middle of the smallest ellipse can't make a robot stall at it: (a^2 - b^2)/b.
  /// Infinite where that ellipse is flat.
  double trap_free_beyond = 0.0;
};

/// All shapes of one obstacle, with their verdicts.
struct ObstacleShapes {
  std::vector<RingProblem> problems;  ///< all that was found; where one is not repaired nothing else is here
  Obstacle obstacle;                  ///< after repair
  FacadeSet facades;                  ///< what they stand for, and how closely
  /// Disjoint inside, their union is the obstacle, whatever the facades' tolerance. A wall's are its edges, straight
  /// runs merged.
  std::vector<ConvexShape> pieces;
  ConvexPolygon hull;                            ///< smallest convex set round every vertex
  Ellipse smallest_ellipse;                      ///< round every vertex, certified by `ellipse_contains`
  std::vector<FacadeEnclosure> facade_ellipses;  ///< one a facade, in their order
  TrapFreeEllipse trap_free;                     ///< round every vertex, certified by `trap_free_contains`
  ShapeMeasurements measurements;                ///< areas and counts

  Verdict facades_follow;           ///< the facades keep to the boundary, within their deviation
  Verdict pieces_cover;             ///< the pieces are convex and cover the obstacle and nothing else
  Verdict hull_contains;            ///< every vertex lies in the hull
  Verdict ellipse_contains;         ///< every vertex lies in the smallest ellipse
  Verdict facade_ellipses_contain;  ///< both ends of every facade lie in its ellipse
  Verdict trap_free_contains;       ///< every vertex lies in the trap-free ellipse; reason where there is none

  bool valid = false;  ///< every problem was repaired
  /// All of the above, but for a trap-free ellipse along a `way` whose ends leave no room for it, or none of the size
  /// allowed (`TrapFreeAnswer`). Without a way the ellipse must be there, free for every goal.
  bool certified() const;
};

/// One obstacle. REQUIRES: sensible options (tolerance and radius finite and >= 0, a finite way).
ObstacleShapes shapes_of(const Obstacle& obstacle, const ShapeOptions& options = {});

/// Whether no goal outside the closed ellipse can make a robot of any radius stall there (predicate F for all of them
/// at once): a^2 <= 2 b^2, that is 2 (l11^2 + l21^2 + l22^2)^2 <= 9 (l11 l22)^2. Exact.
bool trap_free_for_every_goal(const Ellipse& ellipse);

/// Whether x lies in the hull of a convex polygon. Exact, O(log n). REQUIRES: vertices as `convex_hull` gives them.
bool contains(const ConvexPolygon& hull, Vec2 x);

}  // namespace exactvo::geometry
