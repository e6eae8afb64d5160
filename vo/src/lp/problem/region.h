// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The region of a problem as the double-precision solvers see it: lines with the inward slack already in them, the
/// sides of the box among them, and a disc.

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// u, the unit roundoff of double.
inline constexpr double kUnitRoundoff = 0x1p-53;

/// A vertex computed in double misses its lines by up to 2.1 u V where measured; with a bound of (1 + 2) u for the dot
/// product on either side and the division of the intersection, 16 u V covers every well-conditioned vertex.
inline constexpr double kInwardSlack = 16.0 * kUnitRoundoff;

/// Slacks tried in turn, in units of kInwardSlack: sharp vertices need more of it.
inline constexpr double kSlacks[] = {1.0, 8.0, 64.0, 512.0};

/// A violation below this share of V is rounding left over from the step before: half the inward slack, so that what
/// is let pass still satisfies the constraint that was given.
inline constexpr double kNoise = 8.0 * kUnitRoundoff;

/// normal . v >= offset (tightened).
struct Line {
  Vec2 normal;
  double offset = 0.0;
  double squared_length = 1.0;  ///< |normal|^2
  double slack = 0.0;           ///< by how much `offset` exceeds the one given
  Binding binding;              ///< the constraint, or a side of the box
  bool soft = false;
};

struct Region {
  std::vector<Line> lines;
  double disc = std::numeric_limits<double>::infinity();  ///< m/s, already rounded inward
  double speed = 1.0;                                     ///< V: the largest speed in play, m/s
};

/// A side of the box as a unit half-plane n.v >= -width. REQUIRES: a side of the box.
HalfPlane side_of_box(const SpeedBound& bound, BindingKind side);

/// The largest speed that can matter, m/s: the bound's where there is one, else that of the data.
double largest_speed(const Problem& problem);

/// The lines of `problem` with `slack_units` times the inward slack.
Region region_of(const Problem& problem, double slack_units = 1.0);
/// The same in memory that is there already.
void set_region_of(const Problem& problem, double slack_units, Region& region);

/// The line's own violation at v (tightened), > 0 outside.
inline double excess(const Line& line, Vec2 v) {
  return line.offset - dot(line.normal, v);
}

/// In the place of a line's position: the disc, and nothing.
inline constexpr std::size_t kDiscPosition = static_cast<std::size_t>(-1);
inline constexpr std::size_t kNoPosition = static_cast<std::size_t>(-2);

/// What a point is the optimum of: up to three lines (positions in the region) or kDiscPosition.
struct Basis {
  std::array<std::size_t, 3> member{};
  std::size_t size = 0;
  void add(std::size_t m) { member[size++] = m; }
  bool has(std::size_t m) const {
    for (std::size_t k = 0; k < size; ++k)
      if (member[k] == m) return true;
    return false;
  }
};

}  // namespace exactvo::lp
