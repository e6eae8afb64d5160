// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/scenario.h"

#include <utility>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/round_polygon.h"
#include "exactvo/geometry/told_apart.h"
#include "exactvo/geometry/validity.h"
#include "motion/differential.h"
#include "scene/braking.h"
#include "scene/chain.h"
#include "scene/field_problems.h"
#include "scene/free_space.h"
#include "scene/number_text.h"
#include "scene/obstacle_boxes.h"

namespace exactvo::formation {
namespace {

using Problems = std::vector<ScenarioProblem>;

/// A number of the scenario: nothing of it is lost, so that two that are compared look as different as they are.
std::string show(double x) {
  return geometry::lossless(x);
}
std::string show(Vec2 v) {
  return "[" + show(v.x) + ", " + show(v.y) + "]";
}

struct Checker {
  Problems problems;

  void require(bool ok, const std::string& pointer, const std::string& found, const std::string& expected) {
    if (!ok) problems.push_back({pointer, found, expected});
  }
  // Words are made for what is wrong only: of many robots they took most of the time. So `at` is a pointer, or what
  // makes one.

  template <class At>
  void positive(double x, const At& at, const char* unit) {
    if (std::isfinite(x) && x > 0.0) return;
    require(false, words_of(at), show(x), std::string("a finite number above 0 (") + unit + ")");
  }
  template <class At>
  void not_negative(double x, const At& at, const char* unit) {
    if (std::isfinite(x) && x >= 0.0) return;
    require(false, words_of(at), show(x), std::string("a finite number, 0 or more (") + unit + ")");
  }
  template <class At>
  void finite(Vec2 v, const At& at) {
    if (!geometry::is_finite(v)) require(false, words_of(at), show(v), "two finite numbers (m or m/s)");
  }

 private:
  static std::string words_of(const std::string& pointer) { return pointer; }
  template <class At>
  static auto words_of(const At& make_pointer) -> decltype(make_pointer()) {
    return make_pointer();
  }
};

/// For every robot, those before it that could overlap it, in order. Robots with NaN among their numbers overlap
/// nothing.
std::vector<std::vector<std::size_t>> near_each_other(const std::vector<Robot>& robots) {
  constexpr double kRounding = 0x1p-40;  // far more than the gap of a pair is off by
  std::vector<geometry::Box> boxes;
  std::vector<std::size_t> robot_of;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Robot& r = robots[i];
    const double reach = std::fabs(r.radius) + kRounding * (std::fabs(r.position.x) + std::fabs(r.position.y));
    const geometry::Box box{r.position - Vec2{reach, reach}, r.position + Vec2{reach, reach}};
    if (!geometry::is_finite(box.low) || !geometry::is_finite(box.high)) continue;
    robot_of.push_back(i);
    boxes.push_back(box);
  }
  const geometry::BoxGrid by_place(std::move(boxes));
  std::vector<std::vector<std::size_t>> before(robots.size());
  for (std::size_t k = 0; k < by_place.size(); ++k) {
    std::vector<std::size_t>& found = before[robot_of[k]];
    by_place.for_each_meeting(by_place.box(k), [&](std::size_t other) {
      if (other < k) found.push_back(robot_of[other]);
    });
    std::sort(found.begin(), found.end());
  }
  return before;
}

/// `at`: makes the pointer of a key.
template <class At>
void check_body(double radius, double max_speed, const At& at, Checker& c) {
  c.positive(radius, at("/radius"), "m");
  c.positive(max_speed, at("/max_speed"), "m/s");
}

/// Its body, wherever it may be, is within its disc. (On wheels `check_drive` asks that.)
template <class At>
void check_tube(const Scenario& s, const Robot& r, const At& at, Checker& c) {
  if (r.drive || !(r.radius > 0.0)) return;
  Robot made;
  keep_within_tube(made, r.body_radius > 0.0 ? r.body_radius : r.radius, tracking_error_of(s));
  if (made.radius == r.radius && made.body_radius == r.body_radius) return;
  c.require(false, at("/radius")(), show(r.radius), "the radius that `keep_within_tube` makes");
}

/// Where it starts, as the scenario says, and what its discs take in beside the body.
std::string start_of(const Scenario& s, const Robot& r) {
  const double tracking = tracking_error_of(s);
  const std::string more = tracking > 0.0 ? ", with the tracking error of " + detail::metres(tracking) : "";
  if (!r.drive) return show(r.position) + more;
  return show(r.drive->axle) + ", with a disc of " + detail::metres(r.radius) + " about its reference point" +
         (r.drive->chain.empty() ? "" : ", and a chain of discs of " + detail::metres(obstacle_radius(r))) + more;
}

void check_robots(const Scenario& s, Checker& c) {
  c.require(!s.robots.empty(), "/robots", "no robots", "at least one robot");
  const std::vector<std::vector<std::size_t>> near = near_each_other(s.robots);
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Robot& r = s.robots[i];
    const auto at = [i](const char* key) { return [i, key] { return "/robots/" + std::to_string(i) + key; }; };
    check_body(r.radius, r.max_speed, at, c);
    check_tube(s, r, at, c);
    c.finite(r.position, at("/position"));
    c.finite(r.velocity, at("/velocity"));
    if (!s.formation && r.goals.empty())
      c.require(false, at("/goal")(), "no goal", "a goal, since the scenario has no formation");
    for (Vec2 g : r.goals) c.finite(g, at("/goal"));
    for (const std::size_t j : near[i]) {
      const double gap = norm(r.position - s.robots[j].position) - r.radius - s.robots[j].radius;
      if (!(gap < 0.0) || s.separate) continue;  // words are made for what is wrong only: a crowd has very many pairs
      c.require(false, at("/position")(),
                start_of(s, r) + ", overlapping robot '" + s.robots[j].id + "' by " + detail::metres(-gap),
                "robots that do not overlap at the start");
    }
  }
}

