// SPDX-License-Identifier: GPL-3.0-or-later
#include "preflight.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/hull.h"
#include "leader.h"
#include "walled_in.h"

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

bool is_blocked(const SceneObstacle& o, const Robot& robot, const Target& t) {
  return geometry::signed_distance(o.shape, t.place) + t.reach < robot.radius;
}

void warn_of_obstacles(const Scenario& s, const Robot& robot, const Target& t, std::vector<std::string>& out) {
  for (const SceneObstacle& o : s.obstacles) {
    if (!is_blocked(o, robot, t)) continue;
    const bool inside = geometry::signed_distance(o.shape, t.place) < 0.0;
    out.push_back(t.name + (inside ? ", lies inside obstacle '" : ", is too near to obstacle '") + o.id +
                  "' for the robot's radius: it cannot be reached");
  }
}

std::string metres(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g m", x);
  return text;
}

/// "obstacle 'room' encloses it", "obstacles 'a' and 'b' enclose it with gaps of at most 0.4 m".
std::string chain_words(const Scenario& s, const Enclosing& e, const Robot& robot) {
  std::vector<std::string> ids;
  for (const std::size_t k : e.obstacles) ids.push_back("'" + s.obstacles[k].id + "'");
  const bool one = ids.size() == 1;
  std::string text = (one ? "obstacle " : "obstacles ") + abridged(ids) + (one ? " encloses " : " enclose ") +
                     (e.around_goal ? "it" : "the start");
  if (e.widest_gap > 0.0)
    text += ", with gaps of at most " + metres(e.widest_gap) + " for a robot " + metres(2.0 * robot.radius) + " wide";
  return text;
}

/// By radius: most robots of a scene are of one size.
using WallsByRadius = std::map<double, Walls>;

void warn_of_walls(const Scenario& s, const Robot& robot, const Target& t, WallsByRadius& walls,
                   std::vector<std::string>& out) {
  const auto blocks = [&](const SceneObstacle& o) { return is_blocked(o, robot, t); };
  if (std::any_of(s.obstacles.begin(), s.obstacles.end(), blocks)) return;
  const Walls& of_robot = walls.try_emplace(robot.radius, s.obstacles, robot.radius).first->second;
  if (const auto found = of_robot.between({robot.position, 0.0}, {t.place, t.reach}))
    out.push_back(t.name + ", cannot be reached: " + chain_words(s, *found, robot));
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

std::string rounded(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

double top_speed(const Leader& motion) {
  if (length_of(motion.path) == 0.0) return 0.0;
  double top = motion.profile.empty() ? motion.speed : 0.0;
  for (const SpeedKnot& knot : motion.profile) top = std::max(top, knot.speed);
  return top;
}

/// How much of the leader's speed the bound of a robot counts: all of it, or the larger component on the worst leg.
double worst_share(const Scenario& s, const std::vector<Vec2>& path) {
  if (s.speed_bound == SpeedBoundKind::disc) return 1.0;
  double worst = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec2 d = geometry::normalized(path[i] - path[i - 1]);
    worst = std::max({worst, std::fabs(d.x), std::fabs(d.y)});
  }
  return worst;
}

void warn_of_fast_leader(const Scenario& s, std::vector<std::string>& out) {
  // Share of a speed: a leader exactly as fast as its robots is none that outruns them, however the legs round.
  constexpr double kRounding = 1e-12;
  const Leader& leader = s.formation->leader;
  const double asked = top_speed(leader) * worst_share(s, leader.path);
  for (const Robot& robot : s.robots) {
    if (!(asked > robot.max_speed * (1.0 + kRounding))) continue;
    out.push_back("the leader moves at up to " + rounded(top_speed(leader)) + " m/s, faster than " + robot.id +
                  " can (max_speed " + rounded(robot.max_speed) + " m/s): the formation falls behind");
    return;
  }
}

void warn_of_fast_start(const Scenario& s, const Robot& robot, std::vector<std::string>& out) {
  const Vec2 v = robot.velocity;
  const double speed = s.speed_bound == SpeedBoundKind::disc ? norm(v) : std::max(std::fabs(v.x), std::fabs(v.y));
  if (speed > robot.max_speed)
    out.push_back(robot.id + " starts at " + rounded(speed) + " m/s, beyond its max_speed of " +
                  rounded(robot.max_speed) + " m/s");
}

/// Moving obstacles are avoided by their convex hulls, and only by robots that can get away.
void warn_of_moving(const Scenario& s, const MovingObstacle& o, std::vector<std::string>& out) {
  const geometry::Obstacle hull = geometry::Polygon{geometry::convex_hull(geometry::vertices_of(o.shape)).vertices, {}};
  const bool has_inside = std::get<geometry::Polygon>(hull).outer.size() > 2;
  for (const Robot& robot : s.robots) {
    if (has_inside && geometry::signed_distance(hull, robot.position) < robot.radius)
      out.push_back(robot.id + " starts inside the convex hull of moving obstacle '" + o.id +
                    "', as which it is avoided: the run begins in contact");
  }
  const double speed = top_speed(o.motion);
  for (const Robot& robot : s.robots) {
    if (!(speed > robot.max_speed)) continue;
    out.push_back("moving obstacle '" + o.id + "' moves at up to " + rounded(speed) + " m/s, faster than " + robot.id +
                  " (max_speed " + rounded(robot.max_speed) + " m/s): it can be run over");
    return;
  }
}

/// Goals that a moving obstacle covers for good where it comes to rest, or never leaves.
void warn_of_rests(const Scenario& s, const Robot& robot, const Target& last, std::vector<std::string>& out) {
  for (const MovingObstacle& o : s.moving_obstacles) {
    const double arrival = leader_arrival(o.motion);
    const bool stays = top_speed(o.motion) == 0.0;
    if (!stays && !(arrival <= s.time_limit)) continue;
    const Vec2 moved = stays ? Vec2{} : o.motion.path.back() - o.motion.path.front();
    if (geometry::signed_distance(o.shape, last.place - moved) + last.reach >= robot.radius) continue;
    out.push_back(last.name + ", lies where moving obstacle '" + o.id + "' comes to rest" +
                  (stays ? "" : " after " + rounded(arrival) + " s") + ": from then on it cannot be reached");
  }
}

}  // namespace

std::vector<std::string> preflight_warnings(const Scenario& scenario, const std::vector<Vec2>& offsets) {
  std::vector<std::string> out;
  std::vector<Target> last;
  WallsByRadius walls;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const std::vector<Target> targets = targets_of(scenario, offsets, i);
    for (const Target& t : targets) {
      warn_of_obstacles(scenario, scenario.robots[i], t, out);
      warn_of_walls(scenario, scenario.robots[i], t, walls, out);
    }
    warn_of_rests(scenario, scenario.robots[i], targets.back(), out);
    warn_of_fast_start(scenario, scenario.robots[i], out);
    last.push_back(targets.back());
  }
  warn_of_pairs(scenario, last, out);
  for (const MovingObstacle& o : scenario.moving_obstacles) warn_of_moving(scenario, o, out);
  if (!scenario.formation) return out;
  warn_of_leader(scenario, out);
  warn_of_fast_leader(scenario, out);
  return out;
}

}  // namespace exactvo::formation::detail
