// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/disc_obstacle.h"

#include <algorithm>
#include <istream>
#include <ostream>
#include <sstream>
#include <utility>

#include "control/lyapunov_accumulator.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/formation/stability.h"
#include "exactvo/formation/waiting.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "metrics/clearances.h"
#include "metrics/divergence.h"
#include "metrics/metrics_accumulator.h"
#include "scene/borrowed_row.h"
#include "scene/number_text.h"
#include "snapshot_bytes.h"

namespace exactvo::formation {
namespace {

using crowd::SnapshotReader;
using crowd::SnapshotWriter;

/// What is known of a run before its first row.
Recording beginning_of(const Recording& run) {
  Recording known;
  known.motion = run.motion;
  known.time_step = run.time_step;
  known.tracking_gain = run.tracking_gain;
  known.relative_frame = run.relative_frame;
  known.offsets = run.offsets;
  known.controller_options = run.controller_options;
  return known;
}

Recording straight_run(const Scenario& scenario) {
  Recording run;
  run.motion = MotionLaw::straight;
  run.time_step = scenario.time_step;
  return run;
}

std::string of_detours(const Metrics& m) {
  if (!m.formation_course) return "";
  std::string text;
  for (const RobotMetrics& r : m.robots) {
    const double detour = r.detour.value_or(0.0);
    if (!(detour > 1.0 && detour > kLongDetour * (r.path_length - detour))) continue;
    text += "; " + r.id + " went a detour of " + detail::number_text(detour, 3) + " m, up to " +
            detail::number_text(r.largest_slot_error.value_or(0.0), 3) + " m from its slot";
  }
  if (!text.empty() && m.formation_course->formed_since)
    text += "; the formation holds since " + detail::number_text(*m.formation_course->formed_since, 3) + " s";
  return text;
}

/// Where robots may start in overlap, such pairs have not collided: each gets a warning instead.
void tell_starts(const Scenario& scenario, Metrics& m) {
  if (!scenario.separate) return;
  constexpr double kRounding = 1e-9;  // m
  const auto robot = [&](const std::string& id) -> const Robot& {
    return *std::find_if(scenario.robots.begin(), scenario.robots.end(), [&](const Robot& r) { return r.id == id; });
  };
  // What grew deeper after the start is a collision.
  const auto starts = [&](const Collision& c) {
    if (c.kind != CollisionKind::robot || c.from != 0.0) return false;
    const Robot &a = robot(c.robot), &b = robot(c.with);
    return c.depth <= a.radius + b.radius - norm(a.position - b.position) + kRounding;
  };
  for (const Collision& c : m.collisions)
    if (starts(c))
      m.warnings.push_back(c.robot + " and " + c.with + " started in overlap, by " + detail::metres(c.depth) +
                           ", and were apart from " + detail::number_text(c.until, 4) + " s on");
  m.collisions.erase(std::remove_if(m.collisions.begin(), m.collisions.end(), starts), m.collisions.end());
}

/// Says where a robot is that is not at its goal.
std::string where_words(const Robot& spec, const detail::RobotCourse& course) {
  const double speed = norm(course.velocity);
  const bool rests = !(speed > detail::RobotCourse::kLeastHeadway * spec.max_speed);
  return "is " + detail::metres(norm(course.position - spec.goals.back())) + " from its goal, " +
         (rests ? "at rest" : "still moving at " + detail::number_text(speed, 3) + " m/s");
}

}  // namespace

struct Evaluator::Parts {
  Parts(const Scenario& s, Recording r) : scenario(s), run(std::move(r)), measures(s, run) {}

  void settle(const std::optional<LyapunovRow>& values) {
    if (take_row && last) take_row(*last, values ? &*values : nullptr);
  }

  Metrics begin() const {
    Metrics m;
    for (const Robot& r : scenario.robots) m.robots.emplace_back().id = r.id;
    measures.write_to(m);
    if (clearances) detail::write_clearances(clearances->result(), m);
    return m;
  }

