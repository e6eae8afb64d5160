// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/planned_routes.h"

#include <optional>
#include <utility>

#include "steering/goals.h"
#include "steering/guide.h"

namespace exactvo::formation {

std::vector<PlannedRoute> planned_routes(const Scenario& scenario, const SimulationOptions& options) {
  std::vector<PlannedRoute> routes;
  std::optional<detail::Guide> guide = detail::guide_for(scenario, options);
  if (!guide) return routes;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const Robot& robot = scenario.robots[i];
    Vec2 from = robot.position;
    for (std::size_t goal = 0; goal < robot.goals.size(); ++goal) {
      detail::CourseAnswer answer =
          guide->course(robot.radius, from, {robot.goals[goal], detail::reach_of(scenario, robot, goal)});
      PlannedRoute& route = routes.emplace_back(PlannedRoute{i, goal, {}, {}, {}});
      if (answer.course) route.points = std::move(answer.course->points);
      if (!answer.course || answer.nearest) {
        route.why_not = answer.defect.empty() ? answer.why_not : answer.defect;
        if (answer.defect.empty()) route.chain = guide->reachability().chain(robot.radius, from, robot.goals[goal]);
        break;  // a robot that cannot reach a goal goes on to no other
      }
      from = route.points.back();
    }
  }
  return routes;
}

}  // namespace exactvo::formation