/// Moving obstacles stand at t = 0 as their shapes say.
void check_starts(const Scenario& s, Checker& c) {
  const detail::ObstacleBoxes boxes(s.obstacles);
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Robot& robot = s.robots[i];
    const auto require_clear = [&](const auto& obstacle, const char* kind) {
      double gap = signed_distance(obstacle, robot.position) - obstacle_radius(robot);
      for (std::size_t k = 1; robot.drive && k < robot.drive->chain.size(); ++k) {
        const geometry::Disc link = link_at(*robot.drive, k, robot.position, heading_vector(robot.drive->heading));
        gap = std::min(gap, signed_distance(obstacle, link.center) - link.radius - detail::kRoomOfLinks);
      }
      if (!(gap < 0.0)) return;
      c.require(
          false, "/robots/" + std::to_string(i) + "/position",
          start_of(s, s.robots[i]) + ", overlapping " + kind + " '" + obstacle.id + "' by " + detail::metres(-gap),
          "a start that is clear of every obstacle");
    };
    for (const std::size_t k : boxes.near(robot.position, obstacle_reach(robot) + detail::kRoomOfLinks))
      require_clear(s.obstacles[k], "obstacle");
    for (const MovingObstacle& o : s.moving_obstacles) require_clear(o, "moving obstacle");
  }
}

void check_profile(const TimedPath& leader, const std::string& at, Checker& c) {
  for (std::size_t k = 0; k < leader.profile.size(); ++k) {
    const SpeedKnot& knot = leader.profile[k];
    const std::string pointer = at + "/profile/" + std::to_string(k);
    c.not_negative(knot.time, pointer + "/0", "s");
    c.not_negative(knot.speed, pointer + "/1", "m/s");
    c.require(k == 0 || !(knot.time < leader.profile[k - 1].time), pointer + "/0", show(knot.time),
              "times that do not fall");
  }
}

/// What else it is, where it is said to be a disc.
template <class Obstacle>
void check_disc(const Obstacle& o, const std::string& at, Checker& c) {
  const auto* polygon = std::get_if<geometry::Polygon>(&o.shape);
  if (!o.disc) return;
  const bool is_whole = o.disc->radius > 0.0 && std::isfinite(o.disc->radius) && geometry::is_finite(o.disc->center);
  c.require(is_whole && polygon && geometry::holds_disc(*polygon, *o.disc), at + "/disc",
            geometry::to_string(geometry::ConvexShape{*o.disc}), "a disc in the polygon round it (disc_obstacle.h)");
}

std::optional<std::size_t> first_drive(const Scenario& s) {
  for (std::size_t i = 0; i < s.robots.size(); ++i)
    if (s.robots[i].drive) return i;
  return std::nullopt;
}

