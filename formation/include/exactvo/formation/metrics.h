// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Measurements of a run, from its recording alone. SI units. A value that does not apply is empty.
///
/// Clearances are swept and certified: lower bounds over the continuous motion between rows (of the cubic through both
/// ends, where the integrator has no closed form) and of what moves beside the robot, round its corners and through
/// its changes of speed, with all roundings taken off. A bound just below 0, which those roundings alone could explain
/// (`kContactDepth`), is 0: contact. Where a robot overlaps an obstacle they are at most 0, and not its depth.

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/run_report.h"
#include "exactvo/formation/run_sink.h"
#include "exactvo/formation/stuck.h"

namespace exactvo::formation {

/// What a robot collided with.
enum class CollisionKind {
  obstacle,         ///< one that stands still
  moving_obstacle,  ///< one that moves
  robot             ///< another robot
};

/// Consecutive steps in which a robot overlaps one and the same obstacle or robot. A pair of robots is named once, by
/// the one that comes first in the scenario.
struct Collision {
  std::string robot;                             ///< its id
  CollisionKind kind = CollisionKind::obstacle;  ///< what it collided with
  std::string with;                              ///< the obstacle's or the other robot's id
  double from = 0.0;                             ///< s, start of the first of the steps
  double until = 0.0;                            ///< s, end of the last
  double deepest_at = 0.0;                       ///< s, to a sixty-fourth of a step
  double depth = 0.0;                            ///< m, how far the rims overlap then
  Vec2 place;                                    ///< m, where the robot is then
  bool relaxed = false;  ///< a decision of one of the two robots could not keep every half-plane before or meanwhile
  /// The robot stood all the while, and a moving obstacle with a max_speed hit it: no promise excludes that.
  bool standing = false;
};

/// The results of one robot.
struct RobotMetrics {
  std::string id;  ///< the robot's
  /// At its last goal, or in a formation at its slot with the leader at its end, within the scenario's tolerance.
  bool arrived = false;
  std::optional<double> arrival_time;            ///< s
  double path_length = 0.0;                      ///< m
  std::optional<double> min_obstacle_clearance;  ///< m, swept: to the robot's rim, negative is penetration
  /// m, how much longer its path is than the direct way, for a robot that arrived: from its start straight to its
  /// goals, through walls too; in a formation from its start to its slot and on with the leader. Never below 0.
  std::optional<double> detour = std::nullopt;
  std::optional<double> largest_slot_error = std::nullopt;  ///< m, in a formation, from the second row on
};

/// A formation's error over time: the largest distance of a robot from its slot.
struct FormationCourse {
  double largest_error = 0.0;          ///< m, from the second row on: the first is where it was put
  double largest_error_at = 0.0;       ///< s
  std::string largest_error_of;        ///< the robot's id
  std::optional<double> first_formed;  ///< s: when all were first within the scenario's arrival tolerance
  std::optional<double> formed_since;  ///< s: from then to the end all are within it
  double share_formed = 0.0;  ///< share of the rows, from the second on, in which all robots were within that tolerance
  double rms_error = 0.0;     ///< m, root mean square of all robots' distances from their slots in these rows
};

/// Joint plans of robots that waited for each other (liveness).
struct PlanMetrics : LivenessCourse {
  double time_by_plan = 0.0;  ///< s, in which some robot went by plan
  double time_back = 0.0;     ///< s, in which some robot went back to where its plan begins
};

/// Pairs of robots that were nearer to each other than `margins.robot`, at the rows of a run.
struct RobotMarginCourse {
  double asked = 0.0;         ///< m, the margin
  std::size_t pair_rows = 0;  ///< pairs, counted once in every row in which they were nearer
  std::size_t robots = 0;     ///< robots of such pairs
};

/// The results of a run.
struct Metrics {
  std::size_t arrived = 0;   ///< robots that are at their goals at the end
  bool all_arrived = false;  ///< every robot's `arrived`
  /// s: median over all robots; a robot that did not arrive counts as last; empty if the median is such a robot.
  std::optional<double> median_arrival_time;
  std::optional<double> last_arrival_time;         ///< s
  std::optional<double> min_obstacle_clearance;    ///< m, swept; 0 in contact
  std::optional<double> min_robot_clearance;       ///< m, swept; 0 in contact
  std::optional<RobotMarginCourse> robot_margin;   ///< set for several robots with a margin to keep
  std::optional<double> formation_position_error;  ///< m, at the end: max over robots of |x_i - x_L - Delta_i|
  std::optional<double> formation_velocity_error;  ///< m/s, at the end
  std::optional<double> leader_arrival_time;       ///< s
  double jitter = 0.0;                             ///< m/s^2: sum over steps and robots of |a_{k+1} - a_k|
  double velocity_variation = 0.0;                 ///< m/s: sum over steps and robots of |v_{k+1} - v_k|
  double peak_acceleration = 0.0;                  ///< m/s^2: the greatest |v_{k+1} - v_k| over the time step
  std::size_t heading_reversals = 0;    ///< turns whose sign changes from one step to the next, beyond 1e-3 rad
  std::size_t active_set_switches = 0;  ///< decisions whose active constraints differ from the step before
  std::size_t relaxed_steps = 0;  ///< decisions that were not `optimal`: soft half-planes gave, or no answer held all
  std::size_t uncertified_half_planes = 0;          ///< half-planes of all decisions that could not be certified
  std::optional<CrowdMetrics> crowd;                ///< set if the run does not keep decisions
  std::size_t steps = 0;                            ///< rows but the last
  double time = 0.0;                                ///< s, simulated
  double wall_time = 0.0;                           ///< s
  std::vector<RobotMetrics> robots;                 ///< in the order of the scenario
  std::optional<LyapunovSummary> lyapunov;          ///< set for a formation
  std::optional<FormationCourse> formation_course;  ///< set for a formation
  std::vector<Collision> collisions;                ///< in the order of their beginnings
  std::string outcome;  ///< how it ended, in words: collisions first, then what the recording says, then long detours
  std::vector<std::string> warnings;      ///< the recording's
  std::vector<std::string> not_measured;  ///< what was not measured, and why, in words
  std::optional<PlanMetrics> plans;       ///< set if robots may follow plans
  std::optional<RoutesCourse> routes;     ///< set if robots follow routes
  std::vector<std::string> deadlock;      ///< ids of robots at rest at the end, each waiting for the next (waiting.h)
  std::vector<std::string> stuck;         ///< a sentence for each robot that stopped elsewhere (stuck.h)
};

/// The metrics of a recorded run. REQUIRES: a recording of this scenario, with a row.
Metrics measure(const Scenario& scenario, const Recording& recording);

/// The metrics with what they are made from.
struct Evaluation {
  Metrics metrics;                    ///< of the whole run
  std::vector<LyapunovRow> lyapunov;  ///< one for every row of a formation; else empty
  std::vector<StuckReport> stuck;     ///< one for every robot that stopped elsewhere
};

/// `measure`, `lyapunov_along` and `explain_stuck` in one pass, nothing computed twice.
Evaluation evaluate(const Scenario& scenario, const Recording& recording);

/// Runs without recorded decisions have clearances for at most this many robots: with more, measuring them would take
/// longer than the run.
inline constexpr std::size_t kMostClearances = 2000;

/// The same for a run as it is made, in memory that does not grow with the run: takes its rows, or, where decisions are
/// not recorded, its states (crowd_run.h). For states nothing is measured that needs half-planes: margins between
/// robots, `active_set_switches`, `uncertified_half_planes`; and clearances and collisions for at most
/// `kMostClearances` robots.
class Evaluator : public RunSink {
 public:
  /// Called once per row, in order, when the next row or the end is known. `lyapunov` holds the values at that row, and
  /// is null without a formation. If it throws, the exception is passed on and the evaluator is unusable.
  using TakeRow = std::function<void(const Step& row, const LyapunovRow* lyapunov)>;

