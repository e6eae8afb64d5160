// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/disc_obstacle.h"

#include <algorithm>
#include <utility>

#include "control/lyapunov_accumulator.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/formation/stuck.h"
#include "exactvo/formation/waiting.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "metrics/clearances.h"
#include "metrics/divergence.h"
#include "metrics/metrics_accumulator.h"
#include "scene/borrowed_row.h"
#include "scene/number_text.h"

namespace exactvo::formation {
namespace {

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

/// Of a scenario whose robots may start in overlap: such pairs have not collided. Each is said.
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

/// How a run ended, from its measurements and from what the run says: collisions first, so that nothing sounds like
/// success where it was none; long detours of a formation last.
std::string outcome_words(const Metrics& m, const std::string& end) {
  return detail::collision_words(m) + end + of_detours(m);
}

}  // namespace

struct Evaluator::Parts {
  Parts(const Scenario& s, const Recording& r, TakeRow take)
      : scenario(s), run(beginning_of(r)), take_row(std::move(take)), clearances(s, run), measures(s, run), stuck(s) {
    if (s.formation) lyapunov.emplace(s, run);
  }

  void settle(const std::optional<LyapunovRow>& values) {
    if (take_row && last) take_row(*last, values ? &*values : nullptr);
  }

  const Scenario& scenario;
  const Recording run;
  TakeRow take_row;
  detail::ClearanceSweep clearances;
  detail::MetricsAccumulator measures;
  StuckWatch stuck;
  std::optional<detail::LyapunovAccumulator> lyapunov;
  std::shared_ptr<const Step> last;
};

Evaluator::Evaluator(const Scenario& scenario, const Recording& run, TakeRow take_row)
    : parts_(std::make_unique<Parts>(scenario, run, std::move(take_row))) {}
Evaluator::~Evaluator() = default;

void Evaluator::add(std::shared_ptr<const Step> row) {
  parts_->clearances.add(*row);
  parts_->measures.add(*row);
  parts_->stuck.add(row);
  std::optional<LyapunovRow> before;
  if (parts_->lyapunov) before = parts_->lyapunov->add(row);
  parts_->settle(before);
  parts_->last = std::move(row);
}

Evaluation Evaluator::finish(const Recording& run) {
  EXACTVO_REQUIRE(parts_->last != nullptr, "an empty recording");
  std::optional<LyapunovRow> last;
  if (parts_->lyapunov) last = parts_->lyapunov->last();
  parts_->settle(last);
  Evaluation found;
  found.stuck = parts_->stuck.reports(run);
  Metrics& m = found.metrics;
  for (const Robot& r : parts_->scenario.robots) m.robots.emplace_back().id = r.id;
  parts_->measures.write_to(m);
  detail::write_clearances(parts_->clearances.result(), m);
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
  const std::vector<std::size_t> deadlock = parts_->stuck.deadlock(run);
  for (const std::size_t robot : deadlock) m.deadlock.push_back(parts_->scenario.robots[robot].id);
  m.outcome =
      outcome_words(m, run.outcome + (deadlock.empty() ? "" : "; " + deadlock_words(parts_->scenario, deadlock)));
  return found;
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

std::vector<double> obstacle_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot) {
  std::vector<double> series;
  for (const Step& row : recording.steps) {
    double least = geometry::kInfinity;
    const Vec2 place = row.robots[robot].position;
    for (const SceneObstacle& o : scenario.obstacles) least = std::min(least, signed_distance(o, place));
    for (const MovingObstacle& o : scenario.moving_obstacles)
      least = std::min(least, signed_distance(o, place - displacement_at(o, row.time)));
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
  for (const Step& row : recording.steps) series.push_back(detail::slot_error(row, recording.offsets, robot));
  return series;
}

}  // namespace exactvo::formation
