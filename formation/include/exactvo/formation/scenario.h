// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A scenario as plain data: robots, obstacles, and, for a formation, the topology and the leader.
/// Defaults are those of the paper's Section V with the corrections of docs/guide/errata.md, except `guidance` and
/// `liveness`, which the paper does not have. SI units throughout.
///
/// See also: simulation.h runs one; datasets/scenario_file.h reads one from JSON.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/controller_options.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation {

using geometry::Vec2;

/// Two wheels on one axle. What keeps clear is a disc about the reference point, which is ahead of the axle's centre
/// and moves in any direction (`put_on_wheels`).
struct DifferentialDrive {
  double wheel_separation = 0.0;                    ///< m, > 0
  double max_wheel_speed = 0.0;                     ///< m/s, > 0, on the ground
  double max_wheel_acceleration = 0.0;              ///< m/s^2, > 0: how fast the speed of a wheel may change
  double max_angular_speed = geometry::kInfinity;   ///< rad/s, > 0
  double max_backward_speed = geometry::kInfinity;  ///< m/s, >= 0, of the axle's centre
  double reference = 0.0;                           ///< m, > 0: how far ahead the reference point is
  double heading = 0.0;                             ///< degrees, at t = 0: 0 along x, 90 along y
  Vec2 axle = {};                                   ///< m, the axle's centre at t = 0
  double body_radius = 0.0;                         ///< m, > 0: of the disc about the axle that holds the body
  /// m, from the axle's centre, x ahead: the corners of the body. It contains the axle's centre. Empty: the disc.
  std::vector<Vec2> footprint = {};
  /// m, in the same axes, by `put_on_wheels`: discs that together hold the footprint, each with the stray of a step and
  /// the tracking error, the first about the reference point. They keep clear of obstacles. Empty without a footprint.
  std::vector<geometry::Disc> chain = {};
  /// m, by `put_on_wheels`: the tracking error that the radii of disc and chain include.
  double tracking = 0.0;
};

/// A disc that moves.
struct Robot {
  std::string id;           ///< its name in results and messages
  Vec2 position;            ///< m, at t = 0
  Vec2 velocity;            ///< m/s, at t = 0
  double radius = 0.5;      ///< m, > 0
  double max_speed = 3.0;   ///< m/s, > 0
  std::vector<Vec2> goals;  ///< m, visited in order; empty for a robot of a formation
  bool cooperates = true;   ///< false: it ignores other robots, and they take the whole responsibility
  /// None: it moves in any direction. Else `position`, `radius`, `max_speed` and goals are those of the reference point
  /// and the disc about it, as `put_on_wheels` makes them.
  std::optional<DifferentialDrive> drive = {};
  /// m: of the body, where `Scenario::uncertainty` makes `radius` larger (`keep_within_tube`); 0: `radius` is its own.
  double body_radius = 0.0;
};

/// An obstacle that stands still.
struct SceneObstacle {
  std::string id;            ///< its name in results and messages
  geometry::Obstacle shape;  ///< m; for a disc the polygon round it
  std::optional<geometry::Disc> disc =
      {};  ///< m; what it is, where set: then made by `disc_obstacle` (disc_obstacle.h)
};

/// The set V of allowed velocities: the paper's "[3, 3]^T" can be read either way.
enum class SpeedBoundKind {
  disc,  ///< |v| <= max_speed
  box    ///< |v_x| <= max_speed and |v_y| <= max_speed
};

/// How a robot with goals finds its way.
enum class Guidance {
  none,  ///< straight for the goal, and round obstacles as the method has it: the paper's way
  route  ///< along a proven route (geometry/routes.h) through what the margin leaves, without enclosures;
         ///< `Unreachable` says what a robot does if its goal is out of reach
};

/// What a robot along routes does if its goal is out of reach.
enum class Unreachable {
  stay,    ///< it stays where it is
  nearest  ///< it goes to the place nearest to the goal that it can reach
};

