// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/plan_tries.h"

#include <algorithm>
#include <cmath>

#include "exactvo/formation/speed_profile.h"
#include "scene/goals.h"

namespace exactvo::formation::detail {

double patience_of(const std::vector<Robot>& robots) {
  double patience = 0.0;
  for (const Robot& r : robots) patience = std::max(patience, 2.0 * r.radius / r.max_speed);
  return patience;
}

PlanTries::Look PlanTries::look(double time, const std::vector<RobotNow>& now,
                                const std::vector<std::size_t>& who) const {
  Look look;
  for (const std::size_t i : who) {
    if (now[i].has_arrived) continue;
    look.waiting.first.push_back(i);
    look.waiting.second.push_back(now[i].goal_number);
    look.left += norm(now[i].goal - now[i].position);
  }
  for (std::size_t k = 0; k < moving_.size(); ++k) look.others.emplace_back(k, displacement_at(moving_[k], time));
  for (std::size_t i = 0; i < now.size(); ++i)
    if (!now[i].may_join) look.others.emplace_back(i, now[i].position);
  return look;
}

/// Something has moved that could have kept them from their goals, or they have come nearer to these.
bool PlanTries::has_changed_since(const Tries& tries, const Look& look) const {
  const double far = kNearer * 2.0 * largest_radius(robots_, look.waiting.first);
  if (look.left < tries.left - far) return true;
  return !std::equal(
      look.others.begin(), look.others.end(), tries.others.begin(), tries.others.end(),
      [&](const auto& a, const auto& b) { return a.first == b.first && norm(a.second - b.second) <= far; });
}

bool PlanTries::are_in_vain(double time, const std::vector<RobotNow>& now, const std::vector<std::size_t>& who) const {
  constexpr double kPause = 40.0;  // in the time that the slowest robot needs for its diameter; then twice as long
  const Look here = look(time, now, who);
  const auto found = tries_.find(here.waiting);
  if (found == tries_.end() || found->second.number < kMost) return false;
  const Tries& tries = found->second;
  return !has_changed_since(tries, here) && time - tries.last < std::ldexp(kPause * patience_, tries.number - kMost);
}

void PlanTries::count(double time, const std::vector<RobotNow>& now, const std::vector<std::size_t>& who) {
  Look here = look(time, now, who);
  Tries& tries = tries_[here.waiting];
  if (tries.number == 0 || has_changed_since(tries, here)) tries = {0, 0.0, here.left, std::move(here.others)};
  ++tries.number;
  tries.last = time;
}

}  // namespace exactvo::formation::detail
