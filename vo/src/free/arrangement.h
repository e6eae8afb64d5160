// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What several owners allow together, as closed walks round its pieces. Every sign is exact.
///
///     curves --cut at every common point--> stretches --those beside what all allow--> walks
///
/// A stretch that several curves share counts once, for the owner that comes first; where they allow different sides of
/// it, it bounds nothing.

#include <cstddef>
#include <vector>

#include "free/curves.h"

namespace exactvo::vo::detail {

/// A part of a curve between two neighbouring points, in the curve's own direction.
struct Stretch {
  std::size_t curve = 0;
  std::size_t from = 0, to = 0;  ///< points
};

/// How a stretch leaves a point: its direction there, and how it bends, positive to the left.
struct Departure {
  Point heading;
  Rational curvature;
};

/// An owner in doubles: enough to see that a point is forbidden far from its boundary.
class RoundedOwner {
 public:
  /// Distances below `margin` are not trusted.
  RoundedOwner(const Owner& owner, double margin);

  /// Whether the point is certainly not allowed, nor within half the margin of what is.
  bool forbids(Vec2 x) const;

 private:
  /// The points on the right of a line or chord by more than the margin, or in the disc beyond a chord.
  struct Side {
    Vec2 anchor, left;    ///< left: of length 1
    double margin = 0.0;  ///< infinite where nothing can be told
    bool has_disc = false;
    Vec2 centre;
    double radius = 0.0;
  };
  std::vector<Side> sides_;
};

class Arrangement {
 public:
  /// REQUIRES: the first owner is the speed's disc, of this radius.
  Arrangement(std::vector<Owner> owners, double max_speed);

  /// Each with what is allowed on its left.
  const std::vector<std::vector<Stretch>>& walks() const { return walks_; }
  const Curve& curve(const Stretch& s) const { return curves_[s.curve]; }
  const Point& point(std::size_t k) const { return points_[k]; }

 private:
  void cut_at_common_points(std::size_t a, std::size_t b);
  void cut_at_ends_of(std::size_t a, std::size_t b);
  std::size_t index_of(const Point& x);
  bool is_out_of_reach(Vec2 rounded) const;
  bool is_hidden(Vec2 rounded, std::size_t owner_a, std::size_t owner_b) const;
  std::vector<Stretch> stretches_of(std::size_t curve);
  Point middle_of(const Stretch& s) const;
  bool is_boundary(const Stretch& s) const;
  bool passes(std::size_t owner, const Stretch& s, const Point& middle) const;
  Departure leaving(const Stretch& s) const;
  Departure way_back(const Stretch& s) const;
  Point heading(const Stretch& s, std::size_t at) const;
  void walk_all(const std::vector<Stretch>& stretches);

  std::vector<Owner> owners_;
  std::vector<RoundedOwner> rounded_owners_;
  double max_speed_;
  std::vector<Curve> curves_;
  std::vector<std::vector<std::size_t>> cuts_;        ///< of each curve, points
  std::vector<std::vector<std::size_t>> coinciding_;  ///< of each curve, curves of other owners
  std::vector<Point> points_;
  std::vector<Vec2> rounded_;  ///< the points
  std::vector<std::vector<Stretch>> walks_;
};

}  // namespace exactvo::vo::detail