/// What is done so that robots with goals do not wait for each other for ever.
enum class Liveness {
  off,   ///< nothing: the paper's way. In a crowd half-planes between robots are relaxed where they contradict each
         ///< other
  bias,  ///< robots in each other's way turn to the right, the more the longer they are held up. Half-planes of a pair
         ///< that contradict others are replaced by those of robots at rest instead of being relaxed: robots that
         ///< cooperate never overlap
  plan   ///< also, robots that wait for each other go by a joint plan, from where they are or from where they
         ///< were before
};

/// tau of the velocity obstacles, s. IVO: tau = clamp(dist / max(|v|, speed_floor max_speed), least, most); ORCA uses
/// `orca`.
struct Horizons {
  double least = 0.3;        ///< s, >= 2 dt
  double most = 3.0;         ///< s
  double speed_floor = 0.5;  ///< fraction of max_speed
  double orca = 2.0;         ///< s, for the baseline, agents and obstacles both
  double robots = 2.0;       ///< s, robot against robot in the IVO methods
};

/// Room that is kept in addition to what safety needs.
struct Margins {
  double obstacle = 0.08;  ///< m, a facade's depth inside its enclosure
  double robot = 0.04;     ///< m, added to the radius sum of a pair
};

/// How fast the velocity of a robot with goals may change.
struct Acceleration {
  double max = 1.0;  ///< m/s^2, > 0: |v' - v| <= max * time_step
};

/// m: of the disc about a robot's place that keeps clear of obstacles; with a footprint the first of its chain. Robots
/// keep clear of each other by `radius`.
inline double obstacle_radius(const Robot& robot) {
  return robot.drive && !robot.drive->chain.empty() ? robot.drive->chain.front().radius : robot.radius;
}

/// m: no disc that keeps clear of obstacles reaches farther from a robot's place, whatever its heading.
double obstacle_reach(const Robot& robot);

/// m: disc `link`, 1 or more, of the chain of a robot with a footprint at this place and heading.
geometry::Disc link_at(const DifferentialDrive& drive, std::size_t link, Vec2 position, Vec2 heading);

/// Robots measure each other instead of telling each other where they are: bounds of the errors. A measurement is of
/// the other's reference point, relative to the robot's own.
struct Measurements {
  double position = 0.0;  ///< m, >= 0: a measured place is off by this at most
  double velocity = 0.0;  ///< m/s, >= 0: a measured velocity is off by this at most
  double age = 0.0;       ///< s, >= 0: how old both are at most
};

/// What may differ between a run and the world. Robots are where a run has them only up to these bounds, which are
/// assumed: a run can't see whether they hold.
struct Uncertainty {
  double tracking = 0.0;  ///< m, >= 0: no point of a body is farther than this from where the run has it
  /// None: robots know each other's places and velocities exactly.
  std::optional<Measurements> measurements = {};
};

/// A speed at a time. Between knots the speed is linear; before the first and after the last it is held; two knots at
/// the same time are a jump.
struct SpeedKnot {
  double time = 0.0;   ///< s, >= 0
  double speed = 0.0;  ///< m/s, >= 0
};

/// A motion along the polyline `path` at `speed`, or as `profile` says where that is not empty (speed_profile.h makes
/// some), then at rest at its end.
struct TimedPath {
  std::vector<Vec2> path;               ///< m, at least one point
  double speed = 0.0;                   ///< m/s, >= 0
  std::vector<SpeedKnot> profile = {};  ///< times not falling
};

/// The virtual leader of a formation: how it moves, and what is to be said of a path that was planned (leader_route.h).
struct Leader : TimedPath {
  std::string why_short = {};  ///< why a planned path does not lead where it should
  std::string note = {};       ///< a remark on a planned path, for people
};

