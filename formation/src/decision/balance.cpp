// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/balance.h"

namespace exactvo::formation {
namespace {

/// Into the allowed side; of the disc its length is that of the velocity, as its multiplier has it (solution.h).
Vec2 normal_of(const lp::Binding& bound, Vec2 chosen) {
  switch (bound.kind) {
    case lp::BindingKind::box_right:
      return {-1.0, 0.0};
    case lp::BindingKind::box_left:
      return {1.0, 0.0};
    case lp::BindingKind::box_top:
      return {0.0, -1.0};
    case lp::BindingKind::box_bottom:
      return {0.0, 1.0};
    default:
      return -chosen;
  }
}

void add_force(Balance& balance, std::optional<std::size_t> constraint, Vec2 normal, double multiplier) {
  const double length = norm(normal);
  if (!(multiplier > 0.0 && length > 0.0)) return;
  balance.forces.push_back({constraint, normal / length, multiplier * length});
}

}  // namespace

double Balance::factor_of(std::size_t constraint) const {
  for (const Force& force : forces)
    if (force.constraint == constraint) return force.factor;
  return 0.0;
}

Balance balance_of(const RobotStep& decision) {
  Balance balance;
  Vec2 rest = decision.chosen - decision.preferred;
  if (decision.status == lp::Status::optimal) {
    for (std::size_t i = 0; i < decision.constraints.size(); ++i) {
      const DecisionConstraint& c = decision.constraints[i];
      if (c.active) add_force(balance, i, c.half_plane.normal, c.multiplier);
    }
    for (const lp::ActiveConstraint& bound : decision.bound)
      add_force(balance, std::nullopt, normal_of(bound.binding, decision.chosen), bound.multiplier);
  }
  for (const Balance::Force& force : balance.forces) rest = rest - force.factor * force.normal;
  balance.remainder = norm(rest);
  return balance;
}

}  // namespace exactvo::formation
