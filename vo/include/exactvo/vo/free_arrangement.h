// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The set of free velocities of a scene of discs, segments and polygons, unrounded:
///
///     F = { v : |v| <= max_speed } minus the union of the obstacles' cones, boundaries included,
///
/// as the pieces that it falls into, each bounded by arcs of the speed's circle, arcs and straight edges of
/// the cut-offs, and legs.
/// All that is decided (which curves meet, in which order along each, which stretch bounds what is free, how the
/// stretches join) is decided for algebraic numbers, also where curves touch, coincide or meet three in a point. Only
/// the numbers that show the answer are rounded, as certified brackets.
///
/// Every cone is convex and reaches beyond the disc, so that no piece has a hole: a piece is one closed walk, and the
/// number of walks is the number of components. Pieces that meet in a point, also in the apex of an infinite cone, are
/// two. A wall or a point that a robot without extent sees end on forbids a ray: a slit, whose two sides are two arcs.
///
/// Robots are discs or polygons, horizons finite or infinite, cones moved to any apex. Ellipses are not taken (their
/// offset has degree eight): free_velocities.h holds them, and everything else faster, between two bounds.
///
/// Exact: `contains`, the pieces, their number, `holds`. Certified: end points and areas. An offline object:
/// milliseconds for a few cones, seconds for kMostCurves; see docs/guide/velocity-obstacles.md for the cost measured.
///
/// Properties (tests quote the numbers):
///  (1) `area` lies within the bracket of FreeVelocities;
///  (2) there are at least as many components as FreeVelocities::least_components;
///  (3) one cone more never enlarges the area;
///  (4) each arc of a piece begins where the one before it ends, and shows the same doubles there;
///  (5) what FreeVelocities::compare proves of half-planes, `yes` or `no`, `holds` says too.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/geometry/region.h"
#include "exactvo/vo/family.h"

namespace exactvo::vo {

/// Cones and curves beyond these are refused: the curves are compared pair by pair.
inline constexpr std::size_t kMostCones = 64;
inline constexpr std::size_t kMostCurves = 512;  ///< legs, arcs and edges of cut-offs, of all cones together

/// m, s or m/s: every number of a scene is 0 or of a size from the one to the other. 2^-60 lets pass what rounding
/// leaves of a 0, 2^30 what maps count in. Near the ends of the doubles' range CORE divides by zero.
inline constexpr double kLeastArrangedNumber = 0x1p-60;
/// The greatest size, m, s or m/s.
inline constexpr double kMostArrangedNumber = 0x1p30;
/// For half-planes only: their normals are computed, so two or three roundings may leave a tiny number instead of 0.
inline constexpr double kLeastOfHalfPlane = 0x1p-200;

/// Why a scene has no FreeArrangement.
enum class Refusal {
  none,          ///< it has one
  ellipse,       ///< an ellipse takes part, not flat and not round
  cones,         ///< more than kMostCones
  curves,        ///< more than kMostCurves
  range,         ///< a number out of the range above
  numbers_apart  ///< each number is in range, but together they are so many powers of ten apart that CGAL's exact ones
                 ///< give up (1 and 1e-9 were once in a hundred)
};
/// "none", "ellipse" and so on.
const char* name(Refusal refusal);

/// What bounds a piece: the speed's circle, or a curve of a cone.
enum class ArcKind {
  speed_circle,  ///< |v| = max_speed
  cut_off_arc,   ///< round a vertex or disc, divided by the horizon
  offset_edge,   ///< along an edge, divided by the horizon
  leg            ///< a side of a cone
};
/// "speed circle", "cut-off arc", "offset edge", "leg".
const char* name(ArcKind kind);

/// Certified: the point lies in the box. Each side is at most 2^-48 max_speed wide, or as narrow as doubles are there.
struct PointBracket {
  /// m/s.
  geometry::Bracket x, y;  ///< m/s
};

/// A stretch of a piece's boundary, what is free on its left.
struct FreeArc {
  ArcKind kind = ArcKind::speed_circle;  ///< of which curve
  std::size_t cone = 0;                  ///< whose; without meaning for the speed's circle
  PointBracket from;                     ///< where it begins
  PointBracket to;                       ///< where it ends
  Vec2 center;                           ///< m/s, rounded; of arcs
  double radius = 0.0;                   ///< m/s, rounded; of arcs
  /// How an arc turns: 1, counter-clockwise, round the speed's circle; -1, clockwise, round a cut-off; 0: straight.
  int turn = 0;
};

/// One component of F.
struct FreePiece {
  std::vector<FreeArc> boundary;  ///< in order, closed, what is free on the left
  geometry::Bracket area;         ///< (m/s)^2; at most 2^-48 max_speed^2 wide, or as narrow as doubles are there
};

/// F as an exact arrangement.
class FreeArrangement {
 public:
  /// Cones whose robot overlaps the obstacle forbid everything: F is empty. REQUIRES (std::logic_error otherwise): what
  /// `attempt` does not refuse.
  FreeArrangement(std::vector<ShiftedCone> cones, double max_speed);

  /// The arrangement, or why there is none: for scenes of any numbers.
  struct Attempt;
  /// The same as the constructor; a scene that is refused is a value, not an exception.
  static Attempt attempt(std::vector<ShiftedCone> cones, double max_speed);

  /// The refusals that are known before anything is computed; `numbers_apart` is not one.
  static Refusal refusal_of(const std::vector<ShiftedCone>& cones, double max_speed);

  /// Whether the cone is bounded by lines and circular arcs only. False for an ellipse that is no disc and no segment.
  static bool can_hold(const ShiftedCone& cone);

  /// How many curves bound the cone, of the kMostCurves. REQUIRES: can_hold(cone), !cone.cone.overlaps().
  static std::size_t curves_of(const ShiftedCone& cone);

  /// Whether |v| <= max_speed and v lies in no cone, boundaries of cones not counted as free. Exact.
  bool contains(Vec2 v) const;

  /// The components, largest first.
  const std::vector<FreePiece>& pieces() const { return pieces_; }
  /// (m/s)^2, of all components together. Certified.
  geometry::Bracket area() const;

  /// Whether every velocity that satisfies the half-planes and |v| <= max_speed (equation (13)) is free, up to a set of
  /// measure zero.
  /// Exact, for the doubles of the half-planes. REQUIRES (std::logic_error otherwise): what `attempt_holds` answers.
  bool holds(const std::vector<HalfPlane>& half_planes) const;

  /// The same, or nothing where a number is neither 0 nor of a size from kLeastOfHalfPlane to kMostArrangedNumber, or
  /// where CGAL's exact ones give up: for half-planes of any numbers.
  std::optional<bool> attempt_holds(const std::vector<HalfPlane>& half_planes) const;

  /// As they were given.
  const std::vector<ShiftedCone>& cones() const { return cones_; }

 private:
  std::vector<ShiftedCone> cones_;
  double max_speed_;
  std::vector<FreePiece> pieces_;
};

/// An arrangement, or why there is none.
struct FreeArrangement::Attempt {
  std::optional<FreeArrangement> free;  ///< none where refused
  Refusal refusal = Refusal::none;      ///< none where `free` is something
};

}  // namespace exactvo::vo
