// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The metrics of a run that rows add up to: paths, arrivals, a formation's course, jitter, counts. Rounded.

#include <optional>
#include <tuple>
#include <vector>

#include "exactvo/formation/metrics.h"
#include "metrics/robot_course.h"
#include "motion/leader.h"

namespace exactvo::formation::detail {

/// Takes the rows of a run one after the other, and keeps of them what the next one needs.
class MetricsAccumulator {
 public:
  /// Of `run` what is known before the first row: time step, offsets. Both must outlive it.
  MetricsAccumulator(const Scenario& scenario, const Recording& run);
  void add(const Step& row);
  /// A row without decisions, of robots with goals. Margins between robots are not measured then.
  void add(double time, const std::vector<Vec2>& positions, const std::vector<Vec2>& velocities);
  /// Of the rows so far, at least one. Writes paths, arrivals, errors, the formation's course, jitter and counts into
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
