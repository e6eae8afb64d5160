// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "exactvo/formation/speed_profile.h"
#include "exactvo/formation/stuck.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/require.h"
#include "leader.h"
#include "motion.h"

namespace exactvo::formation {
namespace {

using detail::Motion;
using geometry::norm;
using geometry::Segment;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Motion motion_of(const Recording& recording, std::size_t step, std::size_t robot) {
  const RobotStep& from = recording.steps[step].robots[robot];
  const RobotStep& to = recording.steps[step + 1].robots[robot];
  return {recording.motion, recording.time_step, recording.tracking_gain, from.position, from.velocity,
          to.position,      to.velocity};
}

double largest(Vec2 v) {
  return std::max(std::fabs(v.x), std::fabs(v.y));
}
double largest(const Segment& s) {
  return std::max(largest(s.a), largest(s.b));
}

/// The greatest coordinate of the scene's obstacles.
double largest_coordinate(const Scenario& scenario) {
  double most = 0.0;
  for (const SceneObstacle& o : scenario.obstacles)
    for (Vec2 p : geometry::vertices_of(o.shape)) most = std::max(most, largest(p));
  for (const MovingObstacle& o : scenario.moving_obstacles)
    for (Vec2 p : geometry::vertices_of(o.shape)) most = std::max(most, largest(p));
  return most;
}

/// m: what a swept clearance may be off by. The distance's own bound, and as much again for the chords' ends, the
/// displacement, the sagitta and the radii: fewer than 64 roundings of at most the coordinates between them, and the
/// bound is 128 units of them.
double rounding(double scene, const Segment& chord, double others) {
  return 2.0 * geometry::rounding_of_distance(std::max(scene, largest(chord)) + others);
}

/// The least clearance of one robot over one step, certified against the chord's error and all roundings.
double swept_obstacle_clearance(const Scenario& scenario, double scene, const Motion& motion, double radius) {
  double least = kInfinity;
  motion.for_each_chord([&](const Segment& chord, double sagitta) {
    const double off = sagitta + rounding(scene, chord, radius + motion.reach());
    for (const SceneObstacle& o : scenario.obstacles)
      least = std::min(least, geometry::swept_distance(o.shape, chord) - off - radius);
  });
  return least;
}

double swept_robot_clearance(const Motion& a, const Motion& b, double radii) {
  double least = kInfinity;
  detail::for_each_chord_pair(a, b, [&](const Segment& chord_a, const Segment& chord_b, double sagitta) {
    const double off = sagitta + rounding(largest(chord_a), chord_b, radii + a.reach() + b.reach());
    least = std::min(least, geometry::swept_distance(chord_a, chord_b) - off - radii);
  });
  return least;
}

/// The same against what moves: by definition straight and uniformly from where it is at one row to the next.
double swept_moving_clearance(const Scenario& scenario, double scene, const Motion& motion, double time,
                              double radius) {
  double least = kInfinity;
  for (const MovingObstacle& o : scenario.moving_obstacles) {
    const Vec2 before = displacement_at(o, time), after = displacement_at(o, time + motion.duration);
    motion.for_each_chord_in_time([&](const Segment& chord, double from, double to, double sagitta) {
      const Segment seen{chord.a - before - from * (after - before), chord.b - before - to * (after - before)};
      const double off = sagitta + rounding(scene + largest(chord), seen, radius + motion.reach());
      least = std::min(least, geometry::swept_distance(o.shape, seen) - off - radius);
    });
  }
  return least;
}

double swept_clearance(const Scenario& scenario, double scene, const Recording& recording, std::size_t step,
                       std::size_t robot) {
  const Motion motion = motion_of(recording, step, robot);
  const double radius = scenario.robots[robot].radius;
  return std::min(swept_obstacle_clearance(scenario, scene, motion, radius),
                  swept_moving_clearance(scenario, scene, motion, recording.steps[step].time, radius));
}

void measure_obstacles(const Scenario& scenario, const Recording& recording, Metrics& m) {
  if (scenario.obstacles.empty() && scenario.moving_obstacles.empty()) return;
  double least = kInfinity;
  const double scene = largest_coordinate(scenario);
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    double mine = kInfinity;
    for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k)
      mine = std::min(mine, swept_clearance(scenario, scene, recording, k, i));
    if (!std::isfinite(mine)) continue;
    m.robots[i].min_obstacle_clearance = mine;
    least = std::min(least, mine);
  }
  if (std::isfinite(least)) m.min_obstacle_clearance = least;
}

/// A step of every robot, with how far it gets from where it starts.
struct Moved {
  Motion motion;
  double strays;  ///< m
};
std::vector<Moved> motions_of(const Scenario& scenario, const Recording& recording, std::size_t step) {
  std::vector<Moved> all;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const Motion motion = motion_of(recording, step, i);
    all.push_back({motion, norm(motion.to - motion.from) + motion.sagitta_of(1)});
  }
  return all;
}