/// An obstacle that moves without turning: `shape` as it stands at t = 0, carried along `motion`. Robots see the
/// convex hull, or the disc, and take the whole responsibility.
struct MovingObstacle {
  std::string id;                           ///< its name in results and messages
  geometry::Obstacle shape;                 ///< m, at t = 0
  TimedPath motion;                         ///< its path's first point is the origin of the displacement
  std::optional<geometry::Disc> disc = {};  ///< m, at t = 0; as of `SceneObstacle`
  /// m/s, >= 0, of a disc: robots with an acceleration know no more of its motion than that it is no faster. None: they
  /// take it to keep its velocity.
  std::optional<double> max_speed = {};
};

/// Gains of equations (14), (15) and (17).
struct Gains {
  double k1 = 0.25;    ///< position consensus
  double k2 = 0.45;    ///< velocity consensus
  double k3 = 37.5;    ///< velocity tracking, 1/s
  double kappa = 1.5;  ///< 1/s, slope of the saturated preference
};

/// Consensus topology (paper, Section II.B): weights a_ij = a_ji >= 0, pinning b_i >= 0.
struct Topology {
  std::vector<std::vector<double>> adjacency;  ///< a_ij, n x n, symmetric, zero diagonal
  std::vector<double> pinning;                 ///< b_i, one a robot
};

/// What robots without goals do together.
struct FormationSpec {
  Topology topology;            ///< which robot hears which
  std::vector<Vec2> offsets;    ///< Delta_i, m
  bool recentre = true;         ///< subtract mean(Delta), as equation (4) needs
  Leader leader;                ///< the leader that they follow
  Gains gains;                  ///< of the controller
  double catch_up_speed = 1.5;  ///< v_s, m/s: how fast a robot may close on its slot beyond the leader's velocity
  AskedControllerOptions controller_options = {};  ///< switched on or off against what the controller has
};

/// All that a run depends on besides its SimulationOptions.
struct Scenario {
  std::string name;                                   ///< for people, and part of results
  std::string description;                            ///< for people
  std::vector<Robot> robots;                          ///< in a formation, one robot per slot
  std::vector<SceneObstacle> obstacles;               ///< static
  std::optional<FormationSpec> formation;             ///< none: kinematic robots with goals (Section V.A)
  Guidance guidance = Guidance::route;                ///< of robots with goals
  Unreachable unreachable = Unreachable::stay;        ///< of robots with goals along routes
  Liveness liveness = Liveness::plan;                 ///< of robots with goals or slots
  bool separate = false;                              ///< of robots with goals: they may start in overlap, and part
  SpeedBoundKind speed_bound = SpeedBoundKind::disc;  ///< how every robot's max_speed is meant
  Horizons horizons;                                  ///< of the velocity obstacles
  Margins margins;                                    ///< added to radii and facades
  double time_step = 0.05;                            ///< s, > 0
  double time_limit = 120.0;                          ///< s, > 0
  double arrival_tolerance = 0.1;                     ///< m: within this of the last goal a robot has arrived
  double neighbour_distance = 15.0;                   ///< m, > 0: robots farther apart ignore each other, but never
                                                      ///< those that could meet within a time step
  std::vector<MovingObstacle> moving_obstacles;       ///< carried along their paths
  std::optional<Acceleration> acceleration;           ///< of robots with goals; none: velocities jump
  /// s, with `acceleration`: how long the way of a robot that brakes is kept clear, `braking_time_of`. Not used
  /// without.
  std::optional<double> braking_time;
  /// `keep_within_tube` and `put_on_wheels` set it and add it to each robot's `radius`. None: bodies are exactly where
  /// the run has them.
  std::optional<Uncertainty> uncertainty;
};

/// m/s, no less than the length of any velocity within the bound.
inline double fastest(SpeedBoundKind bound, double max_speed) {
  constexpr double kDiagonal = 1.4142135623731;  // above sqrt 2 by more than the product's rounding
  return bound == SpeedBoundKind::disc ? max_speed : kDiagonal * max_speed;
}

