// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a solver returns: a value, never an exception.

#include <array>
#include <cstddef>

#include "exactvo/geometry/vec2.h"
#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// How an answer is to be read.
enum class Status {
  optimal,     ///< every constraint and the speed bound hold, exactly, for the doubles returned
  relaxed,     ///< the soft ones had to give: the largest violation is the least possible; the hard ones hold exactly
  infeasible,  ///< the hard ones contradict each other or the speed bound; velocity violates them least
  no_interior  ///< what must hold can be held, but by no double that was found: there is no room to round inward
};

/// "optimal", "relaxed", "infeasible", "no-interior".
const char* name(Status status);

/// What binds, and how strongly.
struct ActiveConstraint {
  Binding binding;          ///< which boundary
  double multiplier = 0.0;  ///< lambda, or nu of the disc; 0 or more, see Solution
};

/// Let n_i be the normals of the active constraints ((-1, 0) for the side v_x <= X of the box), lambda_i their
/// multipliers and nu that of the disc. Then the velocity v is stationary, up to rounding:
///
///     sum of lambda_i n_i - nu v  =  v - preferred   optimal, Objective::nearest
///                                    -preferred      optimal, Objective::farthest
///                                    0               relaxed, infeasible: weights, of which only the ratios count
///
/// These are the terms of Certificate::bound and, where half-planes contradict each other and doubles can show it, of
/// its witness. An answer of `solve_certified` can be checked from its problem and these numbers alone (inequalities
/// (1) to (4) of certificate.h); those of a batch are rounded and prove nothing until `certify` has checked them. The
/// multipliers of a `no_interior` answer are 0.
struct Solution {
  geometry::Vec2 velocity;                   ///< m/s
  Status status = Status::optimal;           ///< how `velocity` is to be read
  std::array<ActiveConstraint, 3> active{};  ///< the first `active_count` have a meaning
  std::size_t active_count = 0;              ///< at most 2 where optimal, at most 3 elsewhere
  /// c - n.v where it is largest, in m/s |n|: m/s where |n| = 1. relaxed: of the soft constraints; infeasible: of the
  /// hard ones; no_interior: of any, about a rounding error; 0 where optimal. Rounded.
  double violation = 0.0;
};

}  // namespace exactvo::lp
