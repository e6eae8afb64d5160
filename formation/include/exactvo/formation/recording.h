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

/// One half-plane of a decision, and by number the body that it keeps clear of.
struct DecisionConstraint {
  geometry::HalfPlane half_plane;                         ///< of velocities, in the frame of `chosen`
  ConstraintSource source = ConstraintSource::enclosure;  ///< what it keeps clear of
  /// Of the enclosure (of those for the robot's present goal), the obstacle edge (counted over the scene), the other
  /// robot or the moving obstacle; of the robot itself where it is its own limit.
  std::size_t index = 0;
  std::size_t piece = 0;      ///< 0: the enclosure itself; from 1 on: which convex piece it gave way to
  bool certified = false;     ///< proven to exclude the velocity obstacle's interior
  bool hard = true;           ///< false: against a robot, and may give where half-planes contradict each other
  bool active = false;        ///< binds the chosen velocity
  bool fell_back = false;     ///< of a pair that fell back: as if both rested, or with an acceleration braked (rule R0)
  double time_horizon = 0.0;  ///< s
  std::size_t body = 0;       ///< of `Recording::bodies`
  double clearance = 0.0;     ///< m, robot's rim to the body; negative in overlap. Rounded
  /// KKT multiplier: the weight of its normal in chosen - preferred, m/s, >= 0 (solution.h); 0 if inactive. Rounded.
  double multiplier = 0.0;
};

/// Whether it is none against others, but a limit of the robot's own: of its acceleration. It names the robot itself as
/// its source, and is hard, as half-planes of robots against robots never are.
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

/// What a robot decided, but for the half-planes.
struct Decision {
  Vec2 preferred;  ///< m/s
  /// What of the speed bound binds, with its multiplier: chosen - preferred is the sum of multiplier times normal over
  /// these and the active half-planes (of the disc: the normal is -chosen, of length |chosen|). Up to rounding.
  std::vector<lp::ActiveConstraint> bound;
  Vec2 chosen;  ///< m/s: the LP's optimum; what a kinematic robot does, what a second-order one tracks
  lp::Status status = lp::Status::optimal;  ///< of the linear program
  double violation = 0.0;                   ///< m/s, of the half-planes that gave (lp/solution.h)
  /// No multipliers in double prove the choice: they are left at 0. The exact ones follow from the half-planes
  /// (lp::solve_exact). Seen where robots rest in contact and their half-planes leave a rounding error of room.
  bool exact_multipliers = false;
  Mode mode = Mode::direct;     ///< how `preferred` was formed
  int side = 0;                 ///< +1 left, -1 right, 0 none: the side kept while blocked
  double turned_right = 0.0;    ///< rad: by which rule R1 (liveness) turned `preferred` for others that may be met
  std::string note;             ///< why a mode began or ended, empty otherwise
  std::size_t uncertified = 0;  ///< half-planes of this decision that could not be certified
  OwnStage own_stage = OwnStage::none;  ///< where the user has asked for half-planes
  std::vector<OwnConstraint> own;       ///< these, in their order
};

/// The half-planes of a decision as the linear program has them: those against bodies, then the user's. While the
/// user's give, those against robots do not. Without the bound and the preferred velocity.
std::vector<lp::Constraint> problem_of(const Decision& decision, const std::vector<DecisionConstraint>& constraints);

/// Whether half-planes against obstacles or robots contradicted each other in it, or left no room.
inline bool bodies_gave(const Decision& decision) {
  return decision.status != lp::Status::optimal && !holds_bodies(decision.own_stage);
}

/// m/s: how fast the wheels of a robot run over the ground.
struct WheelSpeeds {
  double left = 0.0;   ///< above 0: forward
  double right = 0.0;  ///< the same
};

/// What a robot on wheels has beside its reference point, at the start of a step.
struct OnWheels {
  Vec2 heading;        ///< of length 1, up to rounding
  WheelSpeeds speeds;  ///< m/s, during the step that led here; 0 at the start
};

/// One robot's state at the start of a step, and its decision.
struct RobotStep : Decision {
  Vec2 position;  ///< m, at the step's start
  Vec2 velocity;  ///< m/s, at the step's start; both are those of the reference point where it has wheels
  std::optional<OnWheels> wheels;  ///< of a robot with a drive
  /// Where half-planes are built, and round which velocity: the robot's own, or the brake point x + v / k3 and what the
  /// robot tracked before.
  Vec2 anchor;           ///< m
  Vec2 anchor_velocity;  ///< m/s
  /// The active ones and those against what could be met within a step; all of them where asked for.
  std::vector<DecisionConstraint> constraints;
};

/// Where a moving obstacle is, from where it was at t = 0, and how it moves.
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
  std::vector<MovedObstacle> moving;  ///< of the scenario's moving obstacles; empty in the last row
};

/// How a robot moved between two rows; decides what "swept" means.
enum class MotionLaw {
  straight,     ///< x + t v (kinematic robots, explicit Euler)
  exponential,  ///< v' = -k3 (v - w) solved exactly
  hermite       ///< the cubic through both end states (the general integrators)
};

