// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/slot_plans.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "scene/number_text.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

/// Share of the gap that robots keep. Plans also leave a share of the radii (sweeps.h), and slots may be as near to
/// each other as the sum of both.
constexpr double kShareOfGap = 0.25;

/// A share of the tolerance: a robot that ends as near beside its slot counts as there.
constexpr double kNearEnough = 0.9;

/// With the speed at which robots close in on their slots.
std::vector<Robot> larger_robots(std::vector<Robot> robots, const FormationSpec& formation,
                                 const std::vector<Vec2>& offsets, double gap) {
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Robot& robot = robots[i];
    robot.radius += kShareOfGap * gap;
    robot.max_speed = std::min(robot.max_speed, formation.catch_up_speed);
    robot.goals = {formation.leader.path.back() + offsets[i]};
  }
  return robots;
}

/// m: the distance to the slot, as a measure of progress. Robots close in ever more slowly, so that near it a share of
/// the distance counts as much as the same share of a diameter.
double way_left(double distance, double diameter) {
  constexpr double kNothing = 1e-9;  // of the diameter
  const double share = std::max(distance / diameter, kNothing);
  return share >= 1.0 ? distance : diameter * (1.0 + std::log(share));
}

}  // namespace

SlotPlans::SlotPlans(const Scenario& scenario, const DecisionRules& rules, std::vector<Vec2> offsets,
                     std::function<bool()> is_stopped)
    : scenario_(scenario),
      offsets_(std::move(offsets)),
      leader_arrival_(detail::leader_arrival(scenario.formation->leader)),
      tolerance_(scenario.arrival_tolerance),
      // What robots keep anyway, so that a plan can begin from wherever half-planes let them go.
      gap_(std::max(kContactSkin, std::min(rules.margins.robot, rules.margins.obstacle))),
      gap_to_obstacles_(kShareOfGap * gap_),
      larger_(larger_robots(scenario.robots, *scenario.formation, offsets_, gap_)),
      space_(scenario.obstacles),
      groups_(scenario, rules, larger_, space_, true, std::move(is_stopped)) {}

double SlotPlans::room_of(std::size_t robot) const {
  return scenario_.robots[robot].radius + scenario_.margins.obstacle + 2.0 * kContactSkin;
}

/// Empty where nothing is known to keep the robot from the slot.
std::string SlotPlans::why_no_place(std::size_t robot, Vec2 from, Vec2 slot, Reachability& reach) const {
  const double radius = scenario_.robots[robot].radius;
  const double wanted = std::max(larger_[robot].radius, room_of(robot) - kNearEnough * tolerance_);
  if (space_.clearance(slot, wanted) < wanted) {
    double nearest = geometry::kInfinity;
    std::string id;
    for (const SceneObstacle& o : scenario_.obstacles) {
      const double distance = signed_distance(o, slot);
      if (distance < nearest) id = o.id, nearest = distance;
    }
    return "obstacle '" + id + "' " + (nearest > 0.0 ? "is only " + metres(nearest) + " from it" : "stands in it");
  }
  const Destination to{slot, tolerance_};
  const bool is_open = norm(slot - from) <= tolerance_ || space_.is_clear(from, slot, radius);
  if (is_open || reach.reachable_place(radius, from, to) || !reach.is_proven_out_of_reach(radius, from, to)) return "";
  return reach.why_not(radius, from, {slot, 0.0}, "it");
}

/// Straight away from what is too near.
Vec2 SlotPlans::off_the_wall(std::size_t robot, Vec2 slot) const {
  const double room = room_of(robot);
  const Vec2 away = space_.from_nearest_edge(slot, room);
  return norm(away) > 0.0 ? slot + (room / norm(away) - 1.0) * away : slot;
}

/// Whose slot is in the margin of a wall goes to where that leaves it room, if it counts as there: else it would drive
/// round the wall. Where others have places nearer to that than to its slot, it keeps its slot, which robots that go by
/// plan reach.
void SlotPlans::shift_off_the_wall(std::size_t i) {
  constexpr double kAsFar = 1.0 - 1e-3;
  Place& mine = places_[i];
  const Vec2 beside = off_the_wall(i, mine.at);
  const double room = room_of(i);
  bool is_free = norm(beside - mine.at) <= kNearEnough * tolerance_ && space_.clearance(beside, room) >= room;
  for (std::size_t j = 0; j < places_.size() && is_free; ++j)
    is_free = j == i ||
              norm(beside - places_[j].at) >= std::min((1.0 + kPlannedGap) * (larger_[i].radius + larger_[j].radius),
                                                       kAsFar * norm(mine.at - places_[j].at));
  if (is_free) mine.at = beside;
}

