// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Regions with straight edges over exact numbers: intersections and differences that do not round (CGAL's
/// Polygon_set_2 over lazy rationals), behind an immutable handle. Milliseconds for hundreds of edges.
///
/// Exact: everything but the doubles that show it (`pieces`, `area`), whose rounding is stated. Regions are
/// regularised: closures of their interiors, so that what has no area is nothing.
///
/// See also: vo/free_velocities.h, whose sets of free velocities are such regions; minkowski.h, sums of convex
/// polygons.

#include <memory>
#include <vector>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// Certified: low <= the number <= high.
struct Bracket {
  double low = 0.0;   ///< at most the number
  double high = 0.0;  ///< at least the number
};

/// Largest absolute value of any number that a region is built from or asked about. CGAL's filters multiply five such
/// numbers; the product must not overflow.
inline constexpr double kLargestRegionCoordinate = 0x1p200;

/// A region of the plane with straight edges. Immutable; copies share.
class Region {
 public:
  /// Empty.
  Region();

  /// The hull of the points. REQUIRES: coordinates within kLargestRegionCoordinate.
  static Region hull_of(const std::vector<Vec2>& points);

  /// The part of this region where normal.x >= offset. REQUIRES: numbers within kLargestRegionCoordinate. A zero normal
  /// keeps all or nothing.
  Region cut(const HalfPlane& keep) const;

  /// The part of a convex polygon that satisfies all half-planes. Much faster than cutting a region again and again.
  /// REQUIRES: the same.
  static Region cut(const ConvexPolygon& polygon, const std::vector<HalfPlane>& keep);

  /// The part of this region that is not in the other.
  Region difference(const Region& other) const;
  /// What both have in common.
  Region intersection(const Region& other) const;

  /// Whether it has no area.
  bool is_empty() const;
  Bracket area() const;  ///< m^2 or whatever the square of the unit is

  /// Where x lies. Exact. REQUIRES: within kLargestRegionCoordinate.
  Place locate(Vec2 x) const;

  /// The connected pieces, largest first. Two pieces that touch in a point are one piece if a single walk round the
  /// outside passes both, for example two squares with a common corner.
  struct Piece;
  /// Rounded, for showing and drawing.
  std::vector<Piece> pieces() const;

 private:
  struct Set;
  explicit Region(std::shared_ptr<const Set> set);
  std::shared_ptr<const Set> set_;
};

/// A connected piece.
struct Region::Piece {
  Region region;    ///< the piece itself, unrounded
  Polygon polygon;  ///< each coordinate rounded to nearest
  Bracket area;     ///< m^2 or whatever the square of the unit is
};

}  // namespace exactvo::geometry
