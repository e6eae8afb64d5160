// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The metrics of a run that rows add up to: paths, arrivals, a formation's course, jitter, counts. Rounded.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "exactvo/formation/metrics.h"
#include "motion/leader.h"

namespace exactvo::formation::detail {

/// Since when an error stays within a tolerance.
class SettledSince {
 public:
  void add(double time, double error, double tolerance) {
    if (!(error <= tolerance)) {
      since_.reset();
    } else if (!since_) {
      since_ = time;
    }
  }
  const std::optional<double>& since() const { return since_; }

 private:
  friend struct RobotCourse;
  std::optional<double> since_;
};

/// What the rows of a run add up to for one robot: its path, how unsteadily it moves, when it arrives.
struct RobotCourse {
  /// rad: smaller turns have no sign worth counting.
  static constexpr double kLeastTurn = 1e-3;
  /// A robot slower than this share of its greatest speed rests, and its heading is noise.
  static constexpr double kLeastHeadway = 1e-3;

  Vec2 position, velocity;  ///< in the last row
  std::optional<Vec2> acceleration;
  double path_length = 0.0;
  std::size_t goal = 0;  ///< which it heads for
  SettledSince settled;  ///< at its last goal, with all goals on the way passed, or in its slot
  SettledSince at_last;  ///< at its last goal, whatever was passed
  double jitter = 0.0, velocity_variation = 0.0, peak_acceleration = 0.0;
  double last_turn = 0.0;
  std::size_t reversals = 0;

  /// From the last row to a next one. `at_rest`: m/s, what is slower has no heading.
  void move_to(Vec2 next, Vec2 next_velocity, double time_step, double at_rest) {
    path_length += norm(next - position);
    const Vec2 now = (next_velocity - velocity) / time_step;
    if (acceleration) jitter += norm(now - *acceleration);
    acceleration = now;
    const double size = norm(now);
    peak_acceleration = std::max(peak_acceleration, size);
    velocity_variation += size * time_step;
    add_turn(next_velocity, at_rest);
    position = next;
    velocity = next_velocity;
  }

  /// A robot with goals passes at most one goal on the way a row, within the tolerance or its radius.
  void arrive(const Robot& spec, double tolerance, double time, Vec2 place) {
    const double error = norm(place - spec.goals.back());
    const bool is_on_the_way = goal + 1 < spec.goals.size();
    if (is_on_the_way && norm(place - spec.goals[goal]) <= std::max(tolerance, spec.radius)) ++goal;
    settled.add(time, is_on_the_way ? std::numeric_limits<double>::infinity() : error, tolerance);
    at_last.add(time, error, tolerance);
  }

  /// A robot that came to its last goal and is there at the end has arrived: rows do not show that it passed a taken
  /// goal by resting beside it. Goals on the way matter only for when, but a robot that never left has not passed them.
  std::optional<double> arrival() const {
    if (settled.since()) return settled.since();
    return at_last.since() > 0.0 ? at_last.since() : std::nullopt;
  }

  /// Its path, and what it adds to the run's.
  void write_to(RobotMetrics& robot, Metrics& m) const {
    robot.path_length = path_length;
    m.jitter += jitter;
    m.velocity_variation += velocity_variation;
    m.peak_acceleration = std::max(m.peak_acceleration, peak_acceleration);
    m.heading_reversals += reversals;
  }

  /// For snapshots: the same list of fields both ways.
  template <class Stream>
  void fields(Stream& stream) {
    stream.fields(position, velocity, acceleration, path_length, goal, settled.since_, at_last.since_, jitter,
                  velocity_variation, peak_acceleration, last_turn, reversals);
  }

 private:
  void add_turn(Vec2 next, double at_rest) {
    const double across = cross(velocity, next), along = dot(velocity, next);
    if (std::fabs(across) < 0.5 * kLeastTurn * along) {  // certainly below it, without the arc
      last_turn = 0.0;
      return;
    }
    const double turn = std::atan2(across, along);
    if (std::fabs(turn) < kLeastTurn || !(norm(velocity) > at_rest) || !(norm(next) > at_rest)) {
      last_turn = 0.0;
      return;
    }
    if (turn * last_turn < 0.0) ++reversals;
    last_turn = turn;
  }
};

/// m: from a robot's start straight to its goals.
inline double way_to_goals(const Robot& robot) {
  double way = 0.0;
  Vec2 here = robot.position;
  for (const Vec2 goal : robot.goals) {
    way += norm(goal - here);
    here = goal;
  }
  return way;
}

/// Takes the rows of a run one after the other, and keeps of them what the next one needs.
class MetricsAccumulator {
 public:
  /// Uses what is known of `run` before its first row: time step, offsets. Both must outlive it.
  MetricsAccumulator(const Scenario& scenario, const Recording& run);
  void add(const Step& row);
  /// A row without decisions, of robots with goals. Margins between robots are not measured then.
  void add(double time, const std::vector<Vec2>& positions, const std::vector<Vec2>& velocities);
  /// Writes paths, arrivals, errors, the formation's course, jitter and counts of the rows so far, at least one, into
  /// `m`.
  void write_to(Metrics& m) const;
  /// In the last row. REQUIRES: a row.
  const RobotCourse& course(std::size_t robot) const { return robots_[robot]; }

  /// For snapshots, of rows without decisions: the same list of fields both ways.
  template <class Stream>
  void fields(Stream& stream) {
    stream.fields(rows_, time_);
    for (OfRobot& robot : robots_) robot.fields(stream);
  }

 private:
  /// What binds, whatever the order.
  using ActiveSet = std::vector<std::tuple<ConstraintSource, std::size_t, std::size_t>>;
  static ActiveSet active_set(const RobotStep& step);

  struct OfRobot : RobotCourse {
    double direct_way = 0.0;  ///< m, of a formation: to its slot and on with the leader
    double largest_slot_error = 0.0, largest_slot_error_at = 0.0;
    bool was_within_margin = false;  ///< nearer to another robot than the margin
    ActiveSet active;
  };

  void add_decision(OfRobot& r, const RobotStep& step);
  void add_state(std::size_t robot, Vec2 position, Vec2 velocity);
  void add_arrival(std::size_t robot, double time);
  void add_to_course(const Step& row);
  void add_margins(const Step& row);
  void write_formation(Metrics& m) const;
  void write_arrivals(Metrics& m) const;
  void write_course(Metrics& m) const;
  void write_detours(Metrics& m) const;
  double direct_way(std::size_t robot) const;
  double asked_margin() const;

  /// Counts of decisions. Those of the last row are no decision's, so a row counts when the next one comes.
  struct Counts {
    std::size_t relaxed = 0, uncertified = 0, switches = 0;
  };

  const Scenario& scenario_;
  const Recording& run_;
  std::vector<OfRobot> robots_;
  bool has_decisions_ = false;
  std::size_t rows_ = 0, rows_by_plan_ = 0, rows_back_ = 0;
  Counts counted_, of_last_row_;
  std::vector<Vec2> places_;  ///< memory of `add_margins`
  std::size_t pair_rows_within_margin_ = 0;
  std::optional<double> first_formed_;
  std::size_t formed_rows_ = 0;         ///< from the second row on, as the sum
  double sum_of_squared_errors_ = 0.0;  ///< m2, over robots and rows
  SettledSince formed_;
  // In the last row.
  double time_ = 0.0;   ///< s
  LeaderState leader_;  ///< of a formation
  double error_ = 0.0;  ///< m, of a formation: the largest distance of a robot from its slot
};

}  // namespace exactvo::formation::detail