/// Straight away from what is too near, else on rings about the slot; where there is none, the robot stays where it is.
Vec2 SlotPlans::free_place_near(std::size_t robot, Vec2 from, Vec2 slot, const std::vector<geometry::Disc>& taken,
                                Reachability& reach) const {
  constexpr double kFinest = 0.25, kBeyond = 16.0;  // of the radius: between rings, and beyond where it is
  constexpr double kMostRings = 128.0;
  const double radius = scenario_.robots[robot].radius, room = room_of(robot);
  const auto is_free = [&](Vec2 place) {
    return space_.clearance(place, room) >= room &&
           std::all_of(taken.begin(), taken.end(), [&](const geometry::Disc& t) {
             return norm(place - t.center) >= (1.0 + kPlannedGap) * (radius + t.radius) + scenario_.margins.robot;
           });
  };
  const auto is_good = [&](Vec2 place) {
    return is_free(place) && (space_.is_open() || reach.reachable_place(radius, from, {place, 0.0}));
  };
  const Vec2 beside = off_the_wall(robot, slot);
  if (beside != slot && is_good(beside)) return beside;
  const Vec2 way = norm(from - slot) > 0.0 ? geometry::normalized(from - slot) : Vec2{1.0, 0.0};
  const double far = norm(from - slot) + kBeyond * radius, step = std::max(kFinest * radius, far / kMostRings);
  for (int ring = 1; ring * step < far; ++ring)
    for (int k = 0, directions = 6 * ring; k < directions; ++k) {
      // Nearest to the robot first.
      const double turn = (k % 2 == 0 ? 1.0 : -1.0) * ((k + 1) / 2) * 2.0 * geometry::kPi / directions;
      const Vec2 place = slot + ring * step * geometry::rotated(way, turn);
      if (is_good(place)) return place;
    }
  return from;
}

/// The robot nearest to its slot comes first.
void SlotPlans::choose_places(const std::vector<Anchor>& anchors, Vec2 leader) {
  Reachability reach(terrain_of(scenario_), 0.0, false);
  std::vector<std::pair<double, std::size_t>> nearest_first;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const Vec2 slot = leader + offsets_[i];
    places_.push_back({slot, why_no_place(i, anchors[i].position, slot, reach)});
    nearest_first.emplace_back(norm(slot - anchors[i].position), i);
  }
  std::sort(nearest_first.begin(), nearest_first.end());
  std::vector<geometry::Disc> taken;
  for (const auto& [distance, i] : nearest_first) {
    Place& mine = places_[i];
    const double radius = scenario_.robots[i].radius;
    for (const auto& [other_distance, j] : nearest_first) {
      if (j == i) break;
      const double apart = norm(offsets_[j] - offsets_[i]), radii = radius + scenario_.robots[j].radius;
      if (mine.why_not.empty() && places_[j].why_not.empty() && apart + 2.0 * tolerance_ < radii)
        mine.why_not = "the slot of " + scenario_.robots[j].id + " is only " + metres(apart) + " from it";
    }
    if (!mine.why_not.empty()) continue;
    shift_off_the_wall(i);
    taken.push_back({mine.at, radius});
  }
  for (const auto& [distance, i] : nearest_first) {
    Place& mine = places_[i];
    if (mine.why_not.empty()) continue;
    const Vec2 slot = std::exchange(mine.at, free_place_near(i, anchors[i].position, mine.at, taken, reach));
    if (norm(mine.at - slot) <= kNearEnough * tolerance_) mine.why_not.clear();
    taken.push_back({mine.at, scenario_.robots[i].radius});
  }
}

void SlotPlans::begin_step(double time, const std::vector<Anchor>& anchors, const LeaderState& leader) {
  const bool rests = is_active(time);
  if (rests && places_.empty()) choose_places(anchors, leader.position);
  const auto goal_of = [&](std::size_t i) { return rests ? places_[i].at : leader.position + offsets_[i]; };
  std::vector<RobotNow> now;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const Vec2 goal = goal_of(i);
    const bool is_there = !rests || norm(goal - anchors[i].position) <= tolerance_;
    now.push_back({anchors[i].position, goal, is_there, rests && larger_[i].cooperates, 0});
  }
  groups_.begin_step(time, std::move(now), [&](std::size_t i) {
    return way_left(norm(goal_of(i) - anchors[i].position), 2.0 * larger_[i].radius);
  });
}

}  // namespace exactvo::formation::detail