/// What a robot can keep clear of that knows its greatest speed only.
void check_mover(const Scenario& s, const MovingObstacle& o, const std::string& at, Checker& c) {
  c.not_negative(*o.max_speed, at + "/max_speed", "m/s");
  c.require(o.disc.has_value(), at + "/max_speed", "a moving obstacle that is no disc",
            "a disc that holds it: what moves in any way may turn, too");
  c.require(s.acceleration || first_drive(s), at + "/max_speed", "robots without /acceleration",
            "an /acceleration, which says how soon a robot can stand, or no max_speed");
  c.require(!(o.motion.speed > *o.max_speed), at + "/speed", show(o.motion.speed),
            "at most its max_speed, " + show(*o.max_speed) + " m/s");
  for (std::size_t k = 0; k < o.motion.profile.size(); ++k)
    if (o.motion.profile[k].speed > *o.max_speed)
      c.require(false, at + "/profile/" + std::to_string(k) + "/1", show(o.motion.profile[k].speed),
                "at most its max_speed, " + show(*o.max_speed) + " m/s");
}

void check_moving(const Scenario& s, Checker& c) {
  for (std::size_t k = 0; k < s.moving_obstacles.size(); ++k) {
    const MovingObstacle& o = s.moving_obstacles[k];
    const std::string at = "/moving_obstacles/" + std::to_string(k);
    c.require(!geometry::vertices_of(o.shape).empty(), at, "no points", "a polyline or polygon");
    for (Vec2 p : geometry::vertices_of(o.shape)) c.finite(p, at);
    check_disc(o, at, c);
    c.require(!o.motion.path.empty(), at + "/path", "no points", "at least one point");
    for (Vec2 p : o.motion.path) c.finite(p, at + "/path");
    c.not_negative(o.motion.speed, at + "/speed", "m/s");
    check_profile(o.motion, at, c);
    if (o.max_speed) check_mover(s, o, at, c);
  }
}

/// Said of the one of the two that is not the default, where that is one.
void require_step_within_horizon(const detail::DecisionRules& s, Checker& c) {
  const bool holds = s.horizons.least >= 2.0 * s.time_step;
  if (s.time_step > Scenario{}.time_step)
    return c.require(holds, "/time_step", show(s.time_step),
                     "at most half of /horizons/least, which is " + show(s.horizons.least) + " (s)");
  c.require(holds, "/horizons/least", show(s.horizons.least),
            "at least twice /time_step, " + show(2.0 * s.time_step) + " (s)");
}

/// `time_limit`: s, of a run.
void check_times(const detail::DecisionRules& s, double arrival_tolerance, std::optional<double> time_limit,
                 Checker& c) {
  c.positive(s.time_step, "/time_step", "s");
  if (time_limit) c.positive(*time_limit, "/time_limit", "s");
  c.positive(arrival_tolerance, "/arrival_tolerance", "m");
  c.positive(s.neighbour_distance, "/neighbour_distance", "m");
  c.positive(s.horizons.least, "/horizons/least", "s");
  constexpr double kMostSteps = 1e7;  // rows that a recording can hold in memory
  if (time_limit)
    c.require(!(s.time_step > 0.0) || *time_limit / s.time_step <= kMostSteps, "/time_limit", show(*time_limit),
              "at most 10^7 steps of /time_step, " + show(1e7 * s.time_step) + " (s)");
  c.positive(s.horizons.most, "/horizons/most", "s");
  c.require(s.horizons.most >= s.horizons.least, "/horizons/most", show(s.horizons.most),
            "at least /horizons/least, " + show(s.horizons.least));
  require_step_within_horizon(s, c);
  c.positive(s.horizons.speed_floor, "/horizons/speed_floor", "share of max_speed");
  const auto holds_for_a_step = [&](double horizon, const char* pointer) {
    c.positive(horizon, pointer, "s");
    c.require(!(horizon > 0.0) || horizon >= s.time_step, pointer, show(horizon),
              "at least /time_step, " + show(s.time_step) + " (s)");
  };
  holds_for_a_step(s.horizons.orca, "/horizons/orca");
  holds_for_a_step(s.horizons.robots, "/horizons/robots");
  c.not_negative(s.margins.obstacle, "/margins/obstacle", "m");
  c.not_negative(s.margins.robot, "/margins/robot", "m");
}

