// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One robot's decisions, for a control loop: its state, its neighbours and what moves go in, the velocity to drive and
/// why that is right come out. No simulator, no clock, no thread.
///
///     Navigator navigator(setup, {{12.0, 3.0}});
///     for (;;) drive(navigator.decide({time, position, velocity}, neighbours).chosen);
///
/// The decision is the one that `simulate` makes for a robot without a route (Guidance::none, Liveness::off), by the
/// same code: enclosures round what is in the way, boost where they are certified free of traps, following of
/// boundaries after a stall, then the best velocity among certified half-planes (equation (12)). Robots that all go by
/// navigators, each with the others as neighbours, move as in `simulate`, bit for bit.
///
/// Certified: the half-planes, but for those counted by `Decision::uncertified` (contact; a shape that overlaps the
/// robot), and the choice among them, by its multipliers. Heuristic: the preferred velocity. What is certified holds
/// until the time step has passed, for neighbours that keep their half of a pair and bodies that keep their velocity.
///
/// With an acceleration there are two decisions. The first is the one above; its choice is the wish, and `preferred` of
/// the second, which takes the velocity nearest to it that leaves every robot its way to brake (guide, accelerations).
/// That one is never relaxed while all robots decide so; where data were wrong it may be.
///
/// With a drive the robot has two wheels: its pose and its wheels go in, the twist to hold comes out (guide, wheels).
/// Half-planes are then about its reference point, and so is what other robots know of it (`neighbour_on_wheels`).
///
/// See also: simulation.h runs scenarios, crowd.h is for very many robots, vo/constraint.h is one half-plane by
/// itself.

#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation {

/// The robot, and what does not change while it drives. The fields that a Robot or a Scenario has too mean the same.
struct NavigatorSetup {
  double radius = 0.5;                                ///< m, > 0; not used with a drive
  double max_speed = 3.0;                             ///< m/s, > 0; not used with a drive
  bool cooperates = true;                             ///< false: it ignores its neighbours
  std::size_t id = 0;                                 ///< its number among robots; settles ties
  std::vector<SceneObstacle> obstacles;               ///< what stands still
  Method method = Method::ivo;                        ///< how it avoids obstacles
  SpeedBoundKind speed_bound = SpeedBoundKind::disc;  ///< how `max_speed` is meant
  /// Horizons of the velocity obstacles. With an acceleration, defaults are raised to at least the braking time.
  Horizons horizons;
  Margins margins;                   ///< added to radii and facades
  double time_step = 0.05;           ///< s, > 0: the longest time from a decision to the next
  double arrival_tolerance = 0.1;    ///< m: within this of the last goal it has arrived
  double neighbour_distance = 15.0;  ///< m: farther robots that cannot be met within a time step are ignored
  /// m/s^2, > 0: how fast the velocity may change; none: it jumps. All robots that meet have the same, the same time
  /// step and the same braking time, each knows the exact velocities of the others, and nothing else moves.
  std::optional<double> acceleration = {};
  /// s: as of a Scenario; by default the usual one with an acceleration or a drive, and then neighbours of another
  /// max_speed are refused, since theirs would be another. If it is given without either, the velocity jumps, and
  /// half-planes are those on which robots rely that brake.
  std::optional<double> braking_time = {};
  /// Two wheels: `body_radius` and `max_wheel_speed` stand in place of `radius` and `max_speed`; `axle` and `heading`
  /// come with every decision. Goals are of the reference point. What `acceleration` requires of all robots holds too.
  /// With both, the velocity of the reference point changes no faster than `acceleration`: robots that measure it rely
  /// on that.
  std::optional<DifferentialDrive> drive = {};
  std::size_t neighbours = 32;  ///< memory is allocated at the start for this many neighbours and moving bodies
};

/// The setup of one robot of a scenario with goals. What moves in the scenario and the other robots are not in it: they
/// come with every decision. REQUIRES: robot < scenario.robots.size().
NavigatorSetup navigator_setup(const Scenario& scenario, std::size_t robot, Method method = Method::ivo);

/// Where the robot is.
struct NavigatorState {
  double time = 0.0;  ///< s, by any clock that does not go back
  Vec2 position;      ///< m; with a drive of the axle's centre
  Vec2 velocity;      ///< m/s; not used with a drive
  OnWheels wheels{};  ///< with a drive: where it heads, of length 1 within 1e-6, and how its wheels ran since the last
                      ///< decision, 0 at rest
};

/// What a drive is to hold until the next decision: `cmd_vel`, or the speeds of its wheels.
struct Twist {
  double linear = 0.0;   ///< m/s, of the axle's centre, > 0 forward
  double angular = 0.0;  ///< rad/s, > 0 to the left
  WheelSpeeds wheels{};  ///< the same, m/s
};

