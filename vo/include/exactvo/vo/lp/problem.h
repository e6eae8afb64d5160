// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The problem of equations (12) and (13): the velocity nearest the preferred one inside half-planes and a speed bound.
/// The field calls it a linear program (de Berg et al., chapter 4; van den Berg et al. 2011); it is a small convex QP.
/// Neighbours: solve.h finds the answer, solution.h says what it is, certificate.h proves it.

#include <cstddef>
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

enum class Objective {
  nearest,  ///< least |v - preferred|
  farthest  ///< most v . preferred, a direction; among equals the velocity nearest 0
};

struct Problem {
  std::vector<Constraint> constraints;
  SpeedBound bound;
  Vec2 preferred;  ///< m/s; for Objective::farthest a direction of any length but 0
  Objective objective = Objective::nearest;
};

/// What can bind besides the constraints, in the place of a constraint's index.
inline constexpr std::size_t kSpeedBound = static_cast<std::size_t>(-1);  ///< the disc
inline constexpr std::size_t kBoxRight = static_cast<std::size_t>(-2);    ///< v_x <= box_x
inline constexpr std::size_t kBoxLeft = static_cast<std::size_t>(-3);     ///< v_x >= -box_x
inline constexpr std::size_t kBoxTop = static_cast<std::size_t>(-4);      ///< v_y <= box_y
inline constexpr std::size_t kBoxBottom = static_cast<std::size_t>(-5);   ///< v_y >= -box_y

/// Whether `index` names the disc or a side of the box rather than a constraint.
constexpr bool is_speed_bound(std::size_t index) {
  return index >= kBoxBottom;
}

/// REQUIRES (std::logic_error otherwise, naming the constraint): finite numbers, normals not zero, a speed bound that
/// is not empty, and for Objective::farthest a finite bound and a direction that is not zero.
void require_well_formed(const Problem& problem);

}  // namespace exactvo::lp
