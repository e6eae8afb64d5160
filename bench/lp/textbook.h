// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The yardstick: the textbook incremental linear program in float (de Berg et al., chapter 4; van den Berg et al.
/// 2011) as crowd simulators run it, written with care for speed in one translation unit. Lines are a point and a unit
/// direction, allowed is the left side; lines come nearest first; where the feasible region is empty, each violated
/// soft line in turn lifts the largest violation. Heuristic: parallel lines by a fixed epsilon.

#include <cstddef>

namespace exactvo::bench {

struct TextbookLine {
  float point_x, point_y, direction_x, direction_y;
};

struct TextbookVelocity {
  float x, y;
  bool feasible;
};

inline constexpr int kMostTextbookLines = 512;

/// The first `hard` lines are not relaxed. REQUIRES: count <= kMostTextbookLines.
TextbookVelocity solve_textbook(const TextbookLine* lines, int count, int hard, float speed, float preferred_x,
                                float preferred_y);

}  // namespace exactvo::bench
