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

RunOutline::Places places_in(const Step& row) {
  RunOutline::Places seen{row.time, {}};
  seen.robots.reserve(row.robots.size());
  for (const RobotStep& r : row.robots) seen.robots.push_back({r.position, r.velocity, r.mode});
  return seen;
}

std::string obstruction_beside_rows(const RecordingFile& run) {
  const formation::Recording& recording = run.recording;
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

}  // namespace

void walk(const EachRow& each, const std::function<void(const RowInRun& at)>& judge) {
  SharedRow before, row;
  std::size_t number = 0;
  const auto go_on = [&](SharedRow next) {
    if (row) judge({number++, *row, before.get(), next.get()});
    before = std::exchange(row, std::move(next));
  };
  each(go_on);
  go_on(nullptr);
}

std::string obstruction_of(const RecordingFile& run, const RunOutline& outline) {
  std::string why = obstruction_beside_rows(run);
  if (why.empty()) why = outline.obstruction;
  for (const formation::JointPlan& plan : run.recording.plans)
    if (why.empty()) why = obstruction_in(plan, outline.rows);
  return why.empty() && outline.rows == 0 ? "there are no rows" : why;
}

void RunOutline::add(const Step& row) {
  if (obstruction.empty()) obstruction = obstruction_in(row);
  before_last = std::move(last);
  last = places_in(row);
  if (rows++ == 0) first = last;
  latest = std::max(latest, row.time);
}

PlacesInRows::PlacesInRows(const RecordingFile& run, const RunOutline& outline)
    : time_step_(run.recording.time_step), rows_(outline.rows) {
  for (const formation::Outlook& outlook : run.recording.outlooks)
    if (const auto row = row_of(outlook)) places_[{*row, outlook.robot}];
  for (const formation::JointPlan& plan : run.recording.plans)
    for (const std::size_t robot : plan.robots) places_[{plan.from_row, robot}];
}

std::optional<std::size_t> PlacesInRows::row_of(const formation::Outlook& outlook) const {
  const double row = std::round(outlook.time / time_step_);
  if (!(row >= 0.0) || !(row < static_cast<double>(rows_))) return std::nullopt;
  return static_cast<std::size_t>(row);
}

void PlacesInRows::take(std::size_t number, const Step& row) {
  for (auto at = places_.lower_bound({number, 0}); at != places_.end() && at->first.first == number; ++at)
    at->second = {row.time, row.robots[at->first.second].position, row.robots[at->first.second].anchor};
}

const PlacesInRows::Place* PlacesInRows::of_outlook(const formation::Outlook& outlook) const {
  const auto row = row_of(outlook);
  return row ? of(*row, outlook.robot) : nullptr;
}

const PlacesInRows::Place* PlacesInRows::of(std::size_t row, std::size_t robot) const {
  const auto found = places_.find({row, robot});
  return row < rows_ && found != places_.end() ? &found->second : nullptr;
}

}  // namespace exactvo::datasets