/// Pairs that stay farther apart than the least so far are passed over: twice their ways would not bring them nearer.
void lower_by_step(const Scenario& scenario, const std::vector<Moved>& all, double& least) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const double radii = scenario.robots[i].radius + scenario.robots[j].radius;
      const double apart = norm(all[i].motion.from - all[j].motion.from) - radii;
      if (apart > least + 2.0 * (all[i].strays + all[j].strays)) continue;
      least = std::min(least, swept_robot_clearance(all[i].motion, all[j].motion, radii));
    }
  }
}

void measure_robots(const Scenario& scenario, const Recording& recording, Metrics& m) {
  double least = kInfinity;
  for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k)
    lower_by_step(scenario, motions_of(scenario, recording, k), least);
  if (std::isfinite(least)) m.min_robot_clearance = least;
}

void measure_paths(const Recording& recording, Metrics& m) {
  for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k)
    for (std::size_t i = 0; i < m.robots.size(); ++i)
      m.robots[i].path_length +=
          norm(recording.steps[k + 1].robots[i].position - recording.steps[k].robots[i].position);
}

/// The first row from which `error` stays within `tolerance` to the end.
template <typename Error>
std::optional<double> settled_since(const Recording& recording, double tolerance, const Error& error) {
  std::optional<double> since;
  for (std::size_t k = recording.steps.size(); k-- > 0;) {
    if (!(error(k) <= tolerance)) break;
    since = recording.steps[k].time;
  }
  return since;
}

double slot_error(const Recording& recording, std::size_t k, std::size_t i) {
  const Step& row = recording.steps[k];
  return norm(row.robots[i].position - row.leader_position - recording.offsets[i]);
}

/// The row from which a kinematic robot heads for its last goal: the run passes at most one goal on the way a row,
/// within the tolerance or the robot's radius.
std::size_t last_leg_since(const Scenario& scenario, const Recording& recording, std::size_t i) {
  const Robot& spec = scenario.robots[i];
  const double reach = std::max(scenario.arrival_tolerance, spec.radius);
  std::size_t goal = 0;
  std::size_t k = 0;
  for (; k < recording.steps.size() && goal + 1 < spec.goals.size(); ++k)
    if (norm(recording.steps[k].robots[i].position - spec.goals[goal]) <= reach) ++goal;
  return goal + 1 < spec.goals.size() ? recording.steps.size() : k;
}

void measure_arrival(const Scenario& scenario, const Recording& recording, Metrics& m) {
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    const std::size_t last_leg = scenario.formation ? 0 : last_leg_since(scenario, recording, i);
    const auto error = [&](std::size_t k) {
      if (k < last_leg) return kInfinity;
      return scenario.formation ? slot_error(recording, k, i)
                                : norm(recording.steps[k].robots[i].position - scenario.robots[i].goals.back());
    };
    m.robots[i].arrival_time = settled_since(recording, scenario.arrival_tolerance, error);
    if (m.leader_arrival_time && m.robots[i].arrival_time)
      m.robots[i].arrival_time = std::max(*m.robots[i].arrival_time, *m.leader_arrival_time);
    m.robots[i].arrived =
        m.robots[i].arrival_time.has_value() && (!scenario.formation || m.leader_arrival_time.has_value());
    if (!m.robots[i].arrived) m.robots[i].arrival_time.reset();
  }
  m.all_arrived = std::all_of(m.robots.begin(), m.robots.end(), [](const auto& r) { return r.arrived; });
  if (!m.all_arrived) return;
  m.last_arrival_time = 0.0;
  for (const RobotMetrics& r : m.robots) m.last_arrival_time = std::max(*m.last_arrival_time, *r.arrival_time);
}

void measure_formation(const Scenario& scenario, const Recording& recording, Metrics& m) {
  if (!scenario.formation) return;
  const double arrival = detail::leader_arrival(scenario.formation->leader);
  const Step& last = recording.steps.back();
  if (arrival <= last.time) m.leader_arrival_time = arrival;
  double position = 0.0, velocity = 0.0;
  for (std::size_t i = 0; i < last.robots.size(); ++i) {
    position = std::max(position, slot_error(recording, recording.steps.size() - 1, i));
    velocity = std::max(velocity, norm(last.robots[i].velocity - last.leader_velocity));
  }
  m.formation_position_error = position;
  m.formation_velocity_error = velocity;
}

Vec2 acceleration(const Recording& recording, std::size_t k, std::size_t i) {
  return (recording.steps[k + 1].robots[i].velocity - recording.steps[k].robots[i].velocity) / recording.time_step;
}

/// rad: smaller turns have no sign worth counting.
constexpr double kLeastTurn = 1e-3;

