// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/joint_decisions.h"

#include <optional>

#include "decision/repair.h"
#include "scene/moving.h"

namespace exactvo::formation::detail {

void JointDecisions::look_at_robots(const Groups* groups) {
  robot_constraints(scenario_, options_, anchors, scene_, others);
  if (!groups || !groups->any()) return;
  std::vector<std::optional<Vec2>> planned(anchors.size());
  for (std::size_t i = 0; i < planned.size(); ++i)
    if (groups->is_member(i)) planned[i] = groups->wanted(i);
  follow_plans(scenario_, anchors, scene_, planned, others, gap);
}

void JointDecisions::choose_by_plan(std::size_t i, Vec2 wanted, Viewpoint here, const StaticField& field, double time,
                                    RobotStep& step, const std::vector<std::size_t>* fallen_back) {
  here.velocity = wanted;
  here.horizon = scenario_.time_step;
  field.constraints(here, statics_, reach_of_step(scenario_, here));
  const std::optional<double> share = allowed_share(wanted, statics_, others[i]);
  held_by_all_[i] = !share;
  decider_.decide(
      {share.value_or(0.0) * wanted, here, &statics_, &others[i], schedule_.keeps_all(time), nullptr, fallen_back},
      step);
}

void JointDecisions::settle(Groups& groups, Step& row, const std::function<Viewpoint(std::size_t)>& viewpoint,
                            const ChooseAgain& choose_again) {
  repair(groups, row, choose_again);
  while (groups.any() && groups.halt_those_held_back(row)) {
    look_at_robots(&groups);
    for (std::size_t i = 0; i < row.robots.size(); ++i) {
      add_moving_constraints(scenario_, viewpoint(i), scene_, others[i]);
      choose_again(i, row.robots[i], nullptr);
    }
    repair(groups, row, choose_again);
  }
  groups.end_step(row);
}

void JointDecisions::repair(const Groups& groups, Step& row, const ChooseAgain& choose_again) {
  const auto is_contradicted = [&](std::size_t i) {
    return row.robots[i].status != lp::Status::optimal || (groups.is_member(i) && held_by_all_[i]);
  };
  const auto fallen = detail::repair(
      scenario_, anchors, scene_, others, is_contradicted,
      [&](std::size_t i, const std::vector<std::size_t>& with) { choose_again(i, row.robots[i], &with); }, gap);
  // Held from all sides, with less room than there is between doubles: it stands still, which they all allow.
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    if (row.robots[i].status != lp::Status::no_interior || groups.is_member(i)) continue;
    row.robots[i].preferred = {};
    choose_again(i, row.robots[i], &fallen[i]);
  }
}

}  // namespace exactvo::formation::detail
