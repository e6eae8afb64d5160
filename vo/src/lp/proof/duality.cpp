// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/proof/duality.h"

#include <cmath>

#include "lp/problem/region.h"

namespace exactvo::lp {
namespace {

/// False where it may not be used.
bool add_term(const Problem& problem, const Term& term, Scope scope, Combination& sum) {
  Exact multiplier = 0;
  for (const double part : term.multiplier) {
    if (!std::isfinite(part)) return false;
    multiplier = multiplier + Exact(part);
  }
  if (!can_be_used(problem, term.binding, scope) || sign_of(multiplier) < 0) return false;
  if (term.binding == kDisc) {
    sum.disc = sum.disc + multiplier;
    return true;
  }
  const ExactLine line = exact(half_plane_at(problem, term.binding));
  sum.normal = sum.normal + multiplier * line.normal;
  sum.offset = sum.offset + multiplier * line.offset;
  if (may_give(problem, term.binding, scope)) sum.giving = sum.giving + multiplier;
  return true;
}

Exact magnitude(const Exact& x) {
  return sign_of(x) < 0 ? -x : x;
}

bool bounds_nearest(const Problem& problem, const Combination& sum, Vec2 velocity, double gap) {
  const ExactVector p = exact(problem.preferred);
  const ExactVector away = exact(velocity) - p, pulled = p + sum.normal;
  const Exact weight = Exact(1) + sum.disc;
  Exact most = dot(p, p) + Exact(2) * sum.offset;
  if (sign_of(sum.disc) > 0) most = most - sum.disc * Exact(problem.bound.disc) * Exact(problem.bound.disc);
  return sign_of(weight * (dot(away, away) - Exact(gap) - most) + dot(pulled, pulled)) <= 0;
}

bool bounds_farthest(const Problem& problem, const Combination& sum, Vec2 velocity, double gap) {
  const ExactVector d = exact(problem.preferred);
  const Exact limit = dot(d, exact(velocity)) + Exact(gap) + sum.offset;
  return reaches_less(problem.bound, d + sum.normal, limit, false);
}

}  // namespace

Scope scope_of(Status status) {
  if (status == Status::relaxed) return Scope::soft_may_give;
  return status == Status::infeasible ? Scope::hard_may_give : Scope::all_must_hold;
}

bool can_be_used(const Problem& problem, Binding binding, Scope scope) {
  if (binding == kDisc) return std::isfinite(problem.bound.disc);
  if (is_speed_bound(binding)) return std::isfinite(half_plane_at(problem, binding).offset);
  if (binding.index >= problem.constraints.size()) return false;
  return scope != Scope::hard_may_give || problem.constraints[binding.index].priority == Priority::hard;
}

bool may_give(const Problem& problem, Binding binding, Scope scope) {
  if (is_speed_bound(binding) || scope == Scope::all_must_hold) return false;
  return scope == Scope::hard_may_give || problem.constraints[binding.index].priority == Priority::soft;
}

HalfPlane half_plane_at(const Problem& problem, Binding binding) {
  return is_speed_bound(binding) ? side_of_box(problem.bound, binding.kind)
                                 : problem.constraints[binding.index].half_plane;
}

Combination combine(const Problem& problem, const std::vector<Term>& terms, Scope scope) {
  Combination sum;
  sum.well_formed = true;
  for (const Term& term : terms) sum.well_formed = sum.well_formed && add_term(problem, term, scope, sum);
  return sum;
}

bool reaches_less(const SpeedBound& bound, const ExactVector& w, const Exact& limit, bool strict) {
  const int highest = strict ? -1 : 0;
  const Exact squared = dot(w, w);
  if (sign_of(squared) == 0) return -sign_of(limit) <= highest;
  if (sign_of(limit) < 0) return false;
  if (std::isfinite(bound.disc)) {
    const Exact radius(bound.disc);
    if (sign_of(radius * radius * squared - limit * limit) <= highest) return true;
  }
  const bool box_x = std::isfinite(bound.box_x) || sign_of(w.x) == 0;
  const bool box_y = std::isfinite(bound.box_y) || sign_of(w.y) == 0;
  if (!box_x || !box_y) return false;
  Exact reach = 0;
  if (sign_of(w.x) != 0) reach = reach + Exact(bound.box_x) * magnitude(w.x);
  if (sign_of(w.y) != 0) reach = reach + Exact(bound.box_y) * magnitude(w.y);
  return sign_of(reach - limit) <= highest;
}

bool contradicts(const Problem& problem, const Combination& sum) {
  return reaches_less(problem.bound, sum.normal, sum.offset, true);
}

bool bounds_violation(const Problem& problem, const Combination& sum, double violation, double gap) {
  if (sign_of(sum.giving) <= 0) return false;
  const Exact level = (Exact(violation) - Exact(gap)) * sum.giving;
  return sign_of(level) <= 0 || reaches_less(problem.bound, sum.normal, sum.offset - level, false);
}

bool bounds_objective(const Problem& problem, const Combination& sum, Vec2 velocity, double gap) {
  return problem.objective == Objective::nearest ? bounds_nearest(problem, sum, velocity, gap)
                                                 : bounds_farthest(problem, sum, velocity, gap);
}

}  // namespace exactvo::lp
