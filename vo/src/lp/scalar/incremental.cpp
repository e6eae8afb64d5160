// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iterator>

#include "lp/scalar/active_set.h"

#include "exactvo/vo/lp/solve.h"
#include "lp/problem/satisfaction.h"
#include "lp/proof/multipliers.h"
#include "lp/scalar/inward.h"

namespace exactvo::lp {
namespace {

bool has_priority(const Problem& problem, Priority priority) {
  return std::any_of(problem.constraints.begin(), problem.constraints.end(),
                     [&](const Constraint& c) { return c.priority == priority; });
}

Region hard_only(Region region) {
  region.lines.erase(
      std::remove_if(region.lines.begin(), region.lines.end(), [](const Line& line) { return line.soft; }),
      region.lines.end());
  return region;
}

/// The constraints may give, the sides of the box may not.
Region softened(Region region) {
  for (Line& line : region.lines) line.soft = !is_speed_bound(line.binding);
  return region;
}

/// Soft lines moved outward by `level` and a rounding error.
Region lowered(Region region, double level) {
  for (Line& line : region.lines)
    if (line.soft) line.offset -= level + kNoise * region.speed;
  return region;
}

/// How far from its bound a velocity may be that the bound holds: the widest slack, put on by the solver, and rounding.
constexpr double kAtBound = 2.0 * kSlacks[std::size(kSlacks) - 1] * kInwardSlack;

/// False of a bound of the speed that the velocity is clearly away from: a walk may have leant on it on its way.
bool may_bind(const SpeedBound& bound, double speed, Binding binding, Vec2 v) {
  if (!is_speed_bound(binding)) return true;
  const double near = kAtBound * speed;
  if (binding == kDisc) return norm(v) >= bound.disc - near;
  const HalfPlane side = side_of_box(bound, binding.kind);
  return dot(side.normal, v) <= side.offset + near;
}

Solution solution_of(const Problem& problem, const Region& region, const Found& found, Status status) {
  Solution solution;
  solution.velocity = into_box(found.velocity, problem.bound);
  solution.status = status;
  for (std::size_t k = 0; k < found.basis.size; ++k) {
    const std::size_t m = found.basis.member[k];
    const Binding binding = m < region.lines.size() ? region.lines[m].binding : kDisc;
    if (may_bind(problem.bound, region.speed, binding, solution.velocity))
      solution.active[solution.active_count++].binding = binding;
  }
  return solution;
}

/// A pair of opposite lines leaves a whole stretch of least violation: the point of it that is nearest the preference.
bool leaves_a_stretch(const Region& region, const Basis& basis) {
  for (std::size_t j = 0; j < basis.size; ++j) {
    for (std::size_t k = j + 1; k < basis.size; ++k) {
      if (std::max(basis.member[j], basis.member[k]) >= region.lines.size()) continue;
      const Vec2 a = region.lines[basis.member[j]].normal;
      const Vec2 b = region.lines[basis.member[k]].normal;
      if (cross(a, b) == 0.0 && dot(a, b) < 0.0) return true;
    }
  }
  return false;
}

double level_at(const Region& region, Vec2 v) {
  double level = 0.0;
  for (const Line& line : region.lines)
    if (line.soft) level = std::max(level, excess(line, v));
  return level;
}

Found least_violation_nearest(const Problem& problem, const Region& region) {
  const Found least = least_violation(region);
  if (!leaves_a_stretch(region, least.basis)) return least;
  const Region lower = lowered(region, level_at(region, least.velocity));
  const Found nearest = best_velocity(lower, problem.objective, problem.preferred);
  return nearest.feasible ? Found{true, nearest.velocity, least.basis} : least;
}

/// Products of numbers far apart may leave the range of double. Then nothing was found: 0 keeps the bound, and no claim
/// is made of it.
Solution without_answer(const Problem& problem) {
  Solution s;
  s.status = Status::no_interior;
  s.violation = violation_that_counts(problem, s.status, s.velocity);
  return s;
}

/// Where the inward slack alone left no room, the least violation says little of the optimum: what binds there is what
/// binds with the slack put on outward, a rounding error away.
void bind_as_with_room(const Problem& problem, double slack, Solution& s) {
  const Region wider = region_of(problem, -slack);
  const Found best = best_velocity(wider, problem.objective, problem.preferred);
  if (!best.feasible || !is_finite(best.velocity)) return;
  const Solution there = solution_of(problem, wider, best, Status::optimal);
  s.active = there.active;
  s.active_count = there.active_count;
}

Solution relaxed(const Problem& problem, const Region& region, double slack) {
  const Found least = least_violation_nearest(problem, region);
  if (!is_finite(least.velocity)) return without_answer(problem);
  Solution s = solution_of(problem, region, least, Status::relaxed);
  s.violation = violation_that_counts(problem, Status::relaxed, s.velocity);
  if (!holds(problem, Status::relaxed, s.velocity)) s.status = Status::no_interior;
  if (s.status == Status::relaxed && s.violation == 0.0 && holds(problem, Status::optimal, s.velocity)) {
    s.status = Status::optimal;
    bind_as_with_room(problem, slack, s);
  }
  return s;
}

Solution infeasible(const Problem& problem, const Region& hard, double slack) {
  const Region soft = softened(hard);
  const Found least = least_violation_nearest(problem, soft);
  if (!is_finite(least.velocity)) return without_answer(problem);
  Solution s = solution_of(problem, soft, least, Status::infeasible);
  s.violation = violation_that_counts(problem, Status::infeasible, s.velocity);
  if (holds(problem, Status::relaxed, s.velocity)) {
    s.status = holds(problem, Status::optimal, s.velocity) ? Status::optimal : Status::relaxed;
    s.violation = violation_that_counts(problem, Status::relaxed, s.velocity);
    if (s.status == Status::optimal) bind_as_with_room(problem, slack, s);
  }
  return s;
}

Solution solve_with_slack(const Problem& problem, double slack, Pricing& pricing) {
  const Region region = region_of(problem, slack);
  const Found best = best_velocity(region, problem.objective, problem.preferred, &pricing.at);
  pricing.is_all = pricing.is_all && best.feasible;
  if (best.feasible) {
    if (!is_finite(best.velocity)) return without_answer(problem);
    Solution s = solution_of(problem, region, best, Status::optimal);
    if (holds(problem, Status::optimal, s.velocity)) return s;
    s.status = Status::no_interior;
    s.violation = violation_that_counts(problem, Status::no_interior, s.velocity);
    return s;
  }
  const Region hard = hard_only(region);
  const bool hard_hold =
      has_priority(problem, Priority::soft) && best_velocity(hard, Objective::nearest, Vec2{}).feasible;
  return hard_hold ? relaxed(problem, region, slack) : infeasible(problem, hard, slack);
}

bool preferred_is_allowed(const Problem& problem) {
  return problem.objective == Objective::nearest && holds(problem, Status::optimal, problem.preferred);
}

Solution solve_with_slacks(const Problem& problem, Pricing& pricing) {
  const Solution first = solve_with_slack(problem, kSlacks[0], pricing);
  Solution s = first;
  for (std::size_t k = 1; k < std::size(kSlacks) && s.status == Status::no_interior; ++k)
    s = solve_with_slack(problem, kSlacks[k], pricing);
  return s.status == Status::optimal || s.status == Status::relaxed ? s : first;
}

/// Of the longest normal. 0 without constraints.
int exponent_of_normals(const Problem& problem) {
  double longest = 0.0;
  for (const Constraint& c : problem.constraints)
    longest = std::max({longest, std::abs(c.half_plane.normal.x), std::abs(c.half_plane.normal.y)});
  return longest > 0.0 ? std::ilogb(longest) : 0;
}

/// Up to here the squares and products of normals and offsets are far inside the range of doubles.
constexpr int kPlainExponent = 100;

/// The same problem with every constraint multiplied by 2^exponent: exact but for underflow, and which violation is
/// largest stays as it is.
Problem scaled(Problem problem, int exponent) {
  for (Constraint& c : problem.constraints) {
    HalfPlane& h = c.half_plane;
    h = {{std::ldexp(h.normal.x, exponent), std::ldexp(h.normal.y, exponent)}, std::ldexp(h.offset, exponent)};
  }
  return problem;
}

}  // namespace

// A dual active-set method (Goldfarb and Idnani 1983) in the plane: the working set holds at most two lines, each pivot
// is the one-dimensional problem of Seidel's incremental algorithm (1991; de Berg et al., chapter 4). What cannot all
// hold is relaxed in the minimax sense, as van den Berg et al. (2011) do, by the same steps one dimension higher.
//
//    preferred velocity allowed?  --yes-->  optimal, nothing binds
//           | no
//    FEASIBILITY PHASE
//           v
//    the optimum of the speed bound alone
//           v
//    pricing: the line violated most  --none is-->  optimal
//           |                      ^
//           | it enters            | next pivot
//           v                      |
//    pivot: the optimum on its boundary, inside the working set
//           |
//           | nothing is left there: a contradiction of at most three
//           v
//    do the hard constraints hold alone?  --no-->  the hard ones may give, and soft ones do not count
//           | yes: the soft ones may give             |
//    RELAXATION PHASE, in (v_x, v_y, violation t)     |
//           v                                         v
//    pricing and pivots as above: the lowest point above a plane t = c - n.v for each constraint
//    that may give, inside a wall for each that may not
//           |                                         |
//           v                                         v
//        relaxed                                  infeasible
//
// Lines carry an inward slack. The velocity is then held exactly against the constraints as they were given; where it
// breaks one, all is repeated with more slack, and where no slack helps the answer is `no_interior`.
Solution solve(const Problem& problem, Pricing& pricing) {
  require_well_formed(problem);
  pricing.at.clear();
  pricing.is_all = true;
  if (preferred_is_allowed(problem)) {
    pricing.at.push_back(problem.preferred);
    return {problem.preferred, Status::optimal, {}, 0, 0.0};
  }
  const int exponent = exponent_of_normals(problem);
  const bool is_plain = std::abs(exponent) <= kPlainExponent;
  pricing.is_all = is_plain;  // else another constraint may change the scale
  Solution s = is_plain ? solve_with_slacks(problem, pricing) : solve_with_slacks(scaled(problem, -exponent), pricing);
  if (!is_plain) s.violation = std::ldexp(s.violation, exponent);
  set_multipliers(problem, s);
  return s;
}

Solution solve(const Problem& problem) {
  Pricing pricing;
  return solve(problem, pricing);
}

}  // namespace exactvo::lp