/// The convex hull of a moving obstacle that was carried so far, or its disc: the shape that robots keep clear of.
geometry::ConvexShape hull_of(const MovingObstacle& obstacle, Vec2 displacement);

/// The limits of the robot's own in its decision, recorded or not: of its acceleration or its wheels. Empty where
/// velocities jump. REQUIRES: a row of a run of this scenario.
std::vector<geometry::HalfPlane> own_limits(const Scenario& scenario, const RobotStep& step, std::size_t robot);

/// What a half-plane keeps clear of, as its robot saw it: enough to prove it again. The half-plane excludes the
/// velocity obstacle of `shape`, grown by `radius`, seen from `position` and shifted by `velocity`, within its
/// `time_horizon`.
struct SeenBody {
  geometry::ConvexShape shape;  ///< m
  Vec2 position;                ///< m: the robot's anchor
  double radius = 0.0;          ///< m, of the robot
  Vec2 velocity;                ///< m/s, of the body; 0 for static obstacles
};

/// The body of a half-plane of `row.robots[robot]`, where the row has it. `bodies`: of the run. REQUIRES: a row of a
/// run of this scenario, not its last; the half-plane's body is one of `bodies`.
SeenBody seen_body(const Scenario& scenario, const std::vector<vo::Body>& bodies, const Step& row, std::size_t robot,
                   const DecisionConstraint& constraint);

/// The bodies that stand for the obstacles on one robot's way to one of its goals: enclosures, or edges and pieces.
struct GoalBodies {
  double time = 0.0;                ///< s, from then on
  std::size_t robot = 0;            ///< in the order of the scenario
  std::size_t goal = 0;             ///< which of its goals, from 0
  std::vector<std::size_t> bodies;  ///< of `Recording::bodies`; `DecisionConstraint::index` counts them
};

/// One robot of a joint plan goes straight to a place while the others stand.
struct PlanMove {
  std::size_t robot = 0;  ///< in the order of the scenario
  Vec2 to;                ///< m
};

/// The plan of robots that waited for each other (liveness, rule R3): moves one after the other, from where the robots
/// were in a row. They drive at once what the order allows. Heuristic: half-planes decide what is driven. No move comes
/// nearer to an obstacle or to another robot of the plan than radii allow or than it begins, up to a share of 1e-8.
struct JointPlan {
  std::size_t row = 0;              ///< in which it was made, before the decisions
  std::size_t from_row = 0;         ///< where it begins; where that is earlier, its robots first go back as they came
  std::vector<std::size_t> robots;  ///< ascending, in the order of the scenario
  std::vector<Vec2> starts;         ///< m, of each of them: where it was in `from_row`
  std::vector<PlanMove> moves;      ///< in the order of the plan
};

/// Joint plans of a run (liveness).
struct LivenessCourse {
  std::size_t groups = 0;        ///< that went by a plan
  std::size_t largest = 0;       ///< robots in one
  std::size_t search_nodes = 0;  ///< joint places that were looked at
};

/// Routes of a run (guidance).
struct RoutesCourse {
  std::size_t planned = 0;     ///< one for each goal that a robot set out for
  std::size_t pushed_off = 0;  ///< planned again where a robot was pushed out of sight of its route
  std::size_t cut = 0;         ///< planned again as a moving obstacle stood on a route, or had left it
  std::size_t nearest = 0;     ///< of those planned, the ones that end as near to the goal as can be reached
};

/// A whole run. `simulate` makes it; `datasets::write_recording` keeps it.
struct Recording {
  std::vector<Step> steps;                 ///< the last row is the final state: its decisions are empty
  MotionLaw motion = MotionLaw::straight;  ///< how robots moved between rows
  double time_step = 0.0;                  ///< s
  double tracking_gain = 0.0;              ///< k3, 1/s, where motion is exponential
  /// `chosen` is relative to the leader, as the paper's controllers have it (V_IVO of (15)); else absolute.
  bool relative_frame = false;
  std::optional<ControllerOptions> controller_options;  ///< of a formation's controller, as they were in force
  std::vector<Vec2> offsets;  ///< m, Delta_i as the controller used them (recentred or not); empty without a formation
  bool diverged = false;  ///< the formation's error grew to the end, where robots move, or the state left every bound
  std::string outcome;    ///< in words, for people
  /// What could be said before the run: a step beyond the integrator's limit, a goal inside an obstacle.
  std::vector<std::string> warnings;
  /// What half-planes were built on, by number. Of robots and moving obstacles the shape is as at the end of the run.
  std::vector<vo::Body> bodies;
  std::vector<GoalBodies>
      goal_bodies;               ///< in order of time: of every robot's first goal, then of others as they came up
  std::vector<JointPlan> plans;  ///< in order of time
  std::optional<LivenessCourse> liveness;  ///< where robots may go by plan
  std::optional<RoutesCourse> routes;      ///< where robots go along routes
  bool all_half_planes = false;            ///< every half-plane of every decision was kept
  double wall_time = 0.0;                  ///< s: duration of `simulate` without the time spent in the sink
};

}  // namespace exactvo::formation
