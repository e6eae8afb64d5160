// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/slot_plans.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

/// What robots keep anyway, so that a plan can begin from wherever half-planes let them go.
double gap_of(const Scenario& scenario) {
  return std::max(kContactSkin, std::min(scenario.margins.robot, scenario.margins.obstacle));
}

/// Plans leave a share of the radii beside that (sweeps.h), and slots may be that near to each other.
constexpr double kShareOfGap = 0.25;

/// With the speed at which robots close in on their slots.
Scenario with_larger_robots(Scenario scenario, const std::vector<Vec2>& offsets, double gap) {
  const FormationSpec& formation = *scenario.formation;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    Robot& robot = scenario.robots[i];
    robot.radius += kShareOfGap * gap;
    robot.max_speed = std::min(robot.max_speed, formation.catch_up_speed);
    robot.goals = {formation.leader.path.back() + offsets[i]};
  }
  return scenario;
}

/// m: the distance to the slot, as a measure of progress. Robots close in ever more slowly, so that near it a share of
/// the distance counts as much as the same share of a diameter.
double way_left(double distance, double diameter) {
  constexpr double kNothing = 1e-9;  // of the diameter
  const double share = std::max(distance / diameter, kNothing);
  return share >= 1.0 ? distance : diameter * (1.0 + std::log(share));
}

}  // namespace

SlotPlans::SlotPlans(const Scenario& scenario, std::vector<Vec2> offsets, int threads, std::function<bool()> is_stopped)
    : offsets_(std::move(offsets)),
      leader_arrival_(detail::leader_arrival(scenario.formation->leader)),
      tolerance_(scenario.arrival_tolerance),
      gap_(gap_of(scenario)),
      gap_to_obstacles_(kShareOfGap * gap_),
      larger_(with_larger_robots(scenario, offsets_, gap_)),
      space_(scenario.obstacles),
      groups_(larger_, space_, true, threads, std::move(is_stopped)) {}

bool SlotPlans::has_place(std::size_t robot, Vec2 slot) const {
  const double radius = larger_.robots[robot].radius;
  return space_.clearance(slot, radius) >= radius;
}

void SlotPlans::begin_step(double time, const std::vector<Anchor>& anchors, const LeaderState& leader) {
  const bool rests = is_active(time);
  if (rests && has_place_.empty())
    for (std::size_t i = 0; i < anchors.size(); ++i) has_place_.push_back(has_place(i, leader.position + offsets_[i]));
  std::vector<RobotNow> now;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const Vec2 slot = leader.position + offsets_[i];
    const bool is_there = !rests || !has_place_[i] || norm(slot - anchors[i].position) <= tolerance_;
    now.push_back({anchors[i].position, slot, is_there, rests && larger_.robots[i].cooperates, 0});
  }
  groups_.begin_step(time, std::move(now), [&](std::size_t i) {
    return way_left(norm(leader.position + offsets_[i] - anchors[i].position), 2.0 * larger_.robots[i].radius);
  });
}

}  // namespace exactvo::formation::detail