/// What the proof of braking needs of the numbers of a decision (braking.h). `stops`: s, within which the slowest robot
/// to stop does. `is_given`: the braking time is not the usual one.
void check_brakes(const detail::DecisionRules& rules, double stops, bool is_given, Checker& c) {
  constexpr double kRounding = 1.0 + 1e-9;
  const double tau = rules.braking_time;
  c.require(
      tau >= kRounding * stops, "/braking_time", show(tau),
      "more than the fastest robot needs to stop, its speed divided by its acceleration: " + show(stops) + " (s)");
  c.require(tau >= rules.time_step, "/braking_time", show(tau),
            "at least /time_step, " + show(rules.time_step) + " (s)");
  const std::string what = is_given ? "/braking_time, " : "1.1 times what the fastest robot needs to stop, ";
  const auto holds_while_braking = [&](double horizon, const char* pointer) {
    c.require(horizon >= tau, pointer, show(horizon), "at least " + what + show(tau) + " (s)");
  };
  holds_while_braking(rules.horizons.most, "/horizons/most");
  holds_while_braking(rules.horizons.orca, "/horizons/orca");
  holds_while_braking(rules.horizons.robots, "/horizons/robots");
}

/// Robots that may start in overlap: what the proof that none comes nearer needs.
void check_separate(const Scenario& s, Checker& c) {
  if (!s.separate) return;
  c.require(!s.formation, "/separate", "true", "false with a formation");
  c.require(s.moving_obstacles.empty(), "/separate", "true", "false with moving obstacles, which robots must evade");
  for (std::size_t i = 0; i < s.robots.size(); ++i)
    c.require(s.robots[i].cooperates, "/robots/" + std::to_string(i) + "/cooperates", "false", "true with /separate");
}

/// The first two edges with a point in common that neighbours have not; by their first corners. The same corner twice
/// in turn is an edge that meets the one after it.
std::pair<std::size_t, std::size_t> edges_that_meet(const std::vector<Vec2>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const geometry::Segment one{corners[i], corners[(i + 1) % n]}, other{corners[j], corners[(j + 1) % n]};
      const bool touch = one.b == other.a   ? geometry::distance(one, other.b) * geometry::distance(other, one.a) == 0.0
                         : other.b == one.a ? geometry::distance(one, other.a) * geometry::distance(other, one.b) == 0.0
                                            : geometry::distance(one, other) == 0.0;
      if (touch) return {i, j};
    }
  return {0, 1};
}

/// Corners of a body, as its axle has it.
void check_footprint(const DifferentialDrive& d, const std::string& at, Checker& c) {
  if (d.footprint.empty()) return;
  for (std::size_t k = 0; k < d.footprint.size(); ++k) c.finite(d.footprint[k], at + "/" + std::to_string(k));
  if (!c.problems.empty()) return;
  if (d.footprint.size() < 3)
    return c.require(false, at, geometry::counted(d.footprint.size(), "corner"), "three corners or more");
  if (!geometry::is_simple(d.footprint)) {
    const auto [first, other] = edges_that_meet(d.footprint);
    return c.require(false, at + "/" + std::to_string(first),
                     "an edge from corner " + std::to_string(first) + ", " + show(d.footprint[first]) +
                         ", that meets the one from corner " + std::to_string(other) + ", " + show(d.footprint[other]),
                     "the corners of a polygon in turn, whose edges do not cross or touch");
  }
  if (geometry::contains(geometry::Polygon{d.footprint, {}}, Vec2{})) return;
  const auto distance_of_edge = [&](std::size_t k) {
    return geometry::distance(geometry::Segment{d.footprint[k], d.footprint[(k + 1) % d.footprint.size()]}, Vec2{});
  };
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < d.footprint.size(); ++k)
    if (distance_of_edge(k) < distance_of_edge(nearest)) nearest = k;
  c.require(false, at + "/" + std::to_string(nearest),
            "a body beside its axle: [0, 0] is " + detail::metres(distance_of_edge(nearest)) +
                " beyond the edge from corner " + std::to_string(nearest) + ", " + show(d.footprint[nearest]),
            "a polygon that contains [0, 0], the centre of the axle, since its corners are seen from there");
}

