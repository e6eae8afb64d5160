// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/stuck.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "exactvo/formation/balance.h"
#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/waiting.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "motion/leader.h"
#include "scene/borrowed_row.h"
#include "traps/boundary.h"

namespace exactvo::formation {
namespace {

/// How a run ended.
struct RunEnd {
  const Scenario& scenario;
  const Recording& run;  ///< without its rows
  const Step& last;
  const Step* decided;  ///< the row of the last decisions: the last row has none. Null where none were taken
  WaitForGraph waits;   ///< of that row
};

bool is_at_rest(const Scenario& scenario, std::size_t robot, double speed) {
  return speed < kAtRestShare * scenario.robots[robot].max_speed;
}

bool is_at_rest(const RunEnd& end, const StuckReport& r) {
  return is_at_rest(end.scenario, r.robot, r.speed);
}

Vec2 target_of(const RunEnd& end, std::size_t i) {
  if (!end.scenario.formation) return end.scenario.robots[i].goals.back();
  return end.last.leader_position + end.run.offsets[i];
}

bool is_static(const DecisionConstraint& c) {
  return c.source == ConstraintSource::enclosure || c.source == ConstraintSource::obstacle_edge;
}

// --- What blocks ---

BindingConstraint binding_of(const DecisionConstraint& c, const SeenBody& seen, Vec2 robot) {
  const vo::VelocityObstacle vo(seen.shape, robot, seen.radius, c.time_horizon > 0.0 ? c.time_horizon : 1.0);
  const vo::VelocityObstacle::Nearest nearest = vo.nearest();
  const double rho = detail::Boundary(seen.shape, seen.radius).radius_of_curvature(nearest.normal);
  return {c, nearest.normal, nearest.distance, rho};
}

/// What is active in the decision, and which of it pushes: by the recorded multipliers, beside which those of the speed
/// bound stand. All of it where the decision was a compromise between half-planes that contradict each other.
std::vector<BindingConstraint> binding_in(const RunEnd& end, std::size_t robot) {
  const RobotStep& decision = end.decided->robots[robot];
  const Balance balance = balance_of(decision);
  const double least = kLeastShare * norm(decision.chosen - decision.preferred);
  std::vector<BindingConstraint> binding;
  for (std::size_t i = 0; i < decision.constraints.size(); ++i) {
    const DecisionConstraint& c = decision.constraints[i];
    if (!c.active) continue;
    const SeenBody seen = seen_body(end.scenario, end.run.bodies, *end.decided, robot, c);
    BindingConstraint& b = binding.emplace_back(binding_of(c, seen, end.last.robots[robot].position));
    const double factor = balance.factor_of(i);
    b.pressing = decision.status != lp::Status::optimal || (factor > 0.0 && factor >= least);
  }
  return binding;
}

std::vector<DecisionConstraint> pressing_of(const StuckReport& r) {
  std::vector<DecisionConstraint> out;
  for (const BindingConstraint& b : r.binding)
    if (b.pressing) out.push_back(b.constraint);
  return out;
}

/// rad: the way to the goal counts as normal to the boundary within this angle. A robot that has nearly come to rest on
/// a flat trap still creeps towards its foot; the tie-break keeps it about 1e-3 off.
constexpr double kHeadOn = 0.05;
/// m: a robot is at a boundary within this distance; farther off the half-plane only slows it down.
constexpr double kAtBoundary = 0.1;

std::optional<Equilibrium> equilibrium_at(const BindingConstraint& b, Vec2 robot, Vec2 target) {
  const Vec2 ahead = geometry::normalized(target - robot);
  if (!is_static(b.constraint) || b.clearance > kAtBoundary) return std::nullopt;
  if (dot(ahead, b.normal) >= 0.0 || std::fabs(cross(ahead, b.normal)) > kHeadOn) return std::nullopt;
  Equilibrium e;
  e.position = robot;
  e.normal = b.normal;
  e.radius_of_curvature = b.radius_of_curvature;
  e.distance = norm(target - robot);
  e.stable = e.distance < e.radius_of_curvature;
  return e;
}

std::optional<Equilibrium> equilibrium_of(const StuckReport& r, Vec2 target) {
  const BindingConstraint* only = nullptr;
  for (const BindingConstraint& b : r.binding) {
    if (!b.pressing) continue;
    if (only) return std::nullopt;
    only = &b;
  }
  return only ? equilibrium_at(*only, r.position, target) : std::nullopt;
}

// --- Words ---

std::string printed(const char* format, double a, double b = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::string length(double x) {
  return std::isfinite(x) ? printed("%.3g m", x) : "infinite (a flat edge)";
}

std::string motion_words(const RunEnd& run, const StuckReport& r) {
  const std::string speed = printed("%.2g m/s", r.speed);
  if (is_at_rest(run, r))
    return "at rest" + (r.rest_time > 0.0 ? printed(" for %.3g s", r.rest_time) : "") + " (" + speed + ")";
  const double end = run.last.time;
  const bool ran_out = end + 0.5 * run.run.time_step >= run.scenario.time_limit;
  return ran_out ? "still moving when time ran out (" + speed + ")"
                 : printed("moving at %.4g s", end) + " (" + speed + ")";
}

std::string curvature_words(const Equilibrium& e) {
  return "(the goal lies straight behind the boundary, whose radius of curvature there is " +
         length(e.radius_of_curvature) + (e.stable ? ", more" : ", less") + " than the distance to the goal)";
}

std::string equilibrium_words(const RunEnd& end, const StuckReport& r) {
  const bool rests = is_at_rest(end, r);
  const Equilibrium& e = *r.equilibrium;
  if (e.stable) return (rests ? ": a stable trap " : ", heading into a stable trap ") + curvature_words(e);
  return (rests ? ": an unstable equilibrium " : ", sliding off an unstable equilibrium ") + curvature_words(e);
}

/// What the one robot that is in the way does itself.
std::string other_words(const RunEnd& end, const DecisionConstraint& by) {
  const RobotStep& other = end.last.robots.at(by.index);
  if (norm(target_of(end, by.index) - other.position) <= end.scenario.arrival_tolerance)
    return end.scenario.formation ? ", which is at its slot" : ", which is at its goal";
  return is_at_rest(end.scenario, by.index, norm(other.velocity)) ? ", which is at rest" : ", which is moving";
}

/// The robots it waits for, or what the one robot does that presses and waits for none; else the equilibrium.
std::string beyond_what_presses(const RunEnd& end, const StuckReport& r, const std::vector<DecisionConstraint>& by) {
  const bool is_one_robot = by.size() == 1 && by.front().source == ConstraintSource::robot;
  const bool waits = !end.waits.empty() && !end.waits[r.robot].empty();
  if (waits && !(is_one_robot && end.waits[end.waits[r.robot].front()].empty()))
    return "; " + waiting_words(end.scenario, *end.decided, end.waits, r.robot);
  if (is_one_robot && (waits || is_at_rest(end, r))) return other_words(end, by.front());
  return r.equilibrium ? equilibrium_words(end, r) : "";
}

std::string moving_words(const RunEnd& end, const RobotStep& decision, const StuckReport& r) {
  const std::vector<DecisionConstraint> by = pressing_of(r);
  if (decision.mode == Mode::following) {
    std::vector<DecisionConstraint> all;
    for (const BindingConstraint& b : r.binding) all.push_back(b.constraint);
    return all.empty() ? "following a boundary"
                       : "following the boundary of " + name_of(all, end.scenario, end.run.bodies);
  }
  if (by.empty()) return "no active constraint changes its velocity";
  return "its velocity is limited by " + name_of(by, end.scenario, end.run.bodies) + beyond_what_presses(end, r, by);
}

std::string cause_words(const RunEnd& end, const StuckReport& r) {
  if (!end.decided) return "no decision was taken";
  const RobotStep* decision = &end.decided->robots[r.robot];
  if (decision->mode == Mode::staying)
    return (is_at_rest(end, r) ? "it stays, since " : "it stops, since ") +
           why_it_stays(end.scenario, *end.decided, r.robot);
  std::string text;
  if (meets_movers(end.scenario) && decision->stopping_steps == 0) {
    text = "it stands, since a moving obstacle could reach it while it moves";
  } else if (!is_at_rest(end, r)) {
    text = r.binding.empty() && decision->mode != Mode::following ? "no active constraint"
                                                                  : moving_words(end, *decision, r);
  } else if (r.binding.empty()) {
    text = "no active constraint";
  } else if (pressing_of(r).empty()) {
    text = "no active constraint changes its velocity";
  } else {
    const std::vector<DecisionConstraint> by = pressing_of(r);
    const bool walls = by.size() > 1 && std::all_of(by.begin(), by.end(), is_static);
    text = (walls ? "blocked between " : "blocked by ") + name_of(by, end.scenario, end.run.bodies) +
           beyond_what_presses(end, r, by);
  }
  if (decision->status != lp::Status::optimal && decision->violation > 0.0)
    text += printed("; the half-planes contradict each other by %.2g m/s", decision->violation);
  if (decision->mode == Mode::pushing_out) text += "; it is in contact with an obstacle";
  if (decision->mode == Mode::by_plan) text += "; it goes by a joint plan";
  if (decision->mode == Mode::going_back) text += "; it goes back to where a joint plan begins";
  return text;
}

std::string sentence(const RunEnd& end, const StuckReport& r) {
  return end.scenario.robots[r.robot].id + " is " + length(r.goal_distance) +
         (end.scenario.formation ? " from its slot" : " from its goal") +
         printed(", at (%.3f, %.3f), ", r.position.x, r.position.y) + motion_words(end, r) + "; " + cause_words(end, r);
}

/// Whether standing elsewhere means anything.
bool is_settled(const RunEnd& end) {
  if (!end.scenario.formation) return true;
  return !end.run.diverged && detail::leader_arrival(end.scenario.formation->leader) <= end.last.time;
}

StuckReport report_on(const RunEnd& end, std::size_t robot, std::optional<double> at_rest_since, Vec2 target) {
  const RobotStep& state = end.last.robots[robot];
  StuckReport r;
  r.robot = robot;
  r.position = state.position;
  r.goal_distance = norm(target - state.position);
  r.speed = norm(state.velocity);
  if (at_rest_since) r.rest_time = end.last.time - *at_rest_since;
  if (end.decided) r.binding = binding_in(end, robot);
  r.equilibrium = equilibrium_of(r, target);
  r.text = sentence(end, r);
  return r;
}

}  // namespace

void StuckWatch::add(std::shared_ptr<const Step> row) {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    OfRobot& r = robots_[i];
    if (!is_at_rest(scenario_, i, norm(row->robots[i].velocity))) {
      r.at_rest_since.reset();
    } else if (!r.at_rest_since) {
      r.at_rest_since = row->time;
    }
    if (scenario_.formation) continue;
    const double distance = norm(scenario_.robots[i].goals.back() - row->robots[i].position);
    if (!(distance < r.nearest)) continue;
    r.nearest = distance;
    r.nearest_at = row->time;
  }
  decided_ = std::move(last_);
  last_ = std::move(row);
}

std::vector<StuckReport> StuckWatch::reports(const Recording& run) const {
  EXACTVO_REQUIRE(last_ != nullptr, "an empty recording");
  const RunEnd end{scenario_, run, *last_, decided_.get(),
                   decided_ ? waiting_in(scenario_, *decided_) : WaitForGraph{}};
  std::vector<StuckReport> reports;
  if (!is_settled(end)) return reports;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const Vec2 target = target_of(end, i);
    if (norm(target - last_->robots[i].position) <= scenario_.arrival_tolerance) continue;
    const OfRobot& before = robots_[i];
    StuckReport& r = reports.emplace_back(report_on(end, i, before.at_rest_since, target));
    if (!is_at_rest(end, r) && before.nearest < r.goal_distance)
      r.text += printed("; it was nearest at %.4g s, ", before.nearest_at) + length(before.nearest) + " away";
  }
  return reports;
}

std::vector<std::size_t> StuckWatch::deadlock(const Recording& run) const {
  if (!decided_) return {};
  const RunEnd end{scenario_, run, *last_, decided_.get(), waiting_in(scenario_, *decided_)};
  const auto stands_elsewhere = [&](std::size_t i) {
    const RobotStep& r = last_->robots[i];
    return is_at_rest(scenario_, i, norm(r.velocity)) &&
           norm(target_of(end, i) - r.position) > scenario_.arrival_tolerance;
  };
  for (std::vector<std::size_t>& cycle : deadlocks_in(end.waits))
    if (std::all_of(cycle.begin(), cycle.end(), stands_elsewhere)) return std::move(cycle);
  return {};
}

std::vector<StuckReport> explain_stuck(const Scenario& scenario, const Recording& recording) {
  StuckWatch watch(scenario);
  for (const Step& row : recording.steps) watch.add(detail::borrowed(row));
  return watch.reports(recording);
}

}  // namespace exactvo::formation
