// SPDX-License-Identifier: GPL-3.0-or-later
#include "preflight/preflight.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/told_apart.h"
#include "motion/leader.h"
#include "motion/moving_way.h"
#include "scene/goals.h"
#include "scene/number_text.h"
#include "scene/obstacle_boxes.h"
#include "steering/last_places.h"

namespace exactvo::formation::detail {
namespace {

struct Target {
  Vec2 place;    ///< m
  double reach;  ///< m
  std::string name;
};

std::vector<Target> targets_of(const Scenario& s, const std::vector<Vec2>& offsets, std::size_t i) {
  const Robot& robot = s.robots[i];
  std::vector<Target> targets;
  if (s.formation) {
    const Vec2 slot = s.formation->leader.path.back() + offsets[i];
    return {{slot, s.arrival_tolerance, "the slot of " + robot.id + " at the leader's end, " + printed_place(slot)}};
  }
  for (std::size_t g = 0; g < robot.goals.size(); ++g) {
    const std::string number = robot.goals.size() > 1 ? " " + std::to_string(g + 1) : "";
    targets.push_back({robot.goals[g], reach_of(robot, g, s.arrival_tolerance),
                       "goal" + number + " of " + robot.id + ", " + printed_place(robot.goals[g])});
  }
  return targets;
}

/// Those that block a target, ascending.
std::vector<std::size_t> blocking(const Scenario& s, const ObstacleBoxes& boxes, const Robot& robot, const Target& t) {
  std::vector<std::size_t> found;
  for (const std::size_t k : boxes.near(t.place, obstacle_radius(robot)))
    if (signed_distance(s.obstacles[k], t.place) + t.reach < obstacle_radius(robot)) found.push_back(k);
  return found;
}

/// Returns where the robot gets to; nothing where that is not known. A goal that leaves the robot no room may be shut
/// off as well: a smaller robot would not get there either, so the radius is not named.
std::optional<Vec2> warn_of_target(const Scenario& s, const ObstacleBoxes& boxes, const Robot& robot, Vec2 from,
                                   const Target& t, Reachability& reach, std::vector<std::string>& out) {
  const Destination to{t.place, t.reach};
  const std::vector<std::size_t> in_the_way = blocking(s, boxes, robot, t);
  if (in_the_way.empty()) {
    if (const std::optional<Vec2> end = reach.reachable_place(obstacle_radius(robot), from, to)) return end;
    if (!reach.is_proven_out_of_reach(obstacle_radius(robot), from, to)) return std::nullopt;
  } else if (!reach.is_shut_off(obstacle_radius(robot), from, t.place)) {
    for (const std::size_t k : in_the_way) {
      const SceneObstacle& o = s.obstacles[k];
      out.push_back(t.name +
                    (signed_distance(o, t.place) < 0.0
                         ? ", lies inside obstacle '" + o.id + "'"
                         : ", is too near to obstacle '" + o.id + "' for the robot's radius") +
                    ": it cannot be reached");
    }
    return std::nullopt;
  }
  const bool is_proof = !reach.is_open_past_discs(obstacle_radius(robot), from, to);
  out.push_back(t.name + (is_proof ? ", cannot be reached: " : ", has no route to it: ") +
                reach.why_not(obstacle_radius(robot), from, to, "it"));
  return std::nullopt;
}

/// At most this many pairs are named; a line says how many more there are. Many robots with one goal make many.
constexpr std::size_t kPairsNamed = 10;
void tell_more(std::size_t pairs, const std::string& words, std::vector<std::string>& out) {
  if (pairs > kPairsNamed) out.push_back(geometry::counted(pairs - kPairsNamed, "more pair") + words);
}

void warn_of_pairs(const Scenario& s, const std::vector<Target>& last, std::vector<std::string>& out) {
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double room = norm(last[i].place - last[j].place) + last[i].reach + last[j].reach;
      const double radii = s.robots[i].radius + s.robots[j].radius;
      if (!(room < radii) || ++pairs > kPairsNamed) continue;
      const auto [have, need] = geometry::told_apart(room, radii);
      out.push_back(last[i].name + ", and " + last[j].name + ", are too near to each other for both robots: " + have +
                    " m, and their radii take " + need + " m");
    }
  }
  tell_more(pairs, std::string(s.formation ? " of slots" : " of goals") + " too near to each other", out);
}

