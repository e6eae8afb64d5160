// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What happened in a run: one row per step, with each robot's state, its decision and the half-planes behind it.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/own_rules.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/half_plane.h"
#include "exactvo/vo/constraint.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::formation {

/// Where a half-plane comes from.
using ConstraintSource = vo::BodyKind;

/// One half-plane of a decision, and the number of the body that it keeps clear of.
struct DecisionConstraint {
  geometry::HalfPlane half_plane;                         ///< of velocities, in the frame of `chosen`
  ConstraintSource source = ConstraintSource::enclosure;  ///< what it keeps clear of
  /// The number of the enclosure (among those for the robot's present goal), of the obstacle edge (counted over the
  /// scene), of the other robot or of the moving obstacle; for a robot's own limit the robot's number.
  std::size_t index = 0;
  std::size_t piece = 0;   ///< 0: the enclosure itself; from 1 on: the convex piece that replaces it
  bool certified = false;  ///< proven to exclude the velocity obstacle's interior
  bool hard = true;        ///< false: against a robot; it may be relaxed if half-planes contradict each other
  bool active = false;     ///< binds the chosen velocity
  bool fell_back = false;  ///< the pair fell back: as if both rested, or braked if they have an acceleration (rule R0)
  double time_horizon = 0.0;  ///< s
  std::size_t body = 0;       ///< index in `Recording::bodies`
  double clearance = 0.0;     ///< m, robot's rim to the body; negative in overlap. Rounded
  /// KKT multiplier: the weight of its normal in chosen - preferred, m/s, >= 0 (solution.h); 0 if inactive. Rounded.
  double multiplier = 0.0;
};

/// Whether the half-plane is a limit of the robot's own, such as its acceleration, and not against another body. It
/// names the robot itself as its source and is hard; half-planes between robots are never hard.
inline bool is_own_limit(const DecisionConstraint& c) {
  return c.source == ConstraintSource::robot && c.hard;
}

/// How the preferred velocity was formed.
enum class Mode {
  direct,       ///< straight for the goal or slot
  guided,       ///< along a proven route
  by_plan,      ///< along a joint plan of several robots
  going_back,   ///< the way it came, to where its plan begins
  staying,      ///< its goal or slot is out of reach or taken: the run's outcome says why
  boost,        ///< turned onto the tangent of a certified trap-free enclosure
  following,    ///< along a boundary: after a stall, or (formations) on the side committed to
  pushing_out,  ///< in contact: leaving an obstacle
  steered,      ///< by the user (SimulationOptions::steering)
  arrived       ///< at its last goal
};

/// A robot's decision, without its half-planes.
struct Decision {
  Vec2 preferred;  ///< m/s
  /// The parts of the speed bound that bind, with their multipliers: chosen - preferred is the sum of multiplier times
  /// normal over these and the active half-planes, up to rounding. The disc's normal is -chosen, of length |chosen|.
  std::vector<lp::ActiveConstraint> bound;
  Vec2 chosen;  ///< m/s: the LP's optimum; a kinematic robot drives it, a second-order robot tracks it
  lp::Status status = lp::Status::optimal;  ///< of the linear program
  double violation = 0.0;                   ///< m/s: the largest violation of the relaxed half-planes (lp/solution.h)
  /// No double multipliers prove the choice, so they stay 0. The exact ones follow from the half-planes
  /// (lp::solve_exact). This happens where robots rest in contact and their half-planes leave a rounding error of room.
  bool exact_multipliers = false;
  Mode mode = Mode::direct;         ///< how `preferred` was formed
  int side = 0;                     ///< +1 left, -1 right, 0 none: the side kept while blocked
  double turned_right = 0.0;        ///< rad: how far rule R1 (liveness) turned `preferred`, to avoid other robots
  std::string note;                 ///< why a mode began or ended, empty otherwise
  bool lacks_room_to_turn = false;  ///< on wheels: obstacles keep its footprint from turning as `preferred` asks
  /// Among moving obstacles with a `max_speed`: the robot can stand after this many steps, this one included, and is
  /// proven to meet none of them before. 0: it stands in this step.
  std::size_t stopping_steps = 0;
  std::size_t uncertified = 0;          ///< half-planes of this decision that could not be certified
  OwnStage own_stage = OwnStage::none;  ///< the stage of the decision; none without half-planes of a user
  std::vector<OwnConstraint> own;       ///< the user's half-planes, in their order
};