  const Scenario& scenario;
  const Recording run;
  detail::MetricsAccumulator measures;
  std::optional<detail::ClearanceSweep> clearances;
  // For rows.
  TakeRow take_row;
  std::optional<StuckWatch> stuck;
  std::optional<detail::LyapunovAccumulator> lyapunov;
  std::shared_ptr<const Step> last;
  // For states.
  RunSink* next = nullptr;
};

Evaluator::Evaluator(const Scenario& scenario, const Recording& run, TakeRow take_row)
    : parts_(std::make_unique<Parts>(scenario, beginning_of(run))) {
  parts_->take_row = std::move(take_row);
  parts_->clearances.emplace(scenario, parts_->run);
  parts_->stuck.emplace(scenario);
  if (tracks_choices(scenario)) parts_->lyapunov.emplace(scenario, parts_->run);
}

Evaluator::Evaluator(const Scenario& scenario, RunSink* next)
    : parts_(std::make_unique<Parts>(scenario, straight_run(scenario))) {
  parts_->next = next;
  if (scenario.robots.size() <= kMostClearances) parts_->clearances.emplace(scenario, parts_->run);
}

Evaluator::~Evaluator() = default;

void Evaluator::add(std::shared_ptr<const Step> row) {
  parts_->clearances->add(*row);
  parts_->measures.add(*row);
  parts_->stuck->add(row);
  std::optional<LyapunovRow> before;
  if (parts_->lyapunov) before = parts_->lyapunov->add(row);
  parts_->settle(before);
  parts_->last = std::move(row);
}

void Evaluator::add_state(const RunState& now) {
  parts_->measures.add(now.time, now.positions, now.velocities);
  if (parts_->clearances) {
    detail::RowState row{now.time, {}};
    for (std::size_t i = 0; i < now.positions.size(); ++i)
      row.robots.push_back({now.positions[i], now.velocities[i], false});
    parts_->clearances->add(std::move(row));
  }
  if (parts_->next) parts_->next->add_state(now);
}

void Evaluator::save(std::ostream& to) {
  std::ostringstream own, next;
  SnapshotWriter of_own(own);
  of_own.put(parts_->scenario.robots.size());
  parts_->measures.fields(of_own);
  if (parts_->clearances) parts_->clearances->put(of_own);
  if (parts_->next) parts_->next->save(next);
  SnapshotWriter whole(to);
  whole.fields(own.str(), next.str());
  whole.finish();
}

void Evaluator::restore(const RunState& now, std::istream& from) {
  const std::string expected = "those of a run of this scenario and these options";
  SnapshotReader whole(from, expected);
  std::istringstream own(whole.get<std::string>()), next(whole.get<std::string>());
  whole.finish();
  SnapshotReader of_own(own, expected);
  if (of_own.get<std::size_t>() != parts_->scenario.robots.size())
    crowd::refuse_snapshot("another number of robots", expected);
  parts_->measures.fields(of_own);
  if (parts_->clearances) parts_->clearances->get(of_own);
  if (parts_->next) parts_->next->restore(now, next);
}

Evaluation Evaluator::finish(const Recording& run) {
  EXACTVO_REQUIRE(parts_->last != nullptr, "an empty recording");
  std::optional<LyapunovRow> last;
  if (parts_->lyapunov) last = parts_->lyapunov->last();
  parts_->settle(last);
  Evaluation found;
  found.stuck = parts_->stuck->reports(run);
  Metrics& m = found.metrics = parts_->begin();
  if (run.liveness)
    static_cast<LivenessCourse&>(*m.plans) = *run.liveness;
  else
    m.plans.reset();
  m.routes = run.routes;
  m.wall_time = run.wall_time;
  m.warnings = run.warnings;
  tell_starts(parts_->scenario, m);
  for (const StuckReport& report : found.stuck) m.stuck.push_back(report.text);
  if (parts_->lyapunov) m.lyapunov = parts_->lyapunov->summary();
  const std::vector<std::size_t> deadlock = parts_->stuck->deadlock(run);
  for (const std::size_t robot : deadlock) m.deadlock.push_back(parts_->scenario.robots[robot].id);
  // Collisions first, so that nothing sounds like success where it was none; long detours of a formation last.
  m.outcome = detail::collision_words(m) + run.outcome +
              (deadlock.empty() ? "" : "; " + deadlock_words(parts_->scenario, deadlock)) + of_detours(m);
  return found;
}

Metrics Evaluator::finish(const RunReport& report, std::vector<std::string> warnings) const {
  const std::vector<Robot>& robots = parts_->scenario.robots;
  Metrics m = parts_->begin();
  m.crowd = report;
  m.relaxed_steps = report.relaxed;
  m.wall_time = report.wall_time;
  m.warnings = std::move(warnings);
  m.not_measured.emplace_back(
      "margins between robots, half-planes that bind or are not certified: decisions are not recorded");
  if (!parts_->clearances)
    m.not_measured.push_back("clearances and collisions: more than " + std::to_string(kMostClearances) +
                             " robots; audit judges the recording");
  std::vector<std::string> why(robots.size());
  for (const auto* not_there : {&report.without_route, &report.goal_taken, &report.route_cut})
    for (const RobotNotThere& r : *not_there) why[r.robot] = r.why;
  for (std::size_t i = 0; i < robots.size(); ++i)
    if (!m.robots[i].arrived)
      m.stuck.push_back(robots[i].id + " " +
                        (why[i].empty() ? where_words(robots[i], parts_->measures.course(i)) : why[i]));
  m.outcome = detail::collision_words(m) + report.outcome;
  return m;
}

Metrics measure(const Scenario& scenario, const Recording& recording) {
  return evaluate(scenario, recording).metrics;
}

Evaluation evaluate(const Scenario& scenario, const Recording& recording) {
  std::vector<LyapunovRow> lyapunov;
  Evaluator evaluator(scenario, recording, [&](const Step&, const LyapunovRow* values) {
    if (values) lyapunov.push_back(*values);
  });
  for (const Step& row : recording.steps) evaluator.add(detail::borrowed(row));
  Evaluation found = evaluator.finish(recording);
  found.lyapunov = std::move(lyapunov);
  return found;
}

const char* name(CollisionKind kind) {
  constexpr const char* kNames[] = {"obstacle", "moving obstacle", "robot"};
  return kNames[static_cast<int>(kind)];
}

bool has_diverged(const Recording& recording) {
  EXACTVO_REQUIRE(!recording.steps.empty(), "an empty recording");
  if (recording.offsets.empty()) return false;
  const Step &first = recording.steps.front(), &last = recording.steps.back();
  const bool is_out = std::any_of(last.robots.begin(), last.robots.end(),
                                  [](const RobotStep& r) { return detail::is_out_of_bounds(r.position, r.velocity); });
  return is_out || detail::has_diverged(detail::formation_error(first, recording.offsets),
                                        detail::error_of_moving(last, recording.offsets, recording.time_step));
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

namespace {

/// The discs of a robot that keep clear of obstacles: the chain of its footprint, or the one about its place. Without a
/// heading, only the first disc of a chain is known.
std::vector<geometry::Disc> obstacle_discs(const Robot& robot, const RobotStep& now) {
  std::vector<geometry::Disc> discs{{now.position, obstacle_radius(robot)}};
  if (robot.drive && now.wheels)
    for (std::size_t link = 1; link < robot.drive->chain.size(); ++link)
      discs.push_back(link_at(*robot.drive, link, now.position, now.wheels->heading));
  return discs;
}

}  // namespace

std::vector<double> obstacle_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot) {
  std::vector<double> series;
  for (const Step& row : recording.steps) {
    double least = geometry::kInfinity;
    for (const geometry::Disc& disc : obstacle_discs(scenario.robots[robot], row.robots[robot])) {
      for (const SceneObstacle& o : scenario.obstacles)
        least = std::min(least, signed_distance(o, disc.center) - disc.radius);
      for (const MovingObstacle& o : scenario.moving_obstacles)
        least = std::min(least, signed_distance(o, disc.center - displacement_at(o, row.time)) - disc.radius);
    }
    series.push_back(least);
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
  for (const Step& row : recording.steps) series.push_back(detail::slot_error(row, recording.offsets, robot));
  return series;
}

}  // namespace exactvo::formation