void check_drive(const Scenario& s, std::size_t i, Checker& c) {
  const Robot& r = s.robots[i];
  const DifferentialDrive& d = *r.drive;
  const std::string robot = "/robots/" + std::to_string(i), at = robot + "/kinematics/";
  c.positive(d.wheel_separation, at + "wheel_separation", "m");
  c.positive(d.max_wheel_speed, at + "max_wheel_speed", "m/s");
  c.positive(d.max_wheel_acceleration, at + "max_wheel_acceleration", "m/s^2");
  c.require(d.max_angular_speed > 0.0, at + "max_angular_speed", show(d.max_angular_speed), "above 0 (rad/s)");
  c.require(d.max_backward_speed >= 0.0, at + "max_backward_speed", show(d.max_backward_speed), "0 or more (m/s)");
  c.positive(d.reference, at + "reference", "m");
  if (d.footprint.empty()) c.positive(d.body_radius, robot + "/radius", "m");
  check_footprint(d, robot + "/footprint/polygon", c);
  c.require(std::isfinite(d.heading), robot + "/heading", show(d.heading), "a finite number (degrees)");
  c.require(r.velocity == Vec2{}, robot + "/velocity", show(r.velocity), "none: robots on wheels start at rest");
  if (!c.problems.empty()) return;
  c.require(d.max_wheel_speed * s.time_step < d.reference, at + "reference", show(d.reference),
            "more than a step of max_wheel_speed, " + show(d.max_wheel_speed * s.time_step) + " (m)");
  const double turns = std::min(2.0 * d.max_wheel_speed, d.wheel_separation * d.max_angular_speed) * s.time_step;
  c.require(turns < geometry::kPi * d.wheel_separation, at + "max_angular_speed", show(d.max_angular_speed),
            "less than " + show(geometry::kPi / s.time_step) + ", so that a step is less than a half turn (rad/s)");
  Robot made = r;
  if (c.problems.empty()) put_on_wheels(made, d, s.time_step, tracking_error_of(s));
  c.require(made.position == r.position && made.radius == r.radius && made.max_speed == r.max_speed, robot,
            "a position, radius or max_speed of another reference point", "those that `put_on_wheels` makes");
}

/// All robots of a formation move by one law: they track what they choose, or on wheels drive at it.
void check_formation_on_wheels(const Scenario& s, Checker& c) {
  const std::optional<std::size_t> driven = first_drive(s);
  if (!s.formation || !driven) return;
  for (std::size_t i = 0; i < s.robots.size(); ++i)
    c.require(s.robots[i].drive.has_value(), "/robots/" + std::to_string(i) + "/kinematics",
              "a robot that moves in any direction, in a formation with '" + s.robots[*driven].id + "' on wheels",
              "all robots of a formation on wheels, or none");
  const AskedControllerOptions& asked = s.formation->controller_options;
  c.require(!asked.brake_point.value_or(false), "/formation/controller_options/brake_point", "true",
            "false or none with robots on wheels, which drive at what they choose and have no brake point ahead");
  const std::string option = detail::unfit_for_wheels(switched({}, asked));
  if (option.empty()) return;
  const bool is_bound = option == "acceleration_bound";
  c.require(false, "/formation/controller_options/" + option, is_bound ? show(*asked.acceleration_bound) : "false",
            is_bound ? "none with robots on wheels, which have max_wheel_acceleration"
                     : "true with robots on wheels, which drive at what they choose");
}

/// Robots that brake evade what moves by itself only by standing in time, all by themselves (braking.h, lemma 8).
void check_movers_beside_brakes(const Scenario& s, bool has_wheels, Checker& c) {
  if (s.moving_obstacles.empty()) return;
  if (has_wheels)
    return c.require(
        false, "/moving_obstacles", geometry::counted(s.moving_obstacles.size(), "obstacle"),
        "none with robots on wheels: no braking of wheels is proven to evade what moves by itself; the reference "
        "point of one may be a robot without kinematics, with an /acceleration");
  for (std::size_t k = 0; k < s.moving_obstacles.size(); ++k)
    c.require(s.moving_obstacles[k].max_speed.has_value(), "/moving_obstacles/" + std::to_string(k),
              "no max_speed, with /acceleration",
              "a max_speed (m/s): no braking evades what moves by itself, but a robot can stand before it is met");
  c.require(s.robots.size() == 1 || measures_others(s), "/moving_obstacles",
            geometry::counted(s.robots.size(), "robot") + " that rely on each other, beside movers",
            "one robot, or /uncertainty/measurements, with which each may stand when it wants");
}

