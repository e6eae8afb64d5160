// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How long two convex sets on constant twists keep a gap, both driving and turning. For control loops: constant
/// memory, microseconds, no exact arithmetic.
///
/// The *gap* of two convex sets is the distance between them; where they overlap, less than 0: the length of the
/// shortest shift that parts them, negative. It is the greatest, over all directions n, of
///
///     least n.x over the corners of one  -  greatest n.y over the corners of the other,
///
/// so that one direction is enough to prove a gap. A direction that holds over a piece of time proves it for the whole
/// piece: each corner is on a circle, so that its way along n is a sinusoid, which is least at an end or dips by no
/// more than `stray_of`. The search takes the best direction at a moment, sees how long it holds, and goes on from
/// there. Where the edge of the turning set is nearest, the direction turns with that set.
///
/// Certified: up to `kept_until` the gap is kept, whatever was rounded (floating-point filter with a derived bound; no
/// sampling). At `lost_by` it certainly is less. The search may give up early near contact that is only grazed, which
/// `lost_by` shows.
///
/// See also: twist.h, motions.h (exact verdicts for bodies that keep their heading).

#include <cstddef>
#include <vector>

#include "exactvo/geometry/twist.h"

namespace exactvo::geometry {

/// A view of the corners of a convex set, at least one; the caller keeps them.
struct CornerView {
  const Vec2* data = nullptr;  ///< m, from the set's reference point, in the axes of the world at the start
  std::size_t size = 0;        ///< >= 1
};

/// The convex hull of corners, on a constant twist.
struct ConvexOnTwist {
  Vec2 at;             ///< m, its reference point at the start
  Twist twist;         ///< in the axes of the world at the start; all 0: at rest
  CornerView corners;  ///< in any order that goes once round their hull counter-clockwise; two are a segment
};

/// What to keep.
struct GapToKeep {
  ConvexOnTwist a;        ///< one set
  ConvexOnTwist b;        ///< the other set
  double duration = 0.0;  ///< s, >= 0
  double reach = 0.0;     ///< m, >= 0: the radii of both; it is taken off the gap
  double growth = 0.0;    ///< m/s, >= 0: by which the reach grows
  double required = 0.0;  ///< m: the gap, less the reach, must not be less than this
};

/// How long it is kept.
struct KeptGap {
  bool whole = false;       ///< certified: all the time
  double kept_until = 0.0;  ///< s, certified: kept from 0 to here; 0 also where it is not kept at the start
};

/// How it is lost.
struct LostGap {
  double lost_by = 0.0;  ///< s: certainly not kept at this moment; infinite where none was found
  Vec2 place;            ///< m, rounded: where the two are nearest at `kept_until`
};

/// Answers one question after the other, with memory that only the first ones take.
class GapKeeper {
 public:
  /// REQUIRES: finite numbers within the ranges of the fields, corners as they are described.
  KeptGap keep(const GapToKeep& question);

  /// What ends a gap that is not kept all the time. REQUIRES: `kept` is the answer to the question, !kept.whole.
  LostGap lose(const GapToKeep& question, const KeptGap& kept);

  /// m: the gap less the reach at a time. Rounded, within `rounding_of`. REQUIRES: as above, 0 <= time.
  double gap_at(const GapToKeep& question, double time);

  /// m: a bound on what rounding does to a gap at any moment of the question.
  static double rounding_of(const GapToKeep& question);

 private:
  struct Direction;
  void place_at(const GapToKeep& question, double time);
  Direction best_direction() const;

  // Both at a moment, seen from a's reference point.
  std::vector<Vec2> a_, b_;
  Twist twist_a_, twist_b_;
  Vec2 b_at_;
};

}  // namespace exactvo::geometry