/// s: the default tau of braking for robots that are no faster than this (m/s): 1.1 times the time that the fastest
/// robot needs to stop, and at least a step.
inline double usual_braking_time(double fastest, double acceleration, double time_step) {
  constexpr double kSpare = 1.1;
  return std::max(kSpare * (fastest / acceleration), time_step);
}

/// m/s: the greatest speed from which a robot can brake to rest in `steps` steps. A millionth of its acceleration is
/// left to roundings.
inline double stopping_speed(double acceleration, double time_step, std::size_t steps) {
  constexpr double kShare = 1.0 - 1e-6;
  return static_cast<double>(steps) * (kShare * acceleration * time_step);
}

/// The least number of steps, 1 or more, after which a robot of that speed (m/s) stands; no more than 10^15.
inline std::size_t stopping_steps(double speed, double acceleration, double time_step) {
  constexpr double kMost = 1e15;
  const double about = std::ceil(speed / stopping_speed(acceleration, time_step, 1));
  if (!(about < kMost)) return static_cast<std::size_t>(kMost);
  auto steps = static_cast<std::size_t>(std::max(1.0, about));
  if (speed > stopping_speed(acceleration, time_step, steps)) ++steps;  // rounded
  return steps;
}

/// Whether there is a moving obstacle with a `max_speed`: robots know no more of its motion.
inline bool meets_movers(const Scenario& scenario) {
  return std::any_of(scenario.moving_obstacles.begin(), scenario.moving_obstacles.end(),
                     [](const MovingObstacle& o) { return o.max_speed.has_value(); });
}

/// The unit vector of a heading (degrees); exact for multiples of 90.
Vec2 heading_vector(double degrees);

/// m: the reference point strays from its straight way by this at most in a step (theorem 2 of the guide, wheels).
double stray_of(const DifferentialDrive& drive, double time_step);

/// m: how far a body may be from where the run has it, `Uncertainty::tracking`.
inline double tracking_error_of(const Scenario& scenario) {
  return scenario.uncertainty ? scenario.uncertainty->tracking : 0.0;
}

/// Whether robots measure each other, and keep to their own sides of lines between them (decision/own_side.h).
inline bool measures_others(const Scenario& scenario) {
  return scenario.uncertainty && scenario.uncertainty->measurements;
}

/// Sets the disc of a robot that moves in any direction: it holds the body, of `body_radius`, wherever that is within
/// `tracking` of the robot's place.
void keep_within_tube(Robot& robot, double body_radius, double tracking);

/// Sets the reference point of a robot on wheels and the disc about it that holds the body (its footprint where it has
/// one), whatever the heading, the stray of a step, and the tracking error (all m). REQUIRES: max_wheel_speed *
/// time_step < reference.
void put_on_wheels(Robot& robot, const DifferentialDrive& drive, double time_step, double tracking = 0.0);

/// s: tau of braking, one for all robots. A robot that brakes keeps the share 1 - time_step / tau of its velocity in
/// each step, and drives on for tau times its velocity at most. `braking_time`, or the usual one; 0 where
/// nothing has an acceleration, neither the scenario nor the wheels of a robot.
inline double braking_time_of(const Scenario& scenario) {
  double usual = 0.0;
  for (const Robot& robot : scenario.robots) {
    const double speed = fastest(scenario.speed_bound, robot.max_speed);
    if (scenario.acceleration)
      usual = std::max(usual, usual_braking_time(speed, scenario.acceleration->max, scenario.time_step));
    if (scenario.acceleration && meets_movers(scenario))  // where it stands in the end, it does so in time
      usual =
          std::max(usual, static_cast<double>(stopping_steps(speed, scenario.acceleration->max, scenario.time_step)) *
                              scenario.time_step);
    if (robot.drive)
      usual = std::max(usual, usual_braking_time(robot.drive->max_wheel_speed, robot.drive->max_wheel_acceleration,
                                                 scenario.time_step));
  }
  return usual > 0.0 ? scenario.braking_time.value_or(usual) : 0.0;
}

}  // namespace exactvo::formation
