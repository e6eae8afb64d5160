// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The way of a moving obstacle in pieces between corners and speed knots: along each it goes straight, and its speed
/// changes at a constant rate. Rounded, with a certified bound of the error in each piece.

#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

struct WayPiece {
  double from, to;      ///< s, from <= to; `to` is infinite where neither corner nor knot follows
  Vec2 vertex;          ///< m, displacement at the leg's first point
  Vec2 direction;       ///< unit, of the leg; (0, 0) at the path's end
  double origin;        ///< s, where the speed stretch begins
  double offset;        ///< m, along the leg at `origin`; negative where the leg begins later
  double speed, rate;   ///< m/s at `origin`, m/s^2
  double error = 0.0;   ///< m: at no time in [from, to] is `at` farther than this from the true displacement
  double length = 0.0;  ///< m, of the leg

  double along(double t) const { return offset + (t - origin) * (speed + 0.5 * rate * (t - origin)); }
  Vec2 at(double t) const { return vertex + along(t) * direction; }
  /// m/s: the greatest speed between `from` and `until`, rounded.
  double speed_bound(double until) const;
};

/// The pieces from t = 0 on, each beginning where the one before it ends; of the last, `to` > `end` (s).
/// REQUIRES: a path of at least one point.
std::vector<WayPiece> way_of(const TimedPath& motion, double end);

/// The index of the first piece that ends after `time`. REQUIRES: 0 <= time <= end of `way_of`.
std::size_t piece_at(const std::vector<WayPiece>& way, double time);

}  // namespace exactvo::formation::detail
