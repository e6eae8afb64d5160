// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/own_decision.h"

#include "scene/goals.h"
#include "scene/moment.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {

std::string passed_goal_words(std::size_t next) {
  return "goal " + std::to_string(next) + " passed: heads for the next";
}

void OwnDecision::reserve(std::size_t statics, std::size_t others) {
  decider_.reserve(statics + others);
  needed_.reserve(statics);
  following_.reserve(statics);
}

void OwnDecision::look(const StaticField& field, const Viewpoint& here) {
  needed_.look(field, here, reach_of_step(rules_.time_step, here.max_speed));
}

DecisionInput OwnDecision::input(Vec2 preferred, const Viewpoint& here, const std::vector<Constraint>& others,
                                 bool keep_all) {
  return {preferred, here, &statics(), &others, keep_all, &needed_};
}

Vec2 OwnDecision::steer(OwnWay& way, const Errand& errand, Decision& decision) {
  const Viewpoint& here = errand.here;
  const Vec2 preferred =
      straight_for(here.position, here.max_speed, errand.goal, rules_.time_step, errand.acceleration);
  if (errand.has_arrived) {
    decision.mode = Mode::arrived;
    return preferred;
  }
  const bool in_contact = is_in_contact();
  if (in_contact) decision.mode = Mode::pushing_out;
  if (takes_edges(rules_.method)) return preferred;
  if (rules_.method != Method::ivo) return ties_broken(way, preferred, decision);
  const BoundaryFollower::Answer answer =
      way.follower.steer({errand.time, rules_.time_step, moment(rules_.horizons), here, errand.goal,
                          following_reach(rules_, here.max_speed), preferred, &*way.field},
                         following_);
  decision.mode = in_contact && answer.mode == Mode::direct ? Mode::pushing_out : answer.mode;
  decision.side = answer.side;
  answer.note.add_to(decision.note);
  if (answer.mode == Mode::following) return answer.preferred;
  needed_.need_at(preferred);
  const std::optional<Vec2> boost = boosted(needed_.lines(), preferred);
  if (!boost) return ties_broken(way, preferred, decision);
  decision.mode = Mode::boost;
  return *boost;
}

/// Says so when a tie begins.
Vec2 OwnDecision::ties_broken(OwnWay& way, Vec2 preferred, Decision& decision) {
  needed_.need_at(preferred);
  const Vec2 turned = with_tie_broken(needed_.lines(), preferred);
  const bool tied = !(turned == preferred);
  if (tied && !way.tied) add_note(decision.note, "head-on: the tie between the sides goes left");
  way.tied = tied;
  return turned;
}

}  // namespace exactvo::formation::detail