std::size_t reversals_of(const Recording& recording, std::size_t i) {
  std::size_t reversals = 0;
  double last_turn = 0.0;
  for (std::size_t k = 1; k < recording.steps.size(); ++k) {
    const Vec2 a = recording.steps[k - 1].robots[i].velocity;
    const Vec2 b = recording.steps[k].robots[i].velocity;
    const double turn = std::atan2(cross(a, b), dot(a, b));
    if (std::fabs(turn) < kLeastTurn) {
      last_turn = 0.0;
      continue;
    }
    if (turn * last_turn < 0.0) ++reversals;
    last_turn = turn;
  }
  return reversals;
}

/// What binds, whatever the order.
using ActiveSet = std::vector<std::tuple<ConstraintSource, std::size_t, std::size_t>>;
ActiveSet active_set(const RobotStep& step) {
  ActiveSet active;
  for (const RecordedConstraint& c : step.constraints)
    if (c.active) active.emplace_back(c.source, c.index, c.piece);
  std::sort(active.begin(), active.end());
  return active;
}

void measure_jitter(const Recording& recording, Metrics& m) {
  const std::size_t rows = recording.steps.size();
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    for (std::size_t k = 0; k + 2 < rows; ++k)
      m.jitter += norm(acceleration(recording, k + 1, i) - acceleration(recording, k, i));
    for (std::size_t k = 0; k + 1 < rows; ++k) {
      const double a = norm(acceleration(recording, k, i));
      m.peak_acceleration = std::max(m.peak_acceleration, a);
      m.velocity_variation += a * recording.time_step;
    }
    m.heading_reversals += reversals_of(recording, i);
    for (std::size_t k = 1; k + 1 < rows; ++k)
      if (active_set(recording.steps[k].robots[i]) != active_set(recording.steps[k - 1].robots[i]))
        ++m.active_set_switches;
  }
}

void count_decisions(const Recording& recording, Metrics& m) {
  for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k) {
    for (const RobotStep& r : recording.steps[k].robots) {
      if (r.status != lp::Status::optimal) ++m.relaxed_steps;
      m.uncertified_half_planes += r.uncertified;
    }
  }
  m.steps = recording.steps.size() - 1;
}

/// Who stopped elsewhere, a sentence each.
std::vector<std::string> stuck_words(const Scenario& scenario, const Recording& recording) {
  std::vector<std::string> words;
  for (const StuckReport& report : explain_stuck(scenario, recording)) words.push_back(report.text);
  return words;
}

}  // namespace

Metrics measure(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(!recording.steps.empty(), "an empty recording");
  Metrics m;
  for (const Robot& r : scenario.robots) m.robots.push_back({r.id, false, std::nullopt, 0.0, std::nullopt});
  measure_formation(scenario, recording, m);
  measure_arrival(scenario, recording, m);
  measure_obstacles(scenario, recording, m);
  measure_robots(scenario, recording, m);
  measure_paths(recording, m);
  measure_jitter(recording, m);
  count_decisions(recording, m);
  m.wall_time = recording.wall_time;
  m.outcome = recording.outcome;
  m.warnings = recording.warnings;
  m.stuck = stuck_words(scenario, recording);
  if (scenario.formation) m.lyapunov = summary_of(lyapunov_along(scenario, recording), recording);
  return m;
}

bool touched(const std::optional<double>& clearance) {
  return clearance && !(*clearance >= -kContactDepth);
}

bool touched(const Metrics& m) {
  return touched(m.min_obstacle_clearance) || touched(m.min_robot_clearance);
}

bool is_safe(const Metrics& m) {
  const auto clear = [](const std::optional<double>& clearance) { return !clearance || *clearance > 0.0; };
  return clear(m.min_obstacle_clearance) && clear(m.min_robot_clearance) && m.uncertified_half_planes == 0;
}

std::vector<double> obstacle_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot) {
  std::vector<double> series;
  for (const Step& row : recording.steps) {
    double least = kInfinity;
    for (const SceneObstacle& o : scenario.obstacles)
      least = std::min(least, geometry::signed_distance(o.shape, row.robots[robot].position));
    series.push_back(least - scenario.robots[robot].radius);
  }
  return series;
}

std::vector<double> robot_distance_series(const Scenario& scenario, const Recording& recording, std::size_t a,
                                          std::size_t b) {
  std::vector<double> series;
  const double radii = scenario.robots[a].radius + scenario.robots[b].radius;
  for (const Step& row : recording.steps)
    series.push_back(norm(row.robots[a].position - row.robots[b].position) - radii);
  return series;
}

std::vector<double> formation_error_series(const Scenario& scenario, const Recording& recording, std::size_t robot) {
  EXACTVO_REQUIRE(scenario.formation.has_value(), "a scenario without a formation");
  std::vector<double> series;
  for (std::size_t k = 0; k < recording.steps.size(); ++k) series.push_back(slot_error(recording, k, robot));
  return series;
}

}  // namespace exactvo::formation
