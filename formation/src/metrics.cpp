// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "clearances.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/formation/stuck.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/require.h"
#include "leader.h"
#include "outcome_words.h"

namespace exactvo::formation {
namespace {

using geometry::norm;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void measure_clearances(const Scenario& scenario, const Recording& recording, Metrics& m) {
  detail::ClearanceSweep sweep(scenario, recording);
  for (const Step& row : recording.steps) sweep.add(row);
  detail::Clearances clearances = sweep.result();
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    const std::optional<double>& mine = clearances.to_obstacles[i];
    m.robots[i].min_obstacle_clearance = mine;
    if (mine) m.min_obstacle_clearance = std::min(*mine, m.min_obstacle_clearance.value_or(kInfinity));
  }
  m.min_robot_clearance = clearances.between_robots;
  m.collisions = std::move(clearances.collisions);
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

/// Whom the formation lost, and since when it holds.
void measure_course(const Scenario& scenario, const Recording& recording, Metrics& m) {
  if (!scenario.formation) return;
  FormationCourse& course = m.formation_course.emplace();
  const auto worst = [&](std::size_t k) {
    double error = 0.0;
    for (std::size_t i = 0; i < m.robots.size(); ++i) error = std::max(error, slot_error(recording, k, i));
    return error;
  };
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    double& mine = m.robots[i].largest_slot_error.emplace(0.0);
    for (std::size_t k = 1; k < recording.steps.size(); ++k) {
      const double error = slot_error(recording, k, i);
      mine = std::max(mine, error);
      if (!(error > course.largest_error)) continue;
      course.largest_error = error;
      course.largest_error_at = recording.steps[k].time;
      course.largest_error_of = m.robots[i].id;
    }
  }
  for (std::size_t k = 0; k < recording.steps.size() && !course.first_formed; ++k)
    if (worst(k) <= scenario.arrival_tolerance) course.first_formed = recording.steps[k].time;
  course.formed_since = settled_since(recording, scenario.arrival_tolerance, worst);
}

/// m: from a robot's start to its goals, or to its slot and on with the leader.
double direct_way(const Scenario& scenario, const Recording& recording, std::size_t i) {
  if (scenario.formation) {
    double way = slot_error(recording, 0, i);
    for (std::size_t k = 1; k < recording.steps.size(); ++k)
      way += norm(recording.steps[k].leader_position - recording.steps[k - 1].leader_position);
    return way;
  }
  double way = 0.0;
  Vec2 here = scenario.robots[i].position;
  for (Vec2 goal : scenario.robots[i].goals) {
    way += norm(goal - here);
    here = goal;
  }
  return way;
}

void measure_detours(const Scenario& scenario, const Recording& recording, Metrics& m) {
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    if (!scenario.formation && !m.robots[i].arrived) continue;
    m.robots[i].detour = std::max(0.0, m.robots[i].path_length - direct_way(scenario, recording, i));
  }
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

}  // namespace

Metrics measure(const Scenario& scenario, const Recording& recording) {
  return evaluate(scenario, recording).metrics;
}

Evaluation evaluate(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(!recording.steps.empty(), "an empty recording");
  Evaluation found;
  found.stuck = explain_stuck(scenario, recording);
  if (scenario.formation) found.lyapunov = lyapunov_along(scenario, recording);
  Metrics& m = found.metrics;
  for (const Robot& r : scenario.robots) m.robots.emplace_back().id = r.id;
  measure_formation(scenario, recording, m);
  measure_arrival(scenario, recording, m);
  measure_clearances(scenario, recording, m);
  measure_paths(recording, m);
  measure_course(scenario, recording, m);
  measure_detours(scenario, recording, m);
  measure_jitter(recording, m);
  count_decisions(recording, m);
  m.wall_time = recording.wall_time;
  m.warnings = recording.warnings;
  for (const StuckReport& report : found.stuck) m.stuck.push_back(report.text);
  if (scenario.formation) m.lyapunov = summary_of(found.lyapunov, recording);
  m.outcome = detail::outcome_words(m, recording.outcome);
  return found;
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
    const Vec2 place = row.robots[robot].position;
    for (const SceneObstacle& o : scenario.obstacles)
      least = std::min(least, geometry::signed_distance(o.shape, place));
    for (const MovingObstacle& o : scenario.moving_obstacles)
      least = std::min(least, geometry::signed_distance(o.shape, place - displacement_at(o, row.time)));
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
