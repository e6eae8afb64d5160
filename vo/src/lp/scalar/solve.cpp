// SPDX-License-Identifier: GPL-3.0-or-later
// `solve` of solve.h: the phases of a solution, and the repetition with more slack. Which line enters, and where the
// optimum then lies, is decided in active_set.cpp. The figure above `solve` shows the whole.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "lp/scalar/active_set.h"

#include "exactvo/vo/lp/solve.h"
#include "lp/problem/exact_sign.h"
#include "lp/proof/multipliers.h"
#include "lp/scalar/inward.h"

namespace exactvo::lp {

/// What the phases of one solve look at.
struct detail::ScalarRegions {
  Region all;        ///< every constraint
  Region hard;       ///< the hard ones alone
  Region softened;   ///< these as soft ones
  Region lowered;    ///< the soft ones moved outward
  Region wider;      ///< the slack put on outward
  Region with_disc;  ///< one of the others
};

namespace {

using Regions = detail::ScalarRegions;

void set_hard_only(const Region& region, Region& hard) {
  hard.disc = region.disc;
  hard.speed = region.speed;
  hard.lines.clear();
  for (const Line& line : region.lines)
    if (!line.soft) hard.lines.push_back(line);
}

/// The constraints may give, the sides of the box may not.
void set_softened(const Region& region, Region& softened) {
  softened = region;
  for (Line& line : softened.lines) line.soft = !is_speed_bound(line.binding);
}

/// Soft lines moved outward by `level` and a rounding error.
void set_lowered(const Region& region, double level, Region& lowered) {
  lowered = region;
  for (Line& line : lowered.lines)
    if (line.soft) line.offset -= level + kNoise * lowered.speed;
}

/// How far from its bound a velocity may be that the bound holds: the widest slack, put on by the solver, and rounding.
constexpr double kAtBound = 2.0 * kSlacks[std::size(kSlacks) - 1] * kInwardSlack;

/// False of a bound of the speed that the velocity is clearly away from: a search may have leant on it on its way.
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

Found least_violation_nearest(const Problem& problem, const Region& region, Regions& memory) {
  const Found least = least_violation(region, memory.with_disc);
  if (!leaves_a_stretch(region, least.basis)) return least;
  set_lowered(region, level_at(region, least.velocity), memory.lowered);
  const Found nearest = best_velocity(memory.lowered, problem.objective, problem.preferred);
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
void bind_as_with_room(const Problem& problem, double slack, Region& wider, Solution& s) {
  set_region_of(problem, -slack, wider);
  const Found best = best_velocity(wider, problem.objective, problem.preferred);
  if (!best.feasible || !is_finite(best.velocity)) return;
  const Solution there = solution_of(problem, wider, best, Status::optimal);
  s.active = there.active;
  s.active_count = there.active_count;
}

Solution relaxed(const Problem& problem, double slack, Regions& memory) {
  const Region& region = memory.all;
  const Found least = least_violation_nearest(problem, region, memory);
  if (!is_finite(least.velocity)) return without_answer(problem);
  Solution s = solution_of(problem, region, least, Status::relaxed);
  s.violation = violation_that_counts(problem, Status::relaxed, s.velocity);
  if (!holds(problem, Status::relaxed, s.velocity)) s.status = Status::no_interior;
  if (s.status == Status::relaxed && s.violation == 0.0 && holds(problem, Status::optimal, s.velocity)) {
    s.status = Status::optimal;
    bind_as_with_room(problem, slack, memory.wider, s);
  }
  return s;
}

Solution infeasible(const Problem& problem, double slack, Regions& memory) {
  Region& soft = memory.softened;
  set_softened(memory.hard, soft);
  const Found least = least_violation_nearest(problem, soft, memory);
  if (!is_finite(least.velocity)) return without_answer(problem);
  Solution s = solution_of(problem, soft, least, Status::infeasible);
  s.violation = violation_that_counts(problem, Status::infeasible, s.velocity);
  if (holds(problem, Status::relaxed, s.velocity)) {
    s.status = holds(problem, Status::optimal, s.velocity) ? Status::optimal : Status::relaxed;
    s.violation = violation_that_counts(problem, Status::relaxed, s.velocity);
    if (s.status == Status::optimal) bind_as_with_room(problem, slack, memory.wider, s);
  }
  return s;
}

Solution solve_with_slack(const Problem& problem, double slack, Pricing& pricing, Regions& memory) {
  const Region& region = memory.all;
  set_region_of(problem, slack, memory.all);
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
  set_hard_only(region, memory.hard);
  const bool some_give = memory.hard.lines.size() < region.lines.size();
  const bool hard_hold = some_give && best_velocity(memory.hard, Objective::nearest, Vec2{}).feasible;
  return hard_hold ? relaxed(problem, slack, memory) : infeasible(problem, slack, memory);
}

bool preferred_is_allowed(const Problem& problem) {
  return problem.objective == Objective::nearest && holds(problem, Status::optimal, problem.preferred);
}

Solution solve_with_slacks(const Problem& problem, Pricing& pricing, Regions& memory) {
  const Solution first = solve_with_slack(problem, kSlacks[0], pricing, memory);
  Solution s = first;
  for (std::size_t k = 1; k < std::size(kSlacks) && s.status == Status::no_interior; ++k)
    s = solve_with_slack(problem, kSlacks[k], pricing, memory);
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
//    preferred velocity allowed?  --yes-->  optimal, no active constraint
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
Solution solve(const Problem& problem, Pricing& pricing, SolveMemory& memory) {
  require_well_formed(problem);
  Regions& regions = *memory.regions_;
  pricing.at.clear();
  pricing.is_all = true;
  if (preferred_is_allowed(problem)) {
    pricing.at.push_back(problem.preferred);
    return {problem.preferred, Status::optimal, {}, 0, 0.0};
  }
  const int exponent = exponent_of_normals(problem);
  const bool is_plain = std::abs(exponent) <= kPlainExponent;
  pricing.is_all = is_plain;  // else another constraint may change the scale
  Solution s = is_plain ? solve_with_slacks(problem, pricing, regions)
                        : solve_with_slacks(scaled(problem, -exponent), pricing, regions);
  if (!is_plain) s.violation = std::ldexp(s.violation, exponent);
  set_multipliers(problem, s);
  return s;
}

SolveMemory::SolveMemory() : regions_(std::make_unique<detail::ScalarRegions>()) {}
SolveMemory::~SolveMemory() = default;
SolveMemory::SolveMemory(SolveMemory&&) noexcept = default;
SolveMemory& SolveMemory::operator=(SolveMemory&&) noexcept = default;

void SolveMemory::reserve(std::size_t constraints) {
  constexpr std::size_t kSidesOfBox = 4;
  for (Region* region : {&regions_->all, &regions_->hard, &regions_->softened, &regions_->lowered, &regions_->wider,
                         &regions_->with_disc})
    region->lines.reserve(constraints + kSidesOfBox);
}

Solution solve(const Problem& problem) {
  Pricing pricing;
  SolveMemory memory;
  return solve(problem, pricing, memory);
}

}  // namespace exactvo::lp
