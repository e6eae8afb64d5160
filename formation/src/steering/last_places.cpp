// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/last_places.h"

#include <algorithm>
#include <utility>

#include "liveness/cells.h"
#include "steering/goals.h"

namespace exactvo::formation::detail {
namespace {

/// Of the arrival tolerance: the rest is left for a robot that only comes near its place.
constexpr double kMoved = 0.9;
/// m: two that are so much too near to each other are not; half-planes come no nearer to the margin.
constexpr double kUnseen = 1e-6;

double room_for(const Scenario& s, std::size_t i, std::size_t j) {
  return s.robots[i].radius + s.robots[j].radius + s.margins.robot;
}

/// m: how far robots stand aside.
double most_moved(const Scenario& s) {
  return kMoved * s.arrival_tolerance;
}

/// Pairs that may come too near to each other where they stand aside, but for those whose goals are too near in any
/// case.
std::vector<std::pair<std::size_t, std::size_t>> pairs_to_part(const Scenario& s) {
  const double largest = largest_radius(s), most = 2.0 * most_moved(s);
  Cells<std::size_t> goals(4.0 * largest);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Vec2 goal = s.robots[i].goals.back();
    goals.for_each_about(goal, s.robots[i].radius + largest + s.margins.robot + most, [&](std::size_t j) {
      const double apart = norm(goal - s.robots[j].goals.back()), room = room_for(s, i, j);
      if (apart > 0.0 && apart + most >= room && apart - most < room) pairs.emplace_back(j, i);
    });
    goals.add(goal, i);
  }
  return pairs;
}

}  // namespace

std::vector<Vec2> last_places(const Scenario& scenario) {
  constexpr int kRounds = 30;
  std::vector<Vec2> places;
  for (const Robot& r : scenario.robots) places.push_back(r.goals.back());
  const double most = most_moved(scenario);
  const auto move = [&](std::size_t i, Vec2 by) {
    const Vec2 goal = scenario.robots[i].goals.back(), from_goal = places[i] + by - goal;
    const double far = norm(from_goal);
    places[i] = goal + (far > most ? most / far : 1.0) * from_goal;
  };
  const auto pairs = pairs_to_part(scenario);
  for (int round = 0; round < kRounds; ++round)
    for (const auto& [i, j] : pairs) {
      const Vec2 between = places[j] - places[i];
      const double apart = norm(between), missing = room_for(scenario, i, j) + kUnseen - apart;
      if (!(missing > 0.0) || apart == 0.0) continue;
      move(i, -0.5 * missing / apart * between);
      move(j, 0.5 * missing / apart * between);
    }
  return places;
}

bool leave_no_room(const Scenario& scenario, std::size_t i, std::size_t j, double apart) {
  return apart < room_for(scenario, i, j) - kUnseen;
}

}  // namespace exactvo::formation::detail
