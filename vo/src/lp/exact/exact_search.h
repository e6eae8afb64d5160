// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The active-set searches in exact arithmetic. The same search as that of the kernel (lanes/single.cpp): a violated line enters, and the
/// optimum of the working set of a few lines is found on its boundary. Here every sign is exact, so the objective grows
/// strictly with each round and no basis comes twice: the search ends on any input. Doubles only choose which line is
/// looked at first.
///
/// The objective is lexicographic, so that the optimum is one point: (least violation, then) the problem's own
/// objective, then the distance to 0.

#include <vector>

#include "exactvo/vo/lp/solution.h"
#include "lp/proof/exact_points.h"

namespace exactvo::lp {

/// What the search goes through: half-planes as given (soft and hard, sides of the box among them) and the disc.
struct ExactRegion {
  struct Member {
    HalfPlane half_plane;
    Binding binding;  ///< the constraint, or a side of the box
    bool soft = false;
  };
  std::vector<Member> lines;
  bool has_disc = false;
  Exact disc;  ///< the radius
};

/// What is best: farthest along the first direction, among equals along the next, among equals nearest `target`.
struct Aim {
  std::vector<Vec2> directions;
  Vec2 target;
};

struct ExactOptimum {
  bool feasible = true;
  ExactPoint point;
  Vec2 rounded;                    ///< `point` in doubles,
  double error = 0.0;              ///< each coordinate at most so far off, m/s; infinite where doubles do not reach
  std::vector<std::size_t> tight;  ///< positions of lines; where infeasible: the contradicting ones
  bool on_disc = false;            ///< the disc binds, or is part of the contradiction
  std::size_t top = 0;             ///< least violation: the soft line whose violation is the level
};

/// The optimum over every line.
ExactOptimum exact_best(const ExactRegion& region, const Aim& aim);

/// The least violation of the soft lines within the hard ones. REQUIRES: the hard lines do not contradict each other.
ExactOptimum exact_least_violation(const ExactRegion& region, const Aim& aim);

}  // namespace exactvo::lp