/// The half-planes of a decision as the linear program has them: those against bodies, then the user's. While the
/// user's are relaxed, those against robots are not. The bound and the preferred velocity are not in it.
std::vector<lp::Constraint> problem_of(const Decision& decision, const std::vector<DecisionConstraint>& constraints);

/// Whether half-planes against obstacles or robots contradicted each other in this decision, or left no room.
inline bool bodies_gave(const Decision& decision) {
  return decision.status != lp::Status::optimal && !holds_bodies(decision.own_stage);
}

/// m/s: the speeds of a robot's wheels over the ground.
struct WheelSpeeds {
  double left = 0.0;   ///< above 0: forward
  double right = 0.0;  ///< the same
};

/// The state of a robot on wheels at the start of a step, in addition to its reference point.
struct OnWheels {
  Vec2 heading;        ///< of length 1, up to rounding
  WheelSpeeds speeds;  ///< m/s, during the step that led here; 0 at the start
};

/// Another robot as this one has measured it.
struct MeasuredRobot {
  std::size_t robot = 0;  ///< in the order of the scenario
  Vec2 position;          ///< m, where it was `age` before the row
  Vec2 velocity;          ///< m/s, how it drove there
  double age = 0.0;       ///< s
};

/// One robot's state at the start of a step, and its decision.
struct RobotStep : Decision {
  Vec2 position;                   ///< m, at the step's start
  Vec2 velocity;                   ///< m/s, at the step's start; on wheels both describe the reference point
  std::optional<OnWheels> wheels;  ///< set if the robot has a drive
  /// m: the place for which half-planes are built: the robot's own, or the brake point x + v / k3.
  Vec2 anchor;
  Vec2 anchor_velocity;  ///< m/s: the velocity at the anchor: the robot's own, or the one that it tracked before
  /// The active half-planes and those against bodies that could be met within a step; all of them if the options ask.
  std::vector<DecisionConstraint> constraints;
  std::vector<MeasuredRobot> measured;  ///< the others in sight, where robots measure each other
};

/// A moving obstacle's displacement from its place at t = 0, and its velocity.
struct MovedObstacle {
  Vec2 displacement;  ///< m
  Vec2 velocity;      ///< m/s
};

/// All robots at one time, with their decisions for the step that follows.
struct Step {
  double time = 0.0;                  ///< s
  std::vector<RobotStep> robots;      ///< in the order of the scenario
  Vec2 leader_position;               ///< m; (0, 0) without a formation
  Vec2 leader_velocity;               ///< m/s; (0, 0) without a formation
  std::vector<MovedObstacle> moving;  ///< one for each of the scenario's moving obstacles; empty in the last row
};

/// How a robot moved between two rows; decides what "swept" means.
enum class MotionLaw {
  straight,     ///< x + t v (kinematic robots, explicit Euler)
  exponential,  ///< v' = -k3 (v - w) solved exactly
  hermite       ///< the cubic through both end states (the general integrators)
};

/// The convex hull of a moving obstacle after this displacement, or its disc: the shape that robots keep clear of.
geometry::ConvexShape hull_of(const MovingObstacle& obstacle, Vec2 displacement);

/// The robot's own limits in its decision, recorded or not: its acceleration or its wheels. Empty if velocities jump.
/// REQUIRES: a row of a run of this scenario.
std::vector<geometry::HalfPlane> own_limits(const Scenario& scenario, const RobotStep& step, std::size_t robot);

/// The body that a half-plane keeps clear of, as its robot saw it: enough to prove the half-plane again. The half-plane
/// excludes the velocity obstacle of `shape`, grown by `radius`, seen from `position` and shifted by `velocity`, within
/// its `time_horizon`. (For a moving obstacle with a `max_speed`, `radius` includes how far it gets before the robot
/// stands. Its half-plane promises less: the robot is clear of it now, and of all that it can reach by the time the
/// robot stands.)
struct SeenBody {
  geometry::ConvexShape shape;  ///< m
  Vec2 position;                ///< m: the robot's anchor
  double radius = 0.0;          ///< m, of the robot
  Vec2 velocity;                ///< m/s, of the body; 0 for static obstacles
};

