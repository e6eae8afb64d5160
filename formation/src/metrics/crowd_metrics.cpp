// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/crowd_metrics.h"

#include <algorithm>
#include <istream>
#include <optional>
#include <ostream>
#include <sstream>
#include <utility>

#include "metrics/clearances.h"
#include "metrics/robot_course.h"
#include "scene/goals.h"
#include "scene/number_text.h"
#include "snapshot_bytes.h"

namespace exactvo::formation {

namespace {

using crowd::SnapshotReader;
using crowd::SnapshotWriter;

Recording straight_run(const Scenario& scenario) {
  Recording run;
  run.motion = MotionLaw::straight;
  run.time_step = scenario.time_step;
  return run;
}

/// By robot: why it is not at its goal; empty where it is, or nothing is known.
std::vector<std::string> reasons(const Scenario& scenario, const RunReport& report) {
  std::vector<std::string> by_robot(scenario.robots.size());
  for (const auto* robots : {&report.without_route, &report.goal_taken, &report.route_cut})
    for (const RobotNotThere& r : *robots) by_robot[r.robot] = r.why;
  return by_robot;
}

/// Of a robot that is not at its goal.
std::string where_words(const Robot& spec, const detail::RobotCourse& course) {
  const double speed = norm(course.velocity);
  const bool rests = !(speed > detail::RobotCourse::kLeastHeadway * spec.max_speed);
  return "is " + detail::metres(norm(course.position - spec.goals.back())) + " from its goal, " +
         (rests ? "at rest" : "still moving at " + detail::number_text(speed, 3) + " m/s");
}

}  // namespace

struct CrowdEvaluator::Parts {
  Parts(const Scenario& s, RunSink* n) : scenario(s), run(straight_run(s)), next(n), robots(s.robots.size()) {
    if (robots.size() <= kMostClearances) clearances.emplace(s, run);
  }

  void add(const RunState& now) {
    const std::vector<Vec2>&position = now.positions, &velocity = now.velocities;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const Robot& spec = scenario.robots[i];
      if (now.steps > 0)
        robots[i].move_to(position[i], velocity[i], scenario.time_step,
                          detail::RobotCourse::kLeastHeadway * spec.max_speed);
      else
        robots[i].position = position[i], robots[i].velocity = velocity[i];
      robots[i].arrive(spec, scenario.arrival_tolerance, now.time, position[i]);
    }
    if (!clearances) return;
    detail::RowState row;
    row.time = now.time;
    row.robots.reserve(robots.size());
    for (std::size_t i = 0; i < robots.size(); ++i) row.robots.push_back({position[i], velocity[i], false});
    clearances->add(std::move(row));
  }

  const Scenario& scenario;
  const Recording run;
  RunSink* next;
  std::vector<detail::RobotCourse> robots;
  std::optional<detail::ClearanceSweep> clearances;
};

CrowdEvaluator::CrowdEvaluator(const Scenario& scenario, RunSink* next)
    : parts_(std::make_unique<Parts>(scenario, next)) {}
CrowdEvaluator::~CrowdEvaluator() = default;

void CrowdEvaluator::add_state(const RunState& now) {
  parts_->add(now);
  if (parts_->next) parts_->next->add_state(now);
}

void CrowdEvaluator::save(std::ostream& to) {
  std::ostringstream own, next;
  SnapshotWriter of_own(own);
  of_own.put(parts_->robots.size());
  for (detail::RobotCourse& r : parts_->robots) r.fields(of_own);
  if (parts_->clearances) parts_->clearances->put(of_own);
  if (parts_->next) parts_->next->save(next);
  SnapshotWriter whole(to);
  whole.fields(own.str(), next.str());
  whole.finish();
}

void CrowdEvaluator::restore(const RunState& now, std::istream& from) {
  const std::string expected = "those of a run of this scenario and these options";
  SnapshotReader whole(from, expected);
  std::istringstream own(whole.get<std::string>()), next(whole.get<std::string>());
  whole.finish();
  SnapshotReader of_own(own, expected);
  if (of_own.get<std::size_t>() != parts_->robots.size()) crowd::refuse_snapshot("another number of robots", expected);
  for (detail::RobotCourse& r : parts_->robots) r.fields(of_own);
  if (parts_->clearances) parts_->clearances->get(of_own);
  if (parts_->next) parts_->next->restore(now, next);
}

Metrics CrowdEvaluator::finish(const RunReport& report, std::vector<std::string> warnings) const {
  const Scenario& scenario = parts_->scenario;
  Metrics m;
  m.crowd = report;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const detail::RobotCourse& course = parts_->robots[i];
    RobotMetrics& robot = m.robots.emplace_back();
    robot.id = scenario.robots[i].id;
    robot.arrival_time = course.arrival();
    robot.arrived = robot.arrival_time.has_value();
    course.write_to(robot, m);
    if (robot.arrived) robot.detour = std::max(0.0, robot.path_length - detail::way_to_goals(scenario.robots[i]));
  }
  detail::write_arrivals_of_run(m);
  m.not_measured.push_back(
      "margins between robots, half-planes that bind or are not certified: decisions are not recorded");
  if (parts_->clearances)
    detail::write_clearances(parts_->clearances->result(), m);
  else
    m.not_measured.push_back("clearances and collisions: more than " + std::to_string(kMostClearances) +
                             " robots; audit judges the recording");
  m.relaxed_steps = report.relaxed;
  m.steps = report.steps;
  m.time = report.time;
  m.wall_time = report.wall_time;
  m.warnings = std::move(warnings);
  const std::vector<std::string> why = reasons(scenario, report);
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    if (m.robots[i].arrived) continue;
    const std::string& id = scenario.robots[i].id;
    m.stuck.push_back(id + " " + (why[i].empty() ? where_words(scenario.robots[i], parts_->robots[i]) : why[i]));
  }
  m.outcome = detail::collision_words(m) + report.outcome;
  return m;
}

}  // namespace exactvo::formation
