// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/audit_rows.h"

#include <algorithm>
#include <cmath>

#include "exactvo/datasets/obstacle_file.h"

namespace exactvo::datasets {
namespace {

using formation::RobotStep;
using formation::Step;
using geometry::Vec2;

bool is_in_range(Vec2 v) {
  return std::fabs(v.x) <= kLargestCoordinate && std::fabs(v.y) <= kLargestCoordinate;
}

}  // namespace

std::string obstruction_in(const RecordingFile& beginning) {
  const formation::Recording& recording = beginning.recording;
  const bool is_exponential = recording.motion == formation::MotionLaw::exponential;
  if (!(recording.time_step > 0.0) || !std::isfinite(recording.time_step)) return "the time step is not above 0";
  if (is_exponential && (!(recording.tracking_gain > 0.0) || !std::isfinite(recording.tracking_gain)))
    return "the tracking gain is not above 0";
  return recording.time_step > kLargestCoordinate ? "the time step is out of range" : "";
}

std::string obstruction_in(const Step& row) {
  if (!(std::fabs(row.time) <= kLargestCoordinate)) return "a row's time is not finite, or out of range";
  for (const formation::MovedObstacle& moved : row.moving)
    if (!is_in_range(moved.displacement) || !is_in_range(moved.velocity))
      return "the position or velocity of a moving obstacle is not finite, or out of range";
  for (const RobotStep& robot : row.robots) {
    if (!is_in_range(robot.position)) return "a robot's position is not finite, or out of range";
    if (!is_in_range(robot.velocity)) return "a robot's velocity is not finite, or out of range";
    if (!is_in_range(robot.anchor) || !is_in_range(robot.anchor_velocity))
      return "where a robot's half-planes are built is not finite, or out of range";
  }
  return "";
}

std::string obstruction_in(const formation::JointPlan& plan, std::size_t rows) {
  if (!std::all_of(plan.starts.begin(), plan.starts.end(), is_in_range) ||
      !std::all_of(plan.moves.begin(), plan.moves.end(),
                   [](const formation::PlanMove& m) { return is_in_range(m.to); }))
    return "a place of a plan is not finite, or out of range";
  return plan.row >= rows ? "a plan is made after the last row" : "";
}

void PlacesInRows::take(const Step& row) {
  const std::size_t robots = row.robots.size(), number = rows_++;
  for (; first_ < number && known_.size() + robots > most_; ++first_)
    known_.erase(known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(robots));
  for (const RobotStep& robot : row.robots) known_.push_back(robot.anchor);
  const formation::Recording& recording = run_.recording;
  for (; goal_bodies_ < recording.goal_bodies.size(); ++goal_bodies_)
    if (const auto begin = row_of(recording.goal_bodies[goal_bodies_]))
      ask_for({*begin, recording.goal_bodies[goal_bodies_].robot});
  for (; plans_ < recording.plans.size(); ++plans_)
    for (const std::size_t robot : recording.plans[plans_].robots) ask_for({recording.plans[plans_].from_row, robot});
  for (auto at = asked_.lower_bound({number, 0}); at != asked_.end() && at->first.first == number; ++at)
    at->second = row.robots[at->first.second].anchor;
}

void PlacesInRows::ask_for(const Key& key) {
  if (key.first < first_) return;
  std::optional<Vec2>& place = asked_[key];
  if (key.first < rows_) place = known_[(key.first - first_) * run_.scenario.robots.size() + key.second];
}

std::optional<std::size_t> PlacesInRows::row_of(const formation::GoalBodies& of_goal) const {
  const double row = std::round(of_goal.time / run_.recording.time_step);
  if (!(row >= 0.0) || !(row < 0x1p53) || row * run_.recording.time_step != of_goal.time) return std::nullopt;
  return static_cast<std::size_t>(row);
}

const Vec2* PlacesInRows::at(const Key& key) const {
  const auto found = asked_.find(key);
  return found != asked_.end() && found->second ? &*found->second : nullptr;
}

const Vec2* PlacesInRows::at_begin(const formation::GoalBodies& of_goal) const {
  const auto row = row_of(of_goal);
  return row ? at({*row, of_goal.robot}) : nullptr;
}

const Vec2* PlacesInRows::at_begin(const formation::JointPlan& plan, std::size_t robot) const {
  return at({plan.from_row, robot});
}

bool PlacesInRows::is_forgotten(const formation::JointPlan& plan, std::size_t robot) const {
  return asked_.count({plan.from_row, robot}) == 0;
}

}  // namespace exactvo::datasets
