// SPDX-License-Identifier: GPL-3.0-or-later
#include "forewarnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exactvo/geometry/distance.h"
#include "leader.h"

namespace exactvo::formation::detail {
namespace {

/// A place that a robot has to come within `reach` of.
struct Target {
  Vec2 place;    ///< m
  double reach;  ///< m
  std::string name;
};

std::string printed(Vec2 v) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.6g, %.6g)", v.x, v.y);
  return text;
}

std::vector<Target> targets_of(const Scenario& s, const std::vector<Vec2>& offsets, std::size_t i) {
  const Robot& robot = s.robots[i];
  std::vector<Target> targets;
  if (s.formation) {
    const Vec2 slot = s.formation->leader.path.back() + offsets[i];
    return {{slot, s.arrival_tolerance, "the slot of " + robot.id + " at the leader's end, " + printed(slot)}};
  }
  for (std::size_t g = 0; g < robot.goals.size(); ++g) {
    const bool last = g + 1 == robot.goals.size();
    const double reach = last ? s.arrival_tolerance : std::max(s.arrival_tolerance, robot.radius);
    const std::string number = robot.goals.size() > 1 ? " " + std::to_string(g + 1) : "";
    targets.push_back({robot.goals[g], reach, "goal" + number + " of " + robot.id + ", " + printed(robot.goals[g])});
  }
  return targets;
}

void warn_of_obstacles(const Scenario& s, const Robot& robot, const Target& t, std::vector<std::string>& out) {
  for (const SceneObstacle& o : s.obstacles) {
    const double distance = geometry::signed_distance(o.shape, t.place);
    if (distance + t.reach >= robot.radius) continue;
    out.push_back(t.name + (distance < 0.0 ? ", lies inside obstacle '" : ", is too near to obstacle '") + o.id +
                  "' for the robot's radius: it cannot be reached");
  }
}

void warn_of_pairs(const Scenario& s, const std::vector<Target>& last, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < last.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double room = norm(last[i].place - last[j].place) + last[i].reach + last[j].reach;
      if (room < s.robots[i].radius + s.robots[j].radius)
        out.push_back(last[i].name + ", and " + last[j].name + ", are too near to each other for both robots");
    }
  }
}

void warn_of_leader(const Scenario& s, std::vector<std::string>& out) {
  const double arrival = leader_arrival(s.formation->leader);
  if (!(arrival > s.time_limit)) return;
  char when[80];
  std::snprintf(when, sizeof when, "only after %.6g s, beyond the time limit of %.6g s", arrival, s.time_limit);
  out.push_back(std::string("the leader reaches the end of its path ") + (std::isfinite(arrival) ? when : "never"));
}

}  // namespace

std::vector<std::string> forewarnings(const Scenario& scenario, const std::vector<Vec2>& offsets) {
  std::vector<std::string> out;
  std::vector<Target> last;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const std::vector<Target> targets = targets_of(scenario, offsets, i);
    for (const Target& t : targets) warn_of_obstacles(scenario, scenario.robots[i], t, out);
    last.push_back(targets.back());
  }
  warn_of_pairs(scenario, last, out);
  if (scenario.formation) warn_of_leader(scenario, out);
  return out;
}

}  // namespace exactvo::formation::detail
