// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/last_places.h"

#include <algorithm>
#include <map>
#include <utility>

#include "exactvo/geometry/box_grid.h"
#include "scene/cells.h"
#include "scene/goals.h"

namespace exactvo::formation::detail {
namespace {

/// A share of the arrival tolerance: the rest is left for a robot that only comes near its place.
constexpr double kMoved = 0.9;

double room_for(const Scenario& s, std::size_t i, std::size_t j, const RoomAtEnds& room) {
  return s.robots[i].radius + s.robots[j].radius + room.margin;
}

/// m: how far robots stand aside.
double most_moved(const Scenario& s) {
  return kMoved * s.arrival_tolerance;
}

/// Robots with the same last goal.
std::vector<std::vector<std::size_t>> by_goal(const Scenario& s) {
  std::map<std::pair<double, double>, std::vector<std::size_t>> robots;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Vec2 goal = s.robots[i].goals.back();
    robots[{goal.x, goal.y}].push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [goal, who] : robots) groups.push_back(std::move(who));
  return groups;
}

/// Pairs that may come too near to each other where they stand aside, but for those whose goals are too near in any
/// case. In order.
std::vector<std::pair<std::size_t, std::size_t>> pairs_to_part(const Scenario& s, const RoomAtEnds& room) {
  const double largest = largest_radius(s.robots), most = 2.0 * most_moved(s);
  const std::vector<std::vector<std::size_t>> groups = by_goal(s);  // many may have one goal, which parts none of them
  Cells<std::size_t> before(4.0 * largest);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Vec2 goal = s.robots[groups[g].front()].goals.back();
    before.for_each_about(goal, 2.0 * largest + room.margin + most, [&](std::size_t other) {
      const double apart = norm(goal - s.robots[groups[other].front()].goals.back());
      for (const std::size_t i : groups[g])
        for (const std::size_t j : groups[other]) {
          const double needed = room_for(s, i, j, room);
          if (apart + most >= needed && apart - most < needed) pairs.push_back(std::minmax(i, j));
        }
    });
    before.add(goal, g);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const auto& a, const auto& b) { return std::pair(a.second, a.first) < std::pair(b.second, b.first); });
  return pairs;
}

}  // namespace

std::vector<Vec2> last_places(const Scenario& scenario, const RoomAtEnds& room) {
  constexpr int kRounds = 30;
  std::vector<Vec2> places;
  for (const Robot& r : scenario.robots) places.push_back(r.goals.back());
  const double most = most_moved(scenario);
  const auto move = [&](std::size_t i, Vec2 by) {
    const Vec2 goal = scenario.robots[i].goals.back(), from_goal = places[i] + by - goal;
    const double far = norm(from_goal);
    places[i] = goal + (far > most ? most / far : 1.0) * from_goal;
  };
  const auto pairs = pairs_to_part(scenario, room);
  for (int round = 0; round < kRounds; ++round)
    for (const auto& [i, j] : pairs) {
      const Vec2 between = places[j] - places[i];
      const double apart = norm(between), missing = room_for(scenario, i, j, room) + room.tolerated - apart;
      if (!(missing > 0.0) || apart == 0.0) continue;
      move(i, -0.5 * missing / apart * between);
      move(j, 0.5 * missing / apart * between);
    }
  return places;
}

RoomAtEnds room_at_ends(const Scenario& scenario) {
  return {scenario.margins.robot};
}

bool leave_no_room(const Scenario& s, std::size_t i, std::size_t j, double apart, const RoomAtEnds& room) {
  return apart < room_for(s, i, j, room) - room.tolerated;
}

bool any_leave_no_room(const Scenario& scenario, const std::vector<RobotPlace>& places, const RoomAtEnds& room) {
  std::vector<geometry::Box> boxes;
  for (const RobotPlace& p : places) boxes.push_back({p.place, p.place});
  const geometry::BoxGrid grid(std::move(boxes));
  const double most = largest_radius(scenario.robots) + room.margin;
  bool any = false;
  for (std::size_t k = 0; k < places.size() && !any; ++k) {
    const auto& [i, here] = places[k];
    grid.for_each_within(here, scenario.robots[i].radius + most, [&, i = i, here = here](std::size_t other) {
      const auto& [j, there] = places[other];
      any = any || (j != i && leave_no_room(scenario, i, j, norm(there - here), room));
    });
  }
  return any;
}

}  // namespace exactvo::formation::detail
