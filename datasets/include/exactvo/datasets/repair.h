// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Repairs polygons. What `geometry::normalize` finds and does not repair is repaired here where there is a rule for
/// it:
///
///  - a ring that crosses, touches or overlaps itself, spikes, holes that lie outside, in each other, or cross another
///    ring: the polygon becomes what an odd number of its rings enclose (geometry/even_odd.h), in as many polygons as
///    that takes. So a hole outside its polygon is solid, and so is one in a hole. But what a ring winds round twice
///    becomes free (the middle of a pentagram), and so does what two rings both enclose where they overlap: what is
///    left solid can be less than the ring goes round. The report gives the area before and after.
///  - a hole of less than three distinct points or without area is dropped: nothing is in it.
///
/// Not repaired, and named: coordinates that are not finite, an outer ring of less than three distinct points or
/// without area, rings of which nothing is left (E_ZERO_AREA), more crossings than there is room for (E_SIZE),
/// coordinates beyond 2^100 m in rings that must be cut (E_RANGE), and crossings that can't be rounded to doubles
/// without new ones (E_ROUNDING).
///
/// A polygon that was valid but for winding, closure and consecutive duplicates comes back as `normalize` gives it.
///
/// See also: `ReadOptions::repair` (obstacle_file.h) does this to every polygon of a file.
///
/// Properties (tests quote the numbers):
///  (1) what comes back is valid: `normalize` repairs nothing of it but closure, and the polygons' insides are
///  disjoint; (2) repairing it again changes nothing; (3) a valid polygon comes back bit for bit but for winding; (4)
///  its area is that of the points enclosed an odd number of times, up to rounding (`moved`).

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::datasets {

/// The rings before or after a repair.
struct RepairFacts {
  std::size_t polygons = 0;  ///< how many
  std::size_t rings = 0;     ///< outer rings and holes
  std::size_t vertices = 0;  ///< first points not repeated
  /// m^2, rounded. Before: by the shoelace formula, as programs do that take no notice of crossings, so that loops of
  /// opposite winding cancel; NaN where a coordinate is.
  double outer_area = 0.0;  ///< of the outer rings, >= 0
  double hole_area = 0.0;   ///< of the holes, >= 0
  double area = 0.0;        ///< the difference; below 0 where the holes, some of them outside, are larger
};

/// What a polygon became.
struct Repair {
  std::vector<geometry::Polygon> polygons;      ///< empty if not repaired; in order of their least vertex
  std::vector<geometry::RingProblem> problems;  ///< of the rings as given; `repaired` says what became of each
  std::optional<DataCode> refused;              ///< why nothing could be made of it
  bool recombined = false;                      ///< by the even-odd rule
  double moved = 0.0;                           ///< m; how far a crossing was moved by rounding, at most
  RepairFacts before;                           ///< the rings as given
  RepairFacts after;                            ///< the polygons that came of them

  /// Whether something could be made of it.
  bool ok() const { return !refused; }
  /// Whether anything was wrong.
  bool changed() const { return !problems.empty(); }
};

/// `rings` as `geometry::normalize` takes them: the outer one first, closed or not. REQUIRES: at least one ring.
Repair repair(const std::vector<geometry::Ring>& rings);

/// Shoelace formula, rounded: of `outer` less the holes.
double area(const geometry::Polygon& polygon);

}  // namespace exactvo::datasets