/// Last goals where there is room for both, but not with the margin between them, also where they stand aside within
/// reach of their goals: the second to come finds the first one too near.
void warn_of_near_pairs(const Scenario& s, const std::vector<Target>& last, std::vector<std::string>& out) {
  std::size_t pairs = 0;
  const std::vector<Vec2> places = s.liveness == Liveness::off ? std::vector<Vec2>{} : last_places(s, room_at_ends(s));
  for (std::size_t i = 0; i < last.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double radii = s.robots[i].radius + s.robots[j].radius, apart = norm(last[i].place - last[j].place);
      const double aside = places.empty() ? apart : norm(places[i] - places[j]);
      if (are_too_near(s.robots[i], s.robots[j], s.arrival_tolerance) || !leave_no_room(s, i, j, aside) ||
          ++pairs > kPairsNamed)
        continue;
      const auto [have, need] = geometry::told_apart(apart, radii + s.margins.robot);
      out.push_back(last[i].name + ", and " + last[j].name + ", are " + have + " m apart, and radii and margin take " +
                    need + " m: the second to come finds no room");
    }
  }
  tell_more(pairs, " of goals nearer to each other than radii and margin take", out);
}

/// Goals on the way where another robot is to rest: in its last goal it leaves no room there. By plans it makes way and
/// comes back, if it cooperates.
void warn_of_goals_on_the_way(const Scenario& s, std::size_t i, const std::vector<Target>& targets,
                              std::vector<std::string>& out) {
  for (std::size_t g = 0; g + 1 < targets.size(); ++g) {
    const auto takes = [&](const Robot& other) {
      const bool makes_way = other.cooperates && s.liveness == Liveness::plan;
      return !makes_way && &other != &s.robots[i] &&
             norm(targets[g].place - other.goals.back()) + targets[g].reach + s.arrival_tolerance <
                 s.robots[i].radius + other.radius;
    };
    const auto other = std::find_if(s.robots.begin(), s.robots.end(), takes);
    if (other != s.robots.end())
      out.push_back(targets[g].name + ", cannot be reached while " + other->id + " is at its last goal");
  }
}

/// Robots that have to pass each other and cannot; the first ones.
void warn_of_passing(const Scenario& s, std::vector<std::string>& out) {
  const std::vector<NoPassing> proofs = robots_without_passing_by_plan(s);
  for (std::size_t k = 0; k < std::min(kPairsNamed, proofs.size()); ++k) out.push_back(words_of(s, proofs[k]));
  tell_more(proofs.size(), " of robots without room to pass each other", out);
}

void warn_of_leader(const Scenario& s, std::vector<std::string>& out) {
  for (const std::string* words : {&s.formation->leader.why_short, &s.formation->leader.note})
    if (!words->empty()) out.push_back(*words);
  const double arrival = leader_arrival(s.formation->leader);
  if (!(arrival > s.time_limit)) return;
  const auto [limit, end] = geometry::told_apart(s.time_limit, arrival, 6);
  const std::string when = "only after " + end + " s, beyond the time limit of " + limit + " s";
  out.push_back(std::isfinite(arrival) ? "the leader reaches the end of its path " + when
                                       : "the leader never reaches the end of its path");
}

/// A share of a speed: what is exactly as fast as a robot may go does not count as faster, however its direction was
/// rounded.
constexpr double kRounding = 1e-12;

bool exceeds(double speed, double max_speed) {
  return speed > max_speed * (1.0 + kRounding);
}

/// How much of a speed the bound counts: all of it, or its larger component.
double counted(const Scenario& s, Vec2 velocity) {
  return s.speed_bound == SpeedBoundKind::disc ? norm(velocity)
                                               : std::max(std::fabs(velocity.x), std::fabs(velocity.y));
}

/// Where the speed bound of a robot is asked for most.
struct TopSpeed {
  double speed = 0.0;    ///< m/s, along the path
  double counted = 0.0;  ///< m/s, of it
};

/// A share of the time: a jump of speed at a corner comes before or after it by a rounding, and what is shorter is not
/// driven.
constexpr double kInstant = 1e-9;

/// Over the part of the motion that happens: up to the path's end and the time limit.
TopSpeed top_speed(const Scenario& s, const TimedPath& motion) {
  const double end = std::min(leader_arrival(motion), s.time_limit);
  TopSpeed top;
  for (const WayPiece& piece : way_of(motion, end)) {
    if (!(piece.from < end)) break;
    if (piece.to - piece.from <= kInstant * piece.to) continue;
    const double speed = piece.speed_bound(std::min(piece.to, end));
    const double part = s.speed_bound == SpeedBoundKind::disc ? speed : counted(s, speed * piece.direction);
    if (part > top.counted) top = {speed, part};
  }
  return top;
}

