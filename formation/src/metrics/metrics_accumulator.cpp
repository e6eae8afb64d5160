// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics_accumulator.h"

#include "metrics/divergence.h"
#include "scene/goals.h"
#include "scene/near_pairs.h"

namespace exactvo::formation::detail {

MetricsAccumulator::MetricsAccumulator(const Scenario& scenario, const Recording& run)
    : scenario_(scenario), run_(run), robots_(scenario.robots.size()) {}

void MetricsAccumulator::add(double time, const std::vector<Vec2>& positions, const std::vector<Vec2>& velocities) {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    add_state(i, positions[i], velocities[i]);
    add_arrival(i, time);
  }
  time_ = time;
  ++rows_;
}

void MetricsAccumulator::add_state(std::size_t robot, Vec2 position, Vec2 velocity) {
  OfRobot& r = robots_[robot];
  const double at_rest = RobotCourse::kLeastHeadway * scenario_.robots[robot].max_speed;
  if (rows_ > 0) r.move_to(position, velocity, run_.time_step, at_rest);
  r.position = position;
  r.velocity = velocity;
}

void MetricsAccumulator::add(const Step& row) {
  has_decisions_ = true;
  counted_.relaxed += of_last_row_.relaxed;
  counted_.uncertified += of_last_row_.uncertified;
  counted_.switches += of_last_row_.switches;
  of_last_row_ = {};
  const auto any = [&](Mode mode) {
    return std::any_of(row.robots.begin(), row.robots.end(), [&](const RobotStep& r) { return r.mode == mode; });
  };
  rows_by_plan_ += any(Mode::by_plan);
  rows_back_ += any(Mode::going_back);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    OfRobot& r = robots_[i];
    const RobotStep& step = row.robots[i];
    if (scenario_.formation)
      r.direct_way += rows_ == 0 ? slot_error(row, run_.offsets, i) : norm(row.leader_position - leader_.position);
    add_state(i, step.position, step.velocity);
    add_decision(r, step);
    if (scenario_.formation)
      r.settled.add(row.time, slot_error(row, run_.offsets, i), scenario_.arrival_tolerance);
    else
      add_arrival(i, row.time);
  }
  if (scenario_.formation) add_to_course(row);
  add_margins(row);
  leader_ = {row.leader_position, row.leader_velocity};
  time_ = row.time;
  ++rows_;
}

MetricsAccumulator::ActiveSet MetricsAccumulator::active_set(const RobotStep& step) {
  ActiveSet active;
  for (const DecisionConstraint& c : step.constraints)
    if (c.active) active.emplace_back(c.source, c.index, c.piece);
  std::sort(active.begin(), active.end());
  return active;
}

void MetricsAccumulator::add_decision(OfRobot& r, const RobotStep& step) {
  if (bodies_gave(step)) ++of_last_row_.relaxed;
  of_last_row_.uncertified += step.uncertified;
  ActiveSet active = active_set(step);
  if (rows_ > 0 && active != r.active) ++of_last_row_.switches;
  r.active = std::move(active);
}

void MetricsAccumulator::add_arrival(std::size_t robot, double time) {
  robots_[robot].arrive(scenario_.robots[robot], scenario_.arrival_tolerance, time, robots_[robot].position);
}

void MetricsAccumulator::add_to_course(const Step& row) {
  double worst = 0.0;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const double error = slot_error(row, run_.offsets, i);
    worst = std::max(worst, error);
    if (rows_ > 0) sum_of_squared_errors_ += error * error;
    if (rows_ == 0 || !(error > robots_[i].largest_slot_error)) continue;
    robots_[i].largest_slot_error = error;
    robots_[i].largest_slot_error_at = row.time;
  }
  if (!first_formed_ && worst <= scenario_.arrival_tolerance) first_formed_ = row.time;
  formed_rows_ += rows_ > 0 && worst <= scenario_.arrival_tolerance;
  formed_.add(row.time, worst, scenario_.arrival_tolerance);
  error_ = worst;
}

/// m; 0 of a formation whose controller keeps none.
double MetricsAccumulator::asked_margin() const {
  const bool has_none = run_.controller_options && !run_.controller_options->margins;
  return has_none ? 0.0 : scenario_.margins.robot;
}