/// Lemma 8 (braking.h), for what is left of the velocity after a step of braking.
bool stands_before(const Scenario& s, const Robot& r, const MovingObstacle& mover) {
  const std::size_t steps = stopping_steps(norm(r.velocity), s.acceleration->max, s.time_step);
  if (steps == 1) return true;
  const Vec2 braked = (1.0 - 1.0 / static_cast<double>(steps)) * r.velocity;
  const geometry::Disc grown{mover.disc->center, mover.disc->radius + r.radius};
  const vo::ProvenHalfPlane found =
      detail::mover_half_plane(s.time_step, r.position, braked, {grown, *mover.max_speed, steps - 1});
  return found.proof != vo::Proof::none && dot(found.half_plane.normal, braked) >= found.half_plane.offset;
}

/// Robots with an acceleration, of their velocity or of their wheels.
void check_acceleration(const Scenario& s, Checker& c) {
  const std::optional<std::size_t> driven = first_drive(s);
  c.require(s.acceleration || !measures_others(s), "/uncertainty/measurements", "robots without /acceleration",
            "an /acceleration, which says how far a robot may be from where it was measured");
  const std::string with_it = s.acceleration ? " with /acceleration" : " with robots on wheels";
  if (!s.acceleration && !driven) {
    if (s.braking_time)
      c.require(false, "/braking_time", show(*s.braking_time),
                "no braking time without /acceleration or robots on wheels");
    return;
  }
  if (s.acceleration) c.positive(s.acceleration->max, "/acceleration/max", "m/s^2");
  if (s.braking_time) c.positive(*s.braking_time, "/braking_time", "s");
  c.require(!s.formation || !s.acceleration, "/acceleration", "an acceleration of robots of a formation",
            driven ? "none: wheels have their own, max_wheel_acceleration"
                   : "robots with goals; a formation has /formation/controller_options/acceleration_bound");
  check_movers_beside_brakes(s, driven.has_value(), c);
  c.require(!s.separate, "/separate", "true",
            "false" + with_it + ": robots that overlap cannot brake clear of each other");
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const std::string robot = "/robots/" + std::to_string(i);
    c.require(s.robots[i].cooperates, robot + "/cooperates", "false", "true" + with_it);
    c.require(norm(s.robots[i].velocity) <= s.robots[i].max_speed, robot + "/velocity", show(s.robots[i].velocity),
              "at most its max_speed, " + show(s.robots[i].max_speed) + " m/s," + with_it);
  }
  if (!c.problems.empty()) return;  // tau is made of these numbers
  double stops = 0.0;
  for (const Robot& r : s.robots) {
    if (s.acceleration && (!r.drive || measures_others(s)))
      stops = std::max(stops, fastest(s.speed_bound, r.max_speed) / s.acceleration->max);
    if (r.drive) stops = std::max(stops, r.drive->max_wheel_speed / r.drive->max_wheel_acceleration);
  }
  if (meets_movers(s)) {
    double steps = 0.0;
    for (const Robot& r : s.robots)
      steps = std::max(steps, static_cast<double>(stopping_steps(fastest(s.speed_bound, r.max_speed),
                                                                 s.acceleration->max, s.time_step)));
    c.require(braking_time_of(s) >= steps * s.time_step, "/braking_time", show(braking_time_of(s)),
              "the " + geometry::counted(static_cast<std::size_t>(steps), "time step") +
                  " that the fastest robot needs to stand, " + show(steps * s.time_step) + " (s), or more");
  }
  check_brakes(detail::rules_of(s, {}), stops, s.braking_time.has_value(), c);
  const double tau = braking_time_of(s);
  for (std::size_t i = 0; c.problems.empty() && i < s.robots.size(); ++i)
    if (s.robots[i].drive)
      c.require(detail::WheelLimits(*s.robots[i].drive, s.time_step, tau).side_speed() > 0.0,
                "/robots/" + std::to_string(i) + "/kinematics/max_wheel_acceleration",
                show(s.robots[i].drive->max_wheel_acceleration),
                "enough to brake within " + show(tau) + " s while turning, or a longer /braking_time");
}