void warn_of_fast_leader(const Scenario& s, std::vector<std::string>& out) {
  const TopSpeed top = top_speed(s, s.formation->leader);
  for (const Robot& robot : s.robots) {
    if (!exceeds(top.counted, robot.max_speed)) continue;
    const auto [most, speed] = geometry::told_apart(robot.max_speed, top.speed, 6);
    out.push_back("the leader moves at up to " + speed + " m/s, faster than " + robot.id + " can (" +
                  (robot.drive ? "max_wheel_speed " : "max_speed ") + most + " m/s): the formation falls behind");
    return;
  }
}

void warn_of_fast_start(const Scenario& s, const Robot& robot, std::vector<std::string>& out) {
  const double speed = counted(s, robot.velocity);
  if (!exceeds(speed, robot.max_speed)) return;
  const auto [most, start] = geometry::told_apart(robot.max_speed, speed, 6);
  out.push_back(robot.id + " starts at " + start + " m/s, beyond its max_speed of " + most + " m/s");
}

/// Moving obstacles are avoided by their convex hulls, and only by robots that can get away.
void warn_of_moving(const Scenario& s, const MovingObstacle& o, std::vector<std::string>& out) {
  const geometry::Polygon hull{geometry::convex_hull(geometry::vertices_of(o.shape)).vertices, {}};
  const bool is_larger = !o.disc && hull.outer.size() > 2;  // than the obstacle
  for (const Robot& robot : s.robots) {
    if (is_larger && geometry::signed_distance(hull, robot.position) < robot.radius)
      out.push_back(robot.id + " starts inside the convex hull of moving obstacle '" + o.id +
                    "', as which it is avoided: the run begins in contact");
  }
  const TopSpeed top = top_speed(s, o.motion);
  for (const Robot& robot : s.robots) {
    if (!exceeds(top.counted, robot.max_speed)) continue;
    const auto [most, speed] = geometry::told_apart(robot.max_speed, top.speed, 6);
    out.push_back("moving obstacle '" + o.id + "' moves at up to " + speed + " m/s, faster than " + robot.id +
                  " (max_speed " + most + " m/s): it can run " + robot.id + " over");
    return;
  }
}

/// Where and since when a moving obstacle stands still for good.
struct Rest {
  double since = 0.0;  ///< s
  Vec2 moved;          ///< m
};

/// Nothing where it still moves at the time limit.
std::optional<Rest> rest_of(const Scenario& s, const MovingObstacle& o) {
  const double arrival = leader_arrival(o.motion);
  if (arrival <= s.time_limit) return Rest{arrival, o.motion.path.back() - o.motion.path.front()};
  if (o.motion.profile.empty()) return o.motion.speed == 0.0 ? std::optional<Rest>(Rest{}) : std::nullopt;
  // The last knot's speed is held.
  const std::vector<SpeedKnot>& knots = o.motion.profile;
  std::size_t first = knots.size();
  while (first > 0 && knots[first - 1].speed == 0.0) --first;
  if (first == knots.size() || knots[first].time > s.time_limit) return std::nullopt;
  const double since = first == 0 ? 0.0 : knots[first].time;
  return Rest{since, displacement_at(o, since)};
}

/// Goals that a moving obstacle covers for good where it comes to rest, or never leaves.
void warn_of_rests(const Scenario& s, const Robot& robot, const Target& last, std::vector<std::string>& out) {
  for (const MovingObstacle& o : s.moving_obstacles) {
    const std::optional<Rest> rest = rest_of(s, o);
    if (!rest || signed_distance(o, last.place - rest->moved) + last.reach >= robot.radius) continue;
    out.push_back(last.name + ", lies where moving obstacle '" + o.id + "' comes to rest" +
                  (rest->since > 0.0 ? " after " + number_text(rest->since, 6) + " s" : "") +
                  ": from then on it cannot be reached");
  }
}

// --- What a formation's controller follows too slowly ---

double fastest_of(const std::vector<Robot>& robots) {
  double fastest = 0.0;
  for (const Robot& robot : robots) fastest = std::max(fastest, robot.max_speed);
  return fastest;
}

/// m/s: how fast two robots of a formation go past each other at most, each closing in on its slot.
double passing_speed(const Scenario& s, const ControllerOptions& options) {
  const double fastest = fastest_of(s.robots);
  return 2.0 * (options.saturation ? std::min(fastest, s.formation->catch_up_speed) : fastest);
}

