// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/problem/satisfaction.h"

#include <algorithm>

#include "lp/problem/exact_sign.h"

namespace exactvo::lp {

bool must_hold(const Constraint& c, Status status) {
  if (status == Status::optimal || status == Status::no_interior) return true;
  return status == Status::relaxed && c.priority == Priority::hard;
}

bool holds(const Problem& problem, Status status, Vec2 v) {
  if (!is_finite(v) || !within(problem.bound, v)) return false;
  for (const Constraint& c : problem.constraints)
    if (must_hold(c, status) && sign_of_violation(c.half_plane, v) > 0) return false;
  return true;
}

double violation_that_counts(const Problem& problem, Status status, Vec2 v) {
  double most = 0.0;
  for (const Constraint& c : problem.constraints) {
    const bool gives = status == Status::no_interior || (status == Status::relaxed && c.priority == Priority::soft) ||
                       (status == Status::infeasible && c.priority == Priority::hard);
    if (gives) most = std::max(most, geometry::violation(c.half_plane, v));
  }
  return most;
}

}  // namespace exactvo::lp