void MetricsAccumulator::add_margins(const Step& row) {
  const double kept = kMarginKept * asked_margin();
  if (!(kept > 0.0) || robots_.size() < 2) return;
  places_.clear();
  for (const RobotStep& r : row.robots) places_.push_back(r.position);
  for_each_near_pair(places_, 2.0 * largest_radius(scenario_.robots) + kept, [&](std::size_t i, std::size_t j) {
    const double radii = scenario_.robots[i].radius + scenario_.robots[j].radius;
    if (!(norm(places_[i] - places_[j]) - radii < kept)) return;
    ++pair_rows_within_margin_;
    robots_[i].was_within_margin = robots_[j].was_within_margin = true;
  });
}

void MetricsAccumulator::write_to(Metrics& m) const {
  if (scenario_.formation) write_formation(m);
  write_arrivals(m);
  for (std::size_t i = 0; i < robots_.size(); ++i) robots_[i].write_to(m.robots[i], m);
  if (scenario_.formation) write_course(m);
  write_detours(m);
  m.steps = rows_ - 1;
  m.time = time_;
  if (!has_decisions_) return;
  m.plans.emplace();
  m.plans->time_by_plan = static_cast<double>(rows_by_plan_) * run_.time_step;
  m.plans->time_back = static_cast<double>(rows_back_) * run_.time_step;
  if (asked_margin() > 0.0 && robots_.size() > 1) {
    const auto nearer =
        std::count_if(robots_.begin(), robots_.end(), [](const OfRobot& r) { return r.was_within_margin; });
    m.robot_margin = {asked_margin(), pair_rows_within_margin_, static_cast<std::size_t>(nearer)};
  }
  m.relaxed_steps = counted_.relaxed;
  m.uncertified_half_planes = counted_.uncertified;
  m.active_set_switches = counted_.switches;
}

void MetricsAccumulator::write_formation(Metrics& m) const {
  const double arrival = leader_arrival(scenario_.formation->leader);
  if (arrival <= time_) m.leader_arrival_time = arrival;
  double velocity = 0.0;
  for (const OfRobot& r : robots_) velocity = std::max(velocity, norm(r.velocity - leader_.velocity));
  m.formation_position_error = error_;
  m.formation_velocity_error = velocity;
}

void MetricsAccumulator::write_arrivals(Metrics& m) const {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    RobotMetrics& out = m.robots[i];
    out.arrival_time = robots_[i].arrival();
    if (m.leader_arrival_time && out.arrival_time)
      out.arrival_time = std::max(*out.arrival_time, *m.leader_arrival_time);
    out.arrived = out.arrival_time.has_value() && (!scenario_.formation || m.leader_arrival_time.has_value());
    if (!out.arrived) out.arrival_time.reset();
  }
  std::vector<double> times;
  for (const RobotMetrics& r : m.robots)
    if (r.arrived) times.push_back(*r.arrival_time);
  std::sort(times.begin(), times.end());
  m.arrived = times.size();
  m.all_arrived = times.size() == m.robots.size();
  if (2 * times.size() > m.robots.size()) m.median_arrival_time = times[m.robots.size() / 2];
  if (m.all_arrived) m.last_arrival_time = times.empty() ? 0.0 : times.back();
}

/// The robots that the formation lost, and since when it holds.
void MetricsAccumulator::write_course(Metrics& m) const {
  FormationCourse& course = m.formation_course.emplace();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const OfRobot& r = robots_[i];
    m.robots[i].largest_slot_error = r.largest_slot_error;
    if (!(r.largest_slot_error > course.largest_error)) continue;
    course.largest_error = r.largest_slot_error;
    course.largest_error_at = r.largest_slot_error_at;
    course.largest_error_of = m.robots[i].id;
  }
  course.first_formed = first_formed_;
  course.formed_since = formed_.since();
  if (rows_ < 2) return;
  const double rows = static_cast<double>(rows_ - 1);
  course.share_formed = static_cast<double>(formed_rows_) / rows;
  course.rms_error = std::sqrt(sum_of_squared_errors_ / (rows * static_cast<double>(robots_.size())));
}

void MetricsAccumulator::write_detours(Metrics& m) const {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (!scenario_.formation && !m.robots[i].arrived) continue;
    m.robots[i].detour = std::max(0.0, m.robots[i].path_length - direct_way(i));
  }
}

/// m: from a robot's start to its goals, or to its slot and on with the leader.
double MetricsAccumulator::direct_way(std::size_t robot) const {
  return scenario_.formation ? robots_[robot].direct_way : way_to_goals(scenario_.robots[robot]);
}

}  // namespace exactvo::formation::detail