/// Every robot must be able to brake from its start.
void check_braking(const Scenario& s, Checker& c) {
  if (!(braking_time_of(s) > 0.0)) return;
  const double left = braking_time_of(s) - s.time_step;
  const detail::ObstacleSpace space(s.obstacles);
  const auto require_way = [&](bool holds, std::size_t i, const std::string& meets) {
    if (holds) return;
    c.require(false, "/robots/" + std::to_string(i) + "/velocity",
              show(s.robots[i].velocity) + ", at which it meets " + meets + " before it has braked",
              "a velocity from which it can brake, which takes " + show(left) + " s times the velocity of way");
  };
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Robot& r = s.robots[i];
    if (r.velocity == Vec2{}) continue;
    require_way(space.is_clear(r.position, r.position + left * r.velocity, obstacle_radius(r)), i, "an obstacle");
    for (const MovingObstacle& mover : s.moving_obstacles)
      c.require(stands_before(s, r, mover), "/robots/" + std::to_string(i) + "/velocity",
                show(r.velocity) + ", at which moving obstacle '" + mover.id + "' may meet it before it stands",
                "a velocity from which it stands before that");
    for (std::size_t j = 0; j < s.robots.size(); ++j) {
      const Robot& other = s.robots[j];
      if (j == i || (j < i && other.velocity != Vec2{})) continue;
      const auto way = [&](const Robot& of) {
        return geometry::Segment{of.position, of.position + left * of.velocity};
      };
      const geometry::Segment relative{r.position, r.position + left * (r.velocity - other.velocity)};
      // Robots that measure each other brake whenever they want (decision/own_side.h), others alike.
      const double apart =
          measures_others(s) ? geometry::distance(way(r), way(other)) : geometry::distance(relative, other.position);
      require_way(apart >= r.radius + other.radius, i, "robot '" + other.id + "'");
    }
  }
}

/// Every robot must hear, over edges of positive weight, somebody who hears the leader.
bool reaches_leader(const Topology& t) {
  const std::size_t n = t.pinning.size();
  std::vector<bool> heard(n);
  for (std::size_t i = 0; i < n; ++i) heard[i] = t.pinning[i] > 0.0;
  for (bool is_news = true; is_news;) {
    is_news = false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n && !heard[i]; ++j)
        if (t.adjacency[i][j] > 0.0 && heard[j]) heard[i] = is_news = true;
  }
  return std::all_of(heard.begin(), heard.end(), [](bool known) { return known; });
}

void check_topology(const Topology& t, std::size_t n, Checker& c) {
  const std::string at = "/formation/topology";
  bool shaped = t.adjacency.size() == n && t.pinning.size() == n;
  for (const auto& row : t.adjacency) shaped = shaped && row.size() == n;
  c.require(shaped, at,
            "adjacency with " + geometry::counted(t.adjacency.size(), "row") + ", pinning with " +
                geometry::counted(t.pinning.size(), "entry", "entries"),
            "an n x n adjacency and n pinning gains, n = " + geometry::counted(n, "robot"));
  if (!shaped) return;
  for (std::size_t i = 0; i < n; ++i) {
    c.not_negative(
        t.pinning[i], [&] { return at + "/pinning/" + std::to_string(i); }, "gain");
    for (std::size_t j = 0; j < n; ++j) {
      const auto entry = [&] { return at + "/adjacency/" + std::to_string(i) + "/" + std::to_string(j); };
      c.not_negative(t.adjacency[i][j], entry, "weight");
      if (t.adjacency[i][j] == t.adjacency[j][i]) continue;
      c.require(false, entry(), show(t.adjacency[i][j]),
                "a symmetric matrix: the same as its mirror entry, " + show(t.adjacency[j][i]));
    }
  }
  c.require(reaches_leader(t), at, "a robot that hears the leader neither directly nor through others",
            "every robot connected to one with pinning > 0");
}

void check_formation(const FormationSpec& f, std::size_t n, Checker& c) {
  check_topology(f.topology, n, c);
  c.require(f.offsets.size() == n, "/formation/offsets", geometry::counted(f.offsets.size(), "offset"),
            "one a robot: " + std::to_string(n));
  for (std::size_t i = 0; i < f.offsets.size(); ++i)
    c.finite(f.offsets[i], [i] { return "/formation/offsets/" + std::to_string(i); });
  c.require(!f.leader.path.empty(), "/formation/leader/path", "no points", "at least one point");
  for (Vec2 p : f.leader.path) c.finite(p, "/formation/leader/path");
  c.not_negative(f.leader.speed, "/formation/leader/speed", "m/s");
  check_profile(f.leader, "/formation/leader", c);
  c.not_negative(f.controller_options.acceleration_bound.value_or(0.0),
                 "/formation/controller_options/acceleration_bound", "m/s^2");
  c.positive(f.gains.k1, "/formation/gains/k1", "gain");
  c.positive(f.gains.k2, "/formation/gains/k2", "gain");
  c.positive(f.gains.k3, "/formation/gains/k3", "1/s");
  c.positive(f.gains.kappa, "/formation/gains/kappa", "1/s");
  c.positive(f.catch_up_speed, "/formation/catch_up_speed", "m/s");
}

}  // namespace