/// The body of a half-plane of `row.robots[robot]`, at its place in this row. `bodies` are the run's. REQUIRES: a row
/// of a run of this scenario, not its last; the half-plane's body is one of `bodies`.
SeenBody seen_body(const Scenario& scenario, const std::vector<vo::Body>& bodies, const Step& row, std::size_t robot,
                   const DecisionConstraint& constraint);

/// The bodies that stand for the obstacles on one robot's way to one of its goals: enclosures, or edges and pieces.
struct GoalBodies {
  double time = 0.0;                ///< s, from then on
  std::size_t robot = 0;            ///< in the order of the scenario
  std::size_t goal = 0;             ///< the goal's number, from 0
  std::vector<std::size_t> bodies;  ///< indices in `Recording::bodies`; `DecisionConstraint::index` counts them
};

/// One robot of a joint plan goes straight to a place while the others stand.
struct PlanMove {
  std::size_t robot = 0;  ///< in the order of the scenario
  Vec2 to;                ///< m
};

/// The plan of robots that waited for each other (liveness, rule R3): moves one after the other, from where the robots
/// were in a row. Robots move at the same time if the order allows. Heuristic: half-planes decide the motion. No move
/// comes nearer to an obstacle or to another robot of the plan than radii allow or than it begins, up to a share of
/// 1e-8.
struct JointPlan {
  std::size_t row = 0;       ///< the row in which it was made, before the decisions
  std::size_t from_row = 0;  ///< the row where it begins; if that is earlier, its robots first go back as they came
  std::vector<std::size_t> robots;  ///< ascending, in the order of the scenario
  std::vector<Vec2> starts;         ///< m: the place of each of these robots in `from_row`
  std::vector<PlanMove> moves;      ///< in the order of the plan
};

/// Joint plans of a run (liveness).
struct LivenessCourse {
  std::size_t groups = 0;        ///< groups that followed a plan
  std::size_t largest = 0;       ///< robots in the largest group
  std::size_t search_nodes = 0;  ///< joint places that the search visited
};

/// Routes of a run (guidance).
struct RoutesCourse {
  std::size_t planned = 0;     ///< one for each goal that a robot set out for
  std::size_t pushed_off = 0;  ///< planned again because a robot was pushed out of sight of its route
  std::size_t cut = 0;         ///< planned again because a moving obstacle stood on a route, or had left it
  std::size_t nearest = 0;     ///< planned routes that end as near to the goal as can be reached
};

/// A whole run. `simulate` makes it; `datasets::write_recording` keeps it.
struct Recording {
  std::vector<Step> steps;                 ///< the last row is the final state: its decisions are empty
  MotionLaw motion = MotionLaw::straight;  ///< how robots moved between rows
  double time_step = 0.0;                  ///< s
  double tracking_gain = 0.0;              ///< k3, 1/s, for exponential motion
  /// `chosen` is relative to the leader, as the paper's controllers have it (V_IVO of (15)); else absolute.
  bool relative_frame = false;
  std::optional<ControllerOptions> controller_options;  ///< a formation's controller options, as they were in force
  std::vector<Vec2> offsets;  ///< m, Delta_i as the controller used them (recentred or not); empty without a formation
  bool diverged = false;  ///< the formation's error grew to the end, where robots move, or the state left every bound
  std::string outcome;    ///< in words, for people
  /// Warnings from before the run: a step beyond the integrator's limit, a goal inside an obstacle.
  std::vector<std::string> warnings;
  /// The bodies of half-planes, by number. Robots and moving obstacles have their shapes at the end of the run.
  std::vector<vo::Body> bodies;
  /// In order of time: those for every robot's first goal, then those for later goals as they came up.
  std::vector<GoalBodies> goal_bodies;
  std::vector<JointPlan> plans;            ///< in order of time
  std::optional<LivenessCourse> liveness;  ///< set if robots may follow plans
  std::optional<RoutesCourse> routes;      ///< set if robots follow routes
  bool all_half_planes = false;            ///< every half-plane of every decision was kept
  double wall_time = 0.0;                  ///< s: duration of `simulate` without the time spent in the sink
};

}  // namespace exactvo::formation
