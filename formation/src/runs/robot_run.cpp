// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/robot_run.h"

#include <algorithm>
#include <utility>

#include "exactvo/formation/notices.h"
#include "exactvo/geometry/require.h"
#include "scene/goals.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {

RunReport RobotRun::run() {
  RunReport& report = robots_.report;
  report.robots = robots_.size();
  for (After after = what_follows(false); after == After::step;) {
    take_step();
    after = what_follows(schedule_.is_stopped(report.time));
    stepper_.end_step(after == After::stop);
  }
  if (stepper_.finish()) add_reasons();
  return std::move(report);
}

void RobotRun::take_step() {
  RunReport& report = robots_.report;
  stepper_.decide();
  if (sink_) sink_->before_step(state_of(robots_, stepper_.crowd()));
  robots_.before = robots_.at;
  stepper_.move();
  report.time = schedule_.time(++report.steps);
  for (std::size_t i = 0; i < robots_.size(); ++i) report.path_length += norm(robots_.at[i] - robots_.before[i]);
  if (sink_) sink_->add_state(state_of(robots_, stepper_.crowd()));
}

RobotRun::After RobotRun::what_follows(bool is_stopped) {
  RunReport& report = robots_.report;
  const bool goes_on = stepper_.goes_on();
  const After own = is_stopped ? After::stop : goes_on ? After::step : After::nothing;
  const After all = ranks_ ? static_cast<After>(ranks_->least(static_cast<int>(own))) : own;
  is_under_way_ = goes_on || all == After::step;
  report.interrupted = all == After::stop;
  report.stands_still = all == After::step && stepper_.repeats_itself();
  const bool ends = report.stands_still || schedule_.ends_at(report.steps);
  return all == After::step && ends ? After::nothing : all;
}

/// Why robots are not at their goals, each for itself and in the outcome.
void RobotRun::add_reasons() {
  RunReport& report = robots_.report;
  const Journeys& journeys = robots_.journeys;
  std::vector<std::string> because;
  report.arrived = 0;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    report.arrived += journeys.at_goal(i);
    const std::string why = journeys.at_goal(i) ? std::string() : stepper_.why_not_there(i);
    if (why.empty()) continue;
    because.push_back(robots_.scenario.robots[i].id + " " + why);
    if (!journeys[i].no_way.empty())
      report.without_route.push_back({i, why});
    else if (journeys.is_taken(i))
      report.goal_taken.push_back({i, why});
    else if (journeys[i].cut_by)
      report.route_cut.push_back({i, why});
  }
  std::string& text = report.outcome;
  text = arrival_words(report.arrived, robots_.size(), is_under_way_ && !report.stands_still);
  const std::size_t named = std::min(stepper_.most_named(), because.size());
  for (std::size_t k = 0; k < named; ++k) text += "; " + because[k];
  if (because.size() > named) text += "; " + std::to_string(because.size() - named) + " more for such reasons";
  if (report.stands_still) text += "; nothing moves, and every further step would repeat the last";
  if (report.arrived < robots_.size()) stepper_.add_words(text);
  add_note(text, assumed_words(robots_.scenario));
}

void steer_by(const RunSteering& steering, const RobotSlice& robots, std::vector<Vec2>& preferred) {
  const std::size_t size = preferred.size();
  steering(robots, preferred);
  EXACTVO_REQUIRE(preferred.size() == size, "steering: " + std::to_string(preferred.size()) +
                                                " preferred velocities, of " + std::to_string(size) + " robots");
  for (std::size_t i = robots.first; i < robots.last; ++i)
    EXACTVO_REQUIRE(geometry::is_finite(preferred[i]),
                    "steering: the preferred velocity of robot " + std::to_string(i) + " is not finite");
}

}  // namespace exactvo::formation::detail
