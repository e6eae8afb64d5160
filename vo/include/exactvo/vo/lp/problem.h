// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The problem of equations (12) and (13): the velocity nearest the preferred one inside half-planes and a speed bound.
/// The field calls it a linear program (de Berg et al., chapter 4; van den Berg et al. 2011); it is a small convex QP.

#include <limits>
#include <vector>

#include "exactvo/geometry/half_plane.h"

namespace exactvo::lp {

using geometry::HalfPlane;
using geometry::Vec2;

enum class Priority {
  hard,  ///< must hold (static obstacles)
  soft   ///< may give where the whole contradicts itself (robots)
};

struct Constraint {
  HalfPlane half_plane;
  Priority priority = Priority::hard;
  int label = -1;  ///< the caller's own
};

/// |v| <= disc, |v_x| <= box_x, |v_y| <= box_y, all in m/s and all at once; infinity switches one off.
struct SpeedBound {
  double disc = std::numeric_limits<double>::infinity();
  double box_x = std::numeric_limits<double>::infinity();
  double box_y = std::numeric_limits<double>::infinity();
};

struct Problem {
  std::vector<Constraint> constraints;
  SpeedBound bound;
  Vec2 preferred;  ///< m/s
};

}  // namespace exactvo::lp