std::string assumed_words(const Scenario& scenario) {
  const double tracking = tracking_error_of(scenario);
  std::string words;
  if (tracking > 0.0) words = "no body is farther than " + detail::metres(tracking) + " from where the run has it";
  if (measures_others(scenario)) {
    const Measurements& m = *scenario.uncertainty->measurements;
    words += (words.empty() ? "" : ", ") + std::string("robots measure others ") + detail::number_text(m.age, 6) +
             " s ago at most, within " + detail::metres(m.position) + " and " + detail::number_text(m.velocity, 6) +
             " m/s";
  }
  if (meets_movers(scenario)) {
    double fastest = 0.0;
    for (const MovingObstacle& o : scenario.moving_obstacles) fastest = std::max(fastest, *o.max_speed);
    words += (words.empty() ? "" : ", ") + std::string("no moving obstacle is faster than its max_speed, ") +
             detail::number_text(fastest, 6) +
             " m/s at most: then no robot that moves touches one, and nothing is promised to a robot that stands";
  }
  return words.empty() ? "" : "assumed: " + words;
}

std::string detail::unfit_for_wheels(const ControllerOptions& options) {
  if (options.acceleration_bound > 0.0) return "acceleration_bound";
  if (!options.absolute_frame) return "absolute_frame";
  if (!options.filter_last) return "filter_last";
  return options.horizon_clamp ? "" : "horizon_clamp";
}

std::vector<ScenarioProblem> detail::field_problems(const Scenario& scenario) {
  Checker c;
  c.not_negative(tracking_error_of(scenario), "/uncertainty/tracking", "m");
  if (measures_others(scenario)) {
    const Measurements& m = *scenario.uncertainty->measurements;
    c.not_negative(m.position, "/uncertainty/measurements/position", "m");
    c.not_negative(m.velocity, "/uncertainty/measurements/velocity", "m/s");
    c.not_negative(m.age, "/uncertainty/measurements/age", "s");
  }
  if (!c.problems.empty()) return std::move(c.problems);
  for (std::size_t i = 0; i < scenario.robots.size(); ++i)
    if (scenario.robots[i].drive) check_drive(scenario, i, c);
  if (!c.problems.empty()) return std::move(c.problems);  // positions and radii are made of these numbers
  check_robots(scenario, c);
  for (std::size_t k = 0; k < scenario.obstacles.size(); ++k)
    check_disc(scenario.obstacles[k], "/obstacles/" + std::to_string(k), c);
  check_moving(scenario, c);
  check_times(rules_of(scenario, {}), scenario.arrival_tolerance, scenario.time_limit, c);
  check_separate(scenario, c);
  check_acceleration(scenario, c);
  check_formation_on_wheels(scenario, c);
  if (scenario.formation) check_formation(*scenario.formation, scenario.robots.size(), c);
  return std::move(c.problems);
}

std::vector<ScenarioProblem> detail::field_problems(const DecisionRules& rules, double arrival_tolerance) {
  Checker c;
  check_times(rules, arrival_tolerance, std::nullopt, c);
  return std::move(c.problems);
}

std::vector<ScenarioProblem> detail::braking_problems(const DecisionRules& rules, double fastest, bool is_given) {
  Checker c;
  check_brakes(rules, fastest / rules.acceleration, is_given, c);
  return std::move(c.problems);
}

std::vector<ScenarioProblem> detail::field_problems(double radius, double max_speed) {
  Checker c;
  check_body(
      radius, max_speed, [](const char* key) { return std::string(key); }, c);
  return std::move(c.problems);
}

void keep_within_tube(Robot& robot, double body_radius, double tracking) {
  constexpr double kRounding = 1.0 + 0x1p-50;
  robot.body_radius = tracking > 0.0 ? body_radius : 0.0;
  robot.radius = tracking > 0.0 ? kRounding * (body_radius + tracking) : body_radius;
}

std::vector<ScenarioProblem> validate(const Scenario& scenario) {
  Checker c{detail::field_problems(scenario)};
  if (c.problems.empty()) check_starts(scenario, c);
  if (c.problems.empty()) check_braking(scenario, c);
  return std::move(c.problems);
}

}  // namespace exactvo::formation