/// Another robot.
struct Neighbour {
  std::size_t id = 0;      ///< its number among robots: `DecisionConstraint::index` of what keeps clear of it
  Vec2 position = {};      ///< m
  Vec2 velocity = {};      ///< m/s
  double radius = 0.5;     ///< m, > 0
  double max_speed = 3.0;  ///< m/s, > 0
  bool cooperates = true;  ///< false: it does not yield, and this robot takes the whole responsibility
  /// None: it has sent its exact `position` and `velocity`. Else both are measured, exactly `age` ago, and this robot
  /// keeps to its own side of lines between the ways on which both brake, as the other one has to, at the same times
  /// (guide, uncertainty); that takes an acceleration.
  std::optional<Measurements> measured = {};
};

/// A robot on wheels as others have to know it: its reference point, with a disc that holds the body. `axle`: m.
Neighbour neighbour_on_wheels(std::size_t id, const DifferentialDrive& drive, double time_step, Vec2 axle,
                              const OnWheels& wheels);

/// Something else that moves. It does not yield.
struct MovingBody {
  geometry::ConvexShape shape;  ///< m, as it stands now
  Vec2 velocity;                ///< m/s
};

/// What is wrong with an argument.
enum class NavigatorProblem {
  not_finite,       ///< a number is NaN or infinite
  out_of_range,     ///< a number is outside the range that its field states, or a shape is not valid
  no_goal,          ///< there is no goal
  time_backwards,   ///< a time before that of the last decision
  inside_obstacle,  ///< the robot's centre is inside a static obstacle: the map or the position is wrong
  coincident        ///< a neighbour is in the robot's very place
};

/// "not-finite", "out-of-range" and so on.
const char* name(NavigatorProblem problem);

/// A caller's mistake; the navigator is as it was before the call.
class NavigatorError : public std::invalid_argument {
 public:
  /// `words` is what `what()` returns.
  NavigatorError(NavigatorProblem problem, const std::string& words)
      : std::invalid_argument(words), problem_(problem) {}
  /// What is wrong.
  NavigatorProblem problem() const { return problem_; }

 private:
  NavigatorProblem problem_;
};

/// Decides for one robot, again and again. Deterministic. Not to be called from two threads at once; several navigators
/// share nothing.
///
/// After the first decision `decide` allocates no memory, with these exceptions: it heads for another goal; there are
/// more neighbours or moving bodies than `NavigatorSetup::neighbours` and than ever before, or a moving body of more
/// vertices than its place in the list had; more than 1000 static shapes are within reach; doubles do not decide a sign
/// or prove the choice, and exact numbers do. Errors allocate their words.
class Navigator {
 public:
  /// Goals are visited in order. Throws NavigatorError.
  Navigator(const NavigatorSetup& setup, std::vector<Vec2> goals);
  ~Navigator();
  /// Moves; the object moved from can only be assigned to or destroyed.
  Navigator(Navigator&&) noexcept;
  /// Moves; the object moved from can only be assigned to or destroyed.
  Navigator& operator=(Navigator&&) noexcept;

  /// Other goals from the next decision on. Throws NavigatorError.
  void set_goals(std::vector<Vec2> goals);

  /// What to do from now on until the next decision: drive `chosen`. A robot that overlaps an obstacle or a neighbour
  /// is led out of it, and `uncertified` counts the half-planes that promise nothing. The reference holds until the
  /// next call. Throws NavigatorError.
  const Decision& decide(const NavigatorState& now, const std::vector<Neighbour>& neighbours = {},
                         const std::vector<MovingBody>& moving = {});

  // The last decision; empty before the first one:

  /// With a drive: takes the reference point on by `chosen` times the time step, and keeps the limits of the wheels.
  Twist twist() const;

  /// The half-planes that bind, with their multipliers, and those against what could be met within a step: with
  /// `Decision::bound` the proof of the choice. `body` is a number of `bodies`.
  const std::vector<DecisionConstraint>& constraints() const;
  /// What half-planes keep clear of, by number: the static shapes that this robot sees, the neighbours, what moves.
  const vo::BodyTable& bodies() const;
  /// Which of its goals it heads for, from 0.
  std::size_t goal() const;
  /// Whether it was within reach of the last one.
  bool has_arrived() const;
  /// The whole decision as recordings have it (recording.h). Copies, and allocates.
  RobotStep recorded() const;
  /// The bodies that it sees on its way to the present goal, as recordings have them. Copies, and allocates.
  GoalBodies goal_bodies() const;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace exactvo::formation
