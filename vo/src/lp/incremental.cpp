// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "active_set.h"
#include "exact_sign.h"
#include "exactvo/vo/lp/solve.h"

namespace exactvo::lp {
namespace {

/// Slacks tried in turn, in units of kInwardSlack: sharp vertices need more of it.
constexpr double kSlacks[] = {1.0, 8.0, 64.0, 512.0};

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
  for (Line& line : region.lines) line.soft = !is_speed_bound(line.index);
  return region;
}

/// Soft lines moved outward by `level` and a rounding error.
Region lowered(Region region, double level) {
  for (Line& line : region.lines)
    if (line.soft) line.offset -= level + kNoise * region.speed;
  return region;
}

Vec2 into_box(Vec2 v, const SpeedBound& b) {
  return {std::clamp(v.x, -b.box_x, b.box_x), std::clamp(v.y, -b.box_y, b.box_y)};
}

bool holds_all(const Problem& problem, Vec2 v, bool soft_too) {
  if (!within(problem.bound, v)) return false;
  for (const Constraint& c : problem.constraints)
    if ((soft_too || c.priority == Priority::hard) && sign_of_violation(c.half_plane, v) > 0) return false;
  return true;
}

double largest_violation(const Problem& problem, Vec2 v, Priority priority) {
  double most = 0.0;
  for (const Constraint& c : problem.constraints)
    if (c.priority == priority) most = std::max(most, geometry::violation(c.half_plane, v));
  return most;
}

Solution solution_of(const Problem& problem, const Region& region, const Found& found, Status status) {
  Solution solution;
  solution.velocity = into_box(found.velocity, problem.bound);
  solution.status = status;
  for (std::size_t k = 0; k < found.basis.size; ++k) {
    const std::size_t m = found.basis.member[k];
    solution.active[solution.active_count++] = m < region.lines.size() ? region.lines[m].index : kSpeedBound;
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

Solution relaxed(const Problem& problem, const Region& region) {
  Solution s = solution_of(problem, region, least_violation_nearest(problem, region), Status::relaxed);
  s.violation = largest_violation(problem, s.velocity, Priority::soft);
  if (!holds_all(problem, s.velocity, false)) s.status = Status::pinched;
  if (s.status == Status::relaxed && s.violation == 0.0 && holds_all(problem, s.velocity, true))
    s.status = Status::optimal;
  return s;
}

Solution infeasible(const Problem& problem, const Region& hard) {
  const Region soft = softened(hard);
  Solution s = solution_of(problem, soft, least_violation_nearest(problem, soft), Status::infeasible);
  s.violation = largest_violation(problem, s.velocity, Priority::hard);
  if (holds_all(problem, s.velocity, false)) {
    s.status = holds_all(problem, s.velocity, true) ? Status::optimal : Status::relaxed;
    s.violation = largest_violation(problem, s.velocity, Priority::soft);
  }
  return s;
}

Solution solve_with_slack(const Problem& problem, double slack) {
  const Region region = region_of(problem, slack);
  const Found best = best_velocity(region, problem.objective, problem.preferred);
  if (best.feasible) {
    Solution s = solution_of(problem, region, best, Status::optimal);
    if (holds_all(problem, s.velocity, true)) return s;
    s.status = Status::pinched;
    s.violation = std::max(largest_violation(problem, s.velocity, Priority::hard),
                           largest_violation(problem, s.velocity, Priority::soft));
    return s;
  }
  const Region hard = hard_only(region);
  const bool hard_hold =
      has_priority(problem, Priority::soft) && best_velocity(hard, Objective::nearest, Vec2{}).feasible;
  return hard_hold ? relaxed(problem, region) : infeasible(problem, hard);
}

bool preferred_is_allowed(const Problem& problem) {
  return problem.objective == Objective::nearest && holds_all(problem, problem.preferred, true);
}

}  // namespace

Solution solve(const Problem& problem) {
  require_well_formed(problem);
  if (preferred_is_allowed(problem)) return {problem.preferred, Status::optimal, {}, 0, 0.0};
  const Solution first = solve_with_slack(problem, kSlacks[0]);
  Solution s = first;
  for (std::size_t k = 1; k < std::size(kSlacks) && s.status == Status::pinched; ++k)
    s = solve_with_slack(problem, kSlacks[k]);
  return s.status == Status::optimal || s.status == Status::relaxed ? s : first;
}

}  // namespace exactvo::lp
