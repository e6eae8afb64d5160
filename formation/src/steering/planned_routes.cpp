// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/planned_routes.h"

#include "scene/goals.h"
#include "steering/guide.h"

namespace exactvo::formation {
namespace {

PlannedRoute routed(const Scenario& scenario, std::size_t i, std::size_t goal, Vec2 from, detail::Guide& guide,
                    const detail::CourseAnswer& answer) {
  const Robot& robot = scenario.robots[i];
  PlannedRoute route{i, goal, {}, {}, {}};
  if (answer.course) route.points = answer.course->points;
  if (answer.course && !answer.nearest) return route;
  route.why_not = answer.defect.empty() ? answer.why_not : answer.defect;
  if (answer.defect.empty()) route.chain = guide.reachability().chain(obstacle_radius(robot), from, robot.goals[goal]);
  return route;
}

detail::Destination destination(const Scenario& scenario, std::size_t i, std::size_t goal) {
  const Robot& robot = scenario.robots[i];
  return {robot.goals[goal], detail::reach_of(robot, goal, scenario.arrival_tolerance)};
}

}  // namespace

std::vector<PlannedRoute> planned_routes(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<PlannedRoute> routes;
  std::optional<detail::Guide> guide = detail::guide_for(scenario, options);
  if (!guide) return routes;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const Robot& robot = scenario.robots[i];
    Vec2 from = robot.position;
    for (std::size_t goal = 0; goal < robot.goals.size(); ++goal) {
      const detail::CourseAnswer answer = guide->course(obstacle_radius(robot), from, destination(scenario, i, goal));
      routes.push_back(routed(scenario, i, goal, from, *guide, answer));
      if (!routes.back().why_not.empty()) break;  // a robot that cannot reach a goal goes on to no other
      from = routes.back().points.back();
    }
  }
  return routes;
}

std::optional<RouteAhead> route_ahead(const Scenario& scenario, const SimulationOptions& options, std::size_t robot,
                                      std::size_t goal, Vec2 position) {
  std::optional<detail::Guide> guide = detail::guide_for(scenario, options);
  if (!guide) return std::nullopt;
  const double radius = obstacle_radius(scenario.robots[robot]);
  detail::CourseAnswer answer = guide->course(radius, position, destination(scenario, robot, goal));
  RouteAhead ahead{routed(scenario, robot, goal, position, *guide, answer)};
  if (!answer.course) return ahead;
  ahead.heads_for = guide->heading(*answer.course, radius, position).place;
  for (std::size_t k = 1; k < ahead.route.points.size(); ++k)
    ahead.length += geometry::norm(ahead.route.points[k] - ahead.route.points[k - 1]);
  return ahead;
}

}  // namespace exactvo::formation
