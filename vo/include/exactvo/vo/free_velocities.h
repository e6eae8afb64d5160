// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What several velocity obstacles leave: the set of free velocities of a scene,
///
///     F = { v : |v| <= max_speed } minus the union of the obstacles' cones, boundaries included.
///
/// F has circular arcs, irrational lines and, where ellipses take part, curves of degree eight. Two polygonal regions
/// with exact coordinates enclose it: `inner` is a subset of F, and F is a subset of `outer`. Every cone is convex, so
/// a polygon of certified half-planes holds it, and the hull of points that are exactly inside lies in it; the same
/// construction for every shape, a disc or a polygon for a robot, finite or infinite horizon. What is between the two
/// is at most `tolerance` wide (and `grown_error` / tau where the robot is a polygon), but for two exceptions: where
/// doubles of the size of the coordinates over tau, or of the apex, are coarser than that, it is as wide as their
/// rounding; and where the robot is a few ulps from contact, so that no legs certify, the cone is held from outside by
/// the half-plane away from the nearest point, or if that cannot be proven either, not at all.
///
/// Exact: `contains`. Certified: both regions, so every bracket, and the two answers `yes` and `no` of `compare`.
/// "Within" is up to sets without area: `inner` is closed and may touch a cone, whose boundary is not free.
///
/// Properties (tests quote the numbers):
///  (1) a point in the interior of `inner` is contained; a contained point lies in `outer`;
///  (2) the bracket of the area shrinks with the tolerance;
///  (3) one obstacle more never enlarges either bound of the area;
///  (4) certified half-planes, one for each cone, bound a region that lies in F.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/region.h"
#include "exactvo/vo/family.h"

namespace exactvo::vo {

/// m/s: the smallest allowed max_speed. Products of a few such numbers do not underflow.
inline constexpr double kLeastMaxSpeed = 0x1p-60;
/// m/s: the largest allowed max_speed. Products of a few such numbers do not overflow.
inline constexpr double kMostMaxSpeed = 0x1p60;
/// m/s, each coordinate of a cone's apex: its sums stay within geometry::kLargestRegionCoordinate.
inline constexpr double kMostApex = 0x1p100;

/// How large the set may be and how closely it is enclosed.
struct FreeVelocityOptions {
  double max_speed = 2.0;            ///< m/s, from kLeastMaxSpeed to kMostMaxSpeed
  double relative_tolerance = 1e-4;  ///< of max_speed, in [1e-7, 0.1]: how far the polygons may stray from the curves
};

/// Whether one set lies in another.
enum class Inside {
  yes,       ///< proven
  no,        ///< refuted
  undecided  ///< neither, within the tolerance
};
/// "yes", "no", "undecided".
const char* name(Inside answer);

/// A part of F that half-planes give away.
struct LostPiece {
  geometry::Polygon polygon;   ///< m/s, rounded
  geometry::Bracket area;      ///< (m/s)^2, of the part that lies in `inner`
  Vec2 farthest;               ///< m/s, its corner that the half-plane below excludes by most
  std::size_t half_plane = 0;  ///< the one that excludes most of it
};

/// How a region of half-planes (equation (13)) compares with F.
struct RegionReport {
  Inside inside = Inside::undecided;  ///< proven either way, or undecided within the tolerance
  geometry::Region region;            ///< within max_speed, from outside
  geometry::Bracket area;             ///< (m/s)^2, of the region within max_speed
  geometry::Bracket given_away;       ///< (m/s)^2, of F minus the region
  std::vector<LostPiece> lost;        ///< largest first; those of an area below tolerance times max_speed are left out
};

/// F between two regions with straight edges.
class FreeVelocities {
 public:
  /// REQUIRES: options in range, apices within kMostApex. Cones whose robot overlaps the obstacle forbid everything: F
  /// is empty.
  FreeVelocities(std::vector<ShiftedCone> cones, const FreeVelocityOptions& options = {});

  /// Whether |v| <= max_speed and v lies in no cone, boundaries of cones not counted as free. Exact.
  bool contains(Vec2 v) const;

  /// Lies in F. Certified.
  const geometry::Region& inner() const { return inner_; }
  /// Holds F. Certified.
  const geometry::Region& outer() const { return outer_; }

  /// (m/s)^2. Certified.
  geometry::Bracket area() const;

  /// F has at least this many connected components: pieces of `outer` that hold a piece of `inner`. Certified; parts
  /// thinner than the bracket may make more.
  std::size_t least_components() const;

  /// What the half-planes' intersection makes of F. `yes` is proven by certificates (each cone has a half-plane that
  /// excludes it) or by the regions, `no` by the regions. REQUIRES: normals within geometry::kLargestRegionCoordinate,
  /// finite offsets.
  RegionReport compare(const std::vector<HalfPlane>& half_planes) const;

  /// As they were given.
  const std::vector<ShiftedCone>& cones() const { return cones_; }
  /// The bounds of cone k within reach of max_speed.
  const geometry::Region& cone_from_inside(std::size_t k) const { return from_inside_[k]; }
  /// What holds cone k within the disc of max_speed. Certified. REQUIRES: k < cones().size().
  const geometry::Region& cone_from_outside(std::size_t k) const { return from_outside_[k]; }

 private:
  bool proven_by_certificates(const std::vector<HalfPlane>& half_planes) const;

  std::vector<ShiftedCone> cones_;
  FreeVelocityOptions options_;
  std::vector<geometry::Region> from_inside_, from_outside_;
  geometry::Region disc_inside_, disc_outside_;
  geometry::Region inner_, outer_;
};

}  // namespace exactvo::vo