  /// Reads from `run`: motion, time_step, tracking_gain, relative_frame, offsets. `scenario` must outlive the
  /// evaluator.
  Evaluator(const Scenario& scenario, const Recording& run, TakeRow take_row = {});
  /// Measures states and hands them on to `next`, if there is one. `scenario` and `next` must outlive it.
  explicit Evaluator(const Scenario& scenario, RunSink* next = nullptr);
  ~Evaluator() override;

  /// REQUIRES: not null, and an evaluator of rows.
  void add(std::shared_ptr<const Step> row);
  /// Once, after the last row. Reads from `run`: outcome, diverged, warnings, wall_time, offsets, time_step, bodies,
  /// liveness, routes.
  /// `lyapunov` of the result is empty. REQUIRES: a row.
  Evaluation finish(const Recording& run);

  /// REQUIRES: an evaluator of states.
  void add_state(const RunState& now) override;
  void save(std::ostream& to) override;
  /// Throws CrowdError (bad_snapshot).
  void restore(const RunState& now, std::istream& from) override;
  /// After the last state. REQUIRES: a state.
  Metrics finish(const RunReport& report, std::vector<std::string> warnings) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A gap below this share of the margin breaks the margin. The share is below 1 because robots approach the margin ever
/// more slowly.
inline constexpr double kMarginKept = 0.99;

/// m. A clearance below `-kContactDepth` is a contact. Certified clearances are too low by at most 4 * 2^-46 of the
/// coordinates, which is less than this within 10 km of the origin; robots exactly at contact distance are therefore
/// not reported.
inline constexpr double kContactDepth = 1e-9;

/// Whether a clearance is a contact. An empty one, from a scene without anything to touch, is not.
bool touched(const std::optional<double>& clearance);
/// An obstacle or another robot was touched, by the swept clearances.
bool touched(const Metrics& metrics);

/// m and m/s: a formation has formed if its final position (or velocity) error is below this.
inline constexpr double kFormed = 1e-6;

/// Proven: every swept clearance is above 0 and every half-plane was certified. This is stricter than
/// `!touched`, which ignores overlaps that rounding could explain.
bool is_safe(const Metrics& metrics);

/// A detour that is worth a word in the outcome of a formation: longer than 1 m and than this share of the direct way.
inline constexpr double kLongDetour = 0.25;

/// `Recording::diverged` for a run that ends with the last row: a robot that still moves, or whose leader does,
/// ends farther from its slot than any began, or the state left every bound. A robot that rests elsewhere while the
/// leader rests is stuck (stuck.h), not diverged. REQUIRES: a row.
bool has_diverged(const Recording& recording);

/// "obstacle", "moving obstacle" or "robot".
const char* name(CollisionKind kind);

/// One series per robot or pair, sampled at the recording's rows, for figures. Obstacles include moving ones.
std::vector<double> obstacle_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot);
/// m: rim to rim of two robots, at the rows.
std::vector<double> robot_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot_a,
                                          std::size_t robot_b);
/// m: the robot's distance from its slot, at the rows. REQUIRES: a formation.
std::vector<double> formation_error_series(const Scenario& scenario, const Recording& recording, std::size_t robot);

}  // namespace exactvo::formation
