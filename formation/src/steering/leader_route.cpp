// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/leader_route.h"

#include <algorithm>
#include <utility>

#include "control/consensus.h"
#include "exactvo/geometry/require.h"
#include "scene/goals.h"
#include "steering/guide.h"

namespace exactvo::formation {
namespace {

/// Where the robots are nearest to their slots.
Vec2 middle_of(const Scenario& scenario, const std::vector<Vec2>& offsets) {
  Vec2 sum;
  for (std::size_t i = 0; i < offsets.size(); ++i) sum += scenario.robots[i].position - offsets[i];
  return sum / static_cast<double>(offsets.size());
}

/// m, about the leader: of a disc that holds every robot in its slot.
double radius_of_formation(const Scenario& scenario, const std::vector<Vec2>& offsets) {
  double radius = 0.0;
  for (std::size_t i = 0; i < offsets.size(); ++i)
    radius = std::max(radius, norm(offsets[i]) + scenario.robots[i].radius);
  return radius;
}

}  // namespace

void plan_leader(Scenario& scenario, const LeaderGoal& goal) {
  EXACTVO_REQUIRE(
      scenario.formation && !scenario.robots.empty() && scenario.formation->offsets.size() == scenario.robots.size(),
      "a formation with an offset for each robot");
  const std::vector<Vec2> offsets =
      detail::offsets_in_use(*scenario.formation, controller_options_of(Controller::standard));
  const Vec2 from = goal.from.value_or(middle_of(scenario, offsets));
  Leader& leader = scenario.formation->leader;
  leader.path = {from, goal.to};  // the map covers both
  leader.why_short.clear();
  leader.note.clear();
  const double whole = radius_of_formation(scenario, offsets), single = detail::largest_radius(scenario.robots);
  detail::Guide guide(scenario, scenario.margins.obstacle, whole);
  const detail::Destination to{goal.to};
  const bool fits = guide.can_go(whole, from, to);
  detail::CourseAnswer answer = guide.course(fits ? whole : single, from, to);
  const bool arrives = answer.course && !answer.nearest;
  if (!arrives)
    leader.why_short = "the leader cannot reach " + detail::printed_place(goal.to) + ": " +
                       (answer.defect.empty() ? answer.why_not : answer.defect) +
                       (answer.nearest ? "; it goes as near as it can, " + words_of(*answer.nearest) : "");
  else if (!fits)
    leader.note = "the leader's route is too narrow for the formation, " + detail::metres(2.0 * whole) +
                  " wide about the leader; it leaves room for single robots, of " + detail::metres(single) + " radius";
  leader.path = answer.course ? std::move(answer.course->points) : std::vector<Vec2>{from};
}

}  // namespace exactvo::formation
