// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/joint_decisions.h"

#include <algorithm>
#include <optional>
#include <set>

#include "scene/moving.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {

void JointDecisions::begin_step() {
  anchors.clear();
  std::fill(brakes_.begin(), brakes_.end(), 0);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const Viewpoint here = viewpoint_(i);
    anchors.push_back({here.position, here.velocity});
  }
}

void JointDecisions::look_at_robots(const Groups* groups) {
  robot_constraints(now(), pairs_, others);
  keep_from_nearing(now(), others);
  if (!groups || !groups->any()) return;
  std::vector<std::optional<Vec2>> planned(anchors.size());
  std::vector<double> gaps(anchors.size(), gap);
  for (std::size_t i = 0; i < planned.size(); ++i) {
    if (!groups->is_member(i)) continue;
    planned[i] = groups->wanted(i);
    gaps[i] = std::max(gap, groups->gap(i));
  }
  follow_plans(now(), planned, others, gaps);
}

void JointDecisions::choose_by_plan(std::size_t i, const Groups& groups, const StaticField& field, double time,
                                    RobotStep& step) {
  step.mode = groups.goes_back(i) ? Mode::going_back : Mode::by_plan;
  const Vec2 wanted = groups.wanted(i);
  Viewpoint here = viewpoint_(i);
  here.velocity = wanted;
  here.horizon = rules_.time_step;
  field.constraints(here, statics_, reach_of_step(rules_.time_step, here.max_speed));
  const std::optional<double> share = allowed_share(wanted, statics_, others[i]);
  held_by_all_[i] = !share;
  decider_.decide({share.value_or(0.0) * wanted, here, &statics_, &others[i], schedule_.keeps_all(time)}, step);
}

void JointDecisions::settle(Groups* groups, Step& row) {
  repair(groups, row);
  if (!groups) return;
  while (groups->any() && groups->halt_those_held_back(row)) {
    look_at_robots(groups);
    for (std::size_t i = 0; i < row.robots.size(); ++i) {
      add_moving_constraints(rules_, viewpoint_(i), scene_, others[i]);
      choose_again_(i, row.robots[i]);
    }
    repair(groups, row);
  }
  groups->end_step(row);
}

/// Repair instead of relaxing (liveness, rule R0): as long as there are robots whose half-planes, as they decided last,
/// contradict each other, all pairs of these fall back to those that they would have at rest, and decide again. In each
/// round some pair does so for good, so that it ends. They keep what is left of their margin: resting satisfies that
/// too. Half-planes of moving obstacles and of robots that do not yield may still be relaxed. With an acceleration such
/// a robot keeps to what braking satisfies, against static obstacles too (braking.h). Own-side lines it satisfies as
/// they are (own_side.h).
void JointDecisions::repair(const Groups* groups, Step& row) {
  const auto is_member = [&](std::size_t i) { return groups && groups->is_member(i); };
  const auto is_contradicted = [&](std::size_t i) {
    return bodies_gave(row.robots[i]) || (is_member(i) && held_by_all_[i]);
  };
  std::set<std::size_t> contradicted;
  for (std::size_t i = 0; i < others.size(); ++i)
    if (is_contradicted(i)) contradicted.insert(i);
  std::vector<std::vector<std::size_t>> fallen(others.size());  // with whom each fell back
  const double kept = std::max(gap, pair_rule(rules_).margin);
  while (!contradicted.empty()) {
    std::set<std::size_t> changed;
    for (const std::size_t i : contradicted) {
      if (rules_.has_brakes() && !brakes(i)) {
        brakes_[i] = 1;
        changed.insert(i);
      }
      for (const Constraint& c : others[i]) {
        const std::size_t j = c.index;
        const bool both_yield = is_of_robot(scene_, c) && robots_[i].cooperates && robots_[j].cooperates;
        if (!both_yield || rules_.measurements || std::find(fallen[i].begin(), fallen[i].end(), j) != fallen[i].end())
          continue;
        fall_back(now(), i, j, others, kept);
        fallen[i].push_back(j);
        fallen[j].push_back(i);
        changed.insert({i, j});
      }
    }
    contradicted.clear();
    for (const std::size_t i : changed) {
      choose_again_(i, row.robots[i]);
      if (is_contradicted(i)) contradicted.insert(i);
    }
  }
  // Held from all sides, with less room than there is between doubles: it stands still, or brakes, which they all
  // allow.
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    const lp::Status status = row.robots[i].status;
    const bool is_held = rules_.has_brakes() ? status != lp::Status::optimal : status == lp::Status::no_interior;
    if (!is_held || is_member(i)) continue;
    row.robots[i].preferred = rules_.has_brakes() ? rules_.braked(anchors[i].velocity) : Vec2{};
    choose_again_(i, row.robots[i]);
  }
  record_both_halves(fallen, row);
}

/// The halves of a pair that fell back are halves of a change from rest, and those of an eased pair of one from a slower
/// velocity, not from the robots' velocities: one alone proves nothing in general. Where one of the two has its half on
/// the record, the other gets its own, which did not bind.
void JointDecisions::record_both_halves(const std::vector<std::vector<std::size_t>>& fallen, Step& row) const {
  const auto is_against = [&](std::size_t robot) {
    return [robot](const DecisionConstraint& c) { return c.source == ConstraintSource::robot && c.index == robot; };
  };
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    for (const DecisionConstraint& c : row.robots[i].constraints) {
      const std::size_t j = c.index;
      if (!is_against(j)(c)) continue;
      const bool fell_back = std::find(fallen[i].begin(), fallen[i].end(), j) != fallen[i].end();
      if (!fell_back && !is_eased(now(), i, j)) continue;
      std::vector<DecisionConstraint>& theirs = row.robots[j].constraints;
      if (std::any_of(theirs.begin(), theirs.end(), is_against(i))) continue;
      for (const Constraint& half : others[j])
        if (is_of_robot(scene_, half) && half.index == i) theirs.push_back(decider_.idle(half));
    }
  }
}

}  // namespace exactvo::formation::detail