/// Math: x' = k3 (y - x) for the brake point y, so that x is the mean of past y with weights k3 exp(-k3 t), of
/// variance 1 / k3^2. Round a disc of radius R = r_i + r_j a relative velocity u bends the way of y_i - y_j by u^2 / R;
/// the mean lies half the variance times that inside of it: u^2 / (2 R k3^2).
void warn_of_lag(const Scenario& s, const ControllerOptions& options, std::vector<std::string>& out) {
  const double margin = options.margins ? s.margins.robot : 0.0, k3 = s.formation->gains.k3;
  const double radii = 2.0 * largest_radius(s.robots), speed = passing_speed(s, options);
  if (!(margin > 0.0)) return;
  const double enough = speed / std::sqrt(2.0 * radii * margin);
  if (k3 >= enough) return;
  out.push_back("gain k3 = " + number_text(k3, 3) + " 1/s: robots that pass each other at " + number_text(speed, 3) +
                " m/s cut the corners of their brake points by more than margins.robot, " + metres(margin) +
                ", and can overlap; k3 = " + number_text(enough, 3) + " 1/s would do");
}

void warn_of_bound(const Scenario& s, const ControllerOptions& options, std::vector<std::string>& out) {
  const double bound = options.acceleration_bound;
  if (!(bound > 0.0)) return;
  const double stops_in = fastest_of(s.robots) / bound;
  if (stops_in <= s.horizons.least) return;
  out.push_back("acceleration_bound = " + number_text(bound, 3) + " m/s^2: a robot takes " + number_text(stops_in, 3) +
                " s to stop, longer than horizons.least, " + number_text(s.horizons.least, 3) +
                " s: robots can overlap each other and obstacles");
}

}  // namespace

std::vector<std::string> controller_warnings(const Scenario& scenario, const ControllerOptions& options) {
  std::vector<std::string> out;
  if (!options.brake_point) return out;
  if (scenario.robots.size() > 1) warn_of_lag(scenario, options, out);
  warn_of_bound(scenario, options, out);
  return out;
}

std::vector<std::string> preflight_warnings(const Scenario& scenario, const std::vector<Vec2>& offsets,
                                            Reachability& reach) {
  std::vector<std::string> out;
  std::vector<Target> last;
  const ObstacleBoxes boxes(scenario.obstacles);
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const std::vector<Target> targets = targets_of(scenario, offsets, i);
    Vec2 from = scenario.robots[i].position;  // and the last goal that it gets to
    for (const Target& t : targets)
      if (const std::optional<Vec2> end = warn_of_target(scenario, boxes, scenario.robots[i], from, t, reach, out))
        from = *end;
    warn_of_rests(scenario, scenario.robots[i], targets.back(), out);
    warn_of_goals_on_the_way(scenario, i, targets, out);
    warn_of_fast_start(scenario, scenario.robots[i], out);
    last.push_back(targets.back());
  }
  warn_of_pairs(scenario, last, out);
  if (!scenario.formation) warn_of_near_pairs(scenario, last, out);
  if (std::string arrived = arrived_at_start(scenario); !arrived.empty()) out.push_back(std::move(arrived));
  warn_of_passing(scenario, out);
  for (const MovingObstacle& o : scenario.moving_obstacles) warn_of_moving(scenario, o, out);
  if (!scenario.formation) return out;
  warn_of_leader(scenario, out);
  warn_of_fast_leader(scenario, out);
  return out;
}

}  // namespace exactvo::formation::detail

namespace exactvo::formation {

std::string arrived_at_start(const Scenario& s) {
  constexpr std::size_t kNamed = 10;
  std::vector<std::string> ids;
  std::size_t count = 0;
  if (s.formation) return "";
  for (const Robot& robot : s.robots) {
    const auto is_there = [&](Vec2 goal) { return norm(goal - robot.position) <= s.arrival_tolerance; };
    const bool stays = robot.goals.size() == 1 && robot.goals[0] == robot.position;
    if (stays || !std::all_of(robot.goals.begin(), robot.goals.end(), is_there)) continue;
    if (++count <= kNamed) ids.push_back(robot.id);
  }
  if (count == 0) return "";
  std::string text = ids[0];
  for (std::size_t k = 1; k < ids.size(); ++k) text += ", " + ids[k];
  if (count > kNamed) text += " and " + std::to_string(count - kNamed) + " more";
  return geometry::counted(count, "robot") + " within arrival_tolerance, " + detail::metres(s.arrival_tolerance) +
         ", of the goal at the start, arrived before any move (lengths are in metres): " + text;
}

}  // namespace exactvo::formation
