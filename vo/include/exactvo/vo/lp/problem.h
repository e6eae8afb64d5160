// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The problem of equations (12) and (13): the velocity nearest the preferred one inside half-planes and a speed bound.
/// The field calls it a linear program (de Berg et al., chapter 4; van den Berg et al. 2011); it is a small convex QP.
/// See also: solve.h finds the answer, solution.h says what it is, certificate.h proves it.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "exactvo/geometry/half_plane.h"

namespace exactvo::lp {

using geometry::HalfPlane;
using geometry::Vec2;

/// Whether a constraint may give.
enum class Priority {
  hard,  ///< must hold (static obstacles)
  soft   ///< may give where the whole contradicts itself (robots)
};

/// A half-plane of the problem.
struct Constraint {
  HalfPlane half_plane;                ///< what is allowed
  Priority priority = Priority::hard;  ///< whether it may give
  int label = -1;                      ///< the caller's own
};

/// |v| <= disc, |v_x| <= box_x, |v_y| <= box_y, all in m/s and all at once; infinity switches one off.
struct SpeedBound {
  double disc = std::numeric_limits<double>::infinity();   ///< m/s, > 0
  double box_x = std::numeric_limits<double>::infinity();  ///< m/s, > 0
  double box_y = std::numeric_limits<double>::infinity();  ///< m/s, > 0
};

/// What makes a velocity the best one.
enum class Objective {
  nearest,  ///< least |v - preferred|
  farthest  ///< most v . preferred, a direction; among equals the velocity nearest 0
};

/// A problem: well-formed if `require_well_formed` takes it.
struct Problem {
  std::vector<Constraint> constraints;       ///< in any order
  SpeedBound bound;                          ///< m/s
  Vec2 preferred;                            ///< m/s; for Objective::farthest a direction of any length but 0
  Objective objective = Objective::nearest;  ///< what makes a velocity the best one
};

/// What kind of boundary binds.
enum class BindingKind : std::uint8_t {
  constraint,  ///< a half-plane of the problem
  disc,        ///< |v| <= disc
  box_right,   ///< v_x <= box_x
  box_left,    ///< v_x >= -box_x
  box_top,     ///< v_y <= box_y
  box_bottom   ///< v_y >= -box_y
};

/// What can bind: a constraint of the problem, or a part of the speed bound.
struct Binding {
  BindingKind kind = BindingKind::constraint;  ///< which boundary
  std::size_t index = 0;  ///< of the constraint in Problem::constraints; 0 for a part of the speed bound

  /// Whether both name the same boundary.
  friend constexpr bool operator==(const Binding& a, const Binding& b) {
    return a.kind == b.kind && (a.index == b.index || a.kind != BindingKind::constraint);
  }
  /// Whether they name different ones.
  friend constexpr bool operator!=(const Binding& a, const Binding& b) { return !(a == b); }
};

/// The disc of the speed bound.
inline constexpr Binding kDisc{BindingKind::disc, 0};
/// The sides of its box: right, left, top, bottom.
inline constexpr Binding kBoxSides[] = {
    {BindingKind::box_right, 0}, {BindingKind::box_left, 0}, {BindingKind::box_top, 0}, {BindingKind::box_bottom, 0}};

/// Constraint number `index` of the problem.
constexpr Binding constraint_at(std::size_t index) {
  return {BindingKind::constraint, index};
}

/// Whether it is the disc or a side of the box rather than a constraint.
constexpr bool is_speed_bound(const Binding& binding) {
  return binding.kind != BindingKind::constraint;
}

/// "constraint", "disc", "box-right", "box-left", "box-top", "box-bottom".
const char* name(BindingKind kind);

/// REQUIRES (std::logic_error otherwise, naming the constraint): finite numbers, normals not zero, a speed bound that
/// is not empty, and for Objective::farthest a finite bound and a direction that is not zero.
void require_well_formed(const Problem& problem);

}  // namespace exactvo::lp
