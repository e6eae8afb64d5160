// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/stuck.h"

#include <cmath>
#include <cstdio>

#include "boundary.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "leader.h"

namespace exactvo::formation {
namespace {

using geometry::norm;

Vec2 target_of(const Scenario& s, const Recording& recording, std::size_t i) {
  if (!s.formation) return s.robots[i].goals.back();
  return recording.steps.back().leader_position + recording.offsets[i];
}

BindingConstraint binding_of(const RecordedConstraint& c, Vec2 robot) {
  const vo::VelocityObstacle vo(c.shape, robot, c.radius, c.tau > 0.0 ? c.tau : 1.0);
  const vo::VelocityObstacle::Nearest nearest = vo.nearest();
  const double rho = detail::Boundary(c.shape, c.radius).radius_of_curvature(nearest.normal);
  return {c, nearest.normal, nearest.distance, rho};
}

/// rad: the way to the goal counts as normal to the boundary within this angle. A robot that has nearly come to rest on
/// a flat trap still creeps towards its foot; the tie-break keeps it about 1e-3 off.
constexpr double kHeadOn = 0.05;

std::optional<Equilibrium> resting_on(const BindingConstraint& b, Vec2 robot, Vec2 target) {
  const Vec2 ahead = geometry::normalized(target - robot);
  if (dot(ahead, b.normal) >= 0.0 || std::fabs(cross(ahead, b.normal)) > kHeadOn) return std::nullopt;
  Equilibrium e;
  e.position = robot;
  e.normal = b.normal;
  e.radius_of_curvature = b.radius_of_curvature;
  e.distance = norm(target - robot);
  e.stable = e.distance < e.radius_of_curvature;
  return e;
}

std::string printed(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

std::string length(double x) {
  return std::isfinite(x) ? printed("%.3g m", x) : "infinite (a flat edge)";
}

std::string source_text(const Scenario& s, const RecordedConstraint& c) {
  switch (c.source) {
    case ConstraintSource::enclosure:
      return "enclosure " + std::to_string(c.index) + (c.piece > 0 ? ", piece " + std::to_string(c.piece) : "");
    case ConstraintSource::obstacle_edge: {
      const geometry::Segment* edge = std::get_if<geometry::Segment>(&c.shape);
      return edge ? printed("the edge (%.3g, %.3g)", edge->a.x, edge->a.y) +
                        printed("-(%.3g, %.3g)", edge->b.x, edge->b.y)
                  : "edge " + std::to_string(c.index);
    }
    case ConstraintSource::robot:
      return "robot " + s.robots.at(c.index).id;
    case ConstraintSource::moving_obstacle:
      return "moving obstacle " + s.moving_obstacles.at(c.index).id;
  }
  return "";
}

/// m/s: a robot that is slower is said to rest. (Between edges it creeps on by its tie-break.)
constexpr double kAtRest = 0.01;

/// A robot's least distance from its goal, and when that was.
struct Nearest {
  double time = 0.0;      ///< s
  double distance = 0.0;  ///< m
};

/// A slot moves, so that of a formation's robots only the end counts.
Nearest nearest_of(const Scenario& s, const Recording& recording, Vec2 target, const StuckReport& r) {
  Nearest nearest{recording.steps.back().time, r.goal_distance};
  if (s.formation) return nearest;
  for (const Step& step : recording.steps) {
    const double distance = norm(target - step.robots[r.robot].position);
    if (distance < nearest.distance) nearest = {step.time, distance};
  }
  return nearest;
}

/// Of a robot that went away from where it wanted to, as one that circles does.
std::string words_of(const Nearest& nearest, const StuckReport& r) {
  if (r.speed < kAtRest || nearest.distance >= r.goal_distance) return "";
  return printed("; it was nearest at %.4g s, ", nearest.time) + length(nearest.distance) + " away";
}

std::string sentence(const Scenario& s, const StuckReport& r, const Nearest& at) {
  const std::string& id = s.robots[r.robot].id;
  std::string text = id + " is " + length(r.goal_distance) + (s.formation ? " from its slot" : " from its goal") +
                     printed(", at (%.3f, %.3f), moving at %.2g m/s", r.position.x, r.position.y, r.speed) + "; ";
  const std::string nearest = words_of(at, r);
  if (r.binding.empty()) return text + "nothing binds" + (nearest.empty() ? ": it was on its way" : nearest);
  text += "bound by ";
  for (std::size_t k = 0; k < r.binding.size(); ++k)
    text += (k ? " and " : "") + source_text(s, r.binding[k].constraint);
  if (!r.equilibrium) return text + (r.binding.size() > 1 && r.speed < kAtRest ? ", between which it rests" : nearest);
  return text + ": the way there is normal to the boundary, whose radius of curvature is " +
         length(r.equilibrium->radius_of_curvature) +
         (r.equilibrium->stable ? ", more than that distance: a stable trap" : ": unstable, it is sliding off");
}

/// Whether standing elsewhere means anything.
bool is_settled(const Scenario& scenario, const Recording& recording) {
  if (!scenario.formation) return true;
  return !recording.diverged && detail::leader_arrival(scenario.formation->leader) <= recording.steps.back().time;
}

}  // namespace

std::vector<StuckReport> explain_stuck(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(!recording.steps.empty(), "an empty recording");
  std::vector<StuckReport> reports;
  if (!is_settled(scenario, recording)) return reports;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const RobotStep& end = recording.steps.back().robots[i];
    const Vec2 target = target_of(scenario, recording, i);
    StuckReport r;
    r.robot = i;
    r.position = end.position;
    r.goal_distance = norm(target - end.position);
    if (r.goal_distance <= scenario.arrival_tolerance) continue;
    r.speed = norm(end.velocity);
    if (recording.steps.size() > 1)
      for (const RecordedConstraint& c : recording.steps[recording.steps.size() - 2].robots[i].constraints)
        if (c.active) r.binding.push_back(binding_of(c, end.position));
    if (r.binding.size() == 1) r.equilibrium = resting_on(r.binding.front(), end.position, target);
    r.text = sentence(scenario, r, nearest_of(scenario, recording, target, r));
    reports.push_back(std::move(r));
  }
  return reports;
}

}  // namespace exactvo::formation
