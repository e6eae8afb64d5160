// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/journeys.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "exactvo/geometry/infinity.h"
#include "motion/leader.h"
#include "runs/own_decision.h"
#include "scene/goals.h"
#include "scene/moment.h"
#include "scene/number_text.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

using crowd::SnapshotReader;
using crowd::SnapshotWriter;
using geometry::norm;

constexpr double kLooksAgainAfter = 1.0;  // moments
constexpr double kForGood = 2.0;          // moments, before an obstacle that rests

}  // namespace

Journeys::Journeys(const Scenario& scenario, Guide* guide, Liveness liveness, const std::vector<Vec2>& at,
                   const RoomAtEnds& room, double horizon, TakenOnTheWay taken)
    : scenario_(scenario), guide_(guide), taken_(taken), at_(at), journeys_(scenario.robots.size()) {
  if (guide && !scenario.moving_obstacles.empty()) standing_.emplace(scenario, guide->most_margin());
  for (const MovingObstacle& o : scenario.moving_obstacles)
    moving_until_ = std::max(moving_until_, rests_from(o.motion));
  if (liveness != Liveness::off) choose_last_places(room, horizon);
}

/// And claims, where ends may be too near to each other all the same.
void Journeys::choose_last_places(const RoomAtEnds& room, double horizon) {
  last_places_ = last_places(scenario_, room);
  std::vector<RobotPlace> ends;
  for (std::size_t i = 0; i < journeys_.size(); ++i) {
    if (taken_ == TakenOnTheWay::passed_beside)
      for (const Vec2 goal : scenario_.robots[i].goals) ends.push_back({i, goal});
    else
      ends.push_back({i, {}});
    ends.back().place = last_places_[i];
  }
  const bool may_end_elsewhere = guide_ && scenario_.unreachable == Unreachable::nearest;
  if (may_end_elsewhere || any_leave_no_room(scenario_, ends, room)) claims_.emplace(scenario_, room, horizon);
}

// --- Courses ---

void Journeys::set_out(std::size_t i) {
  journeys_[i].heading = aim_of(i);
  if (guide_) plan_course(i);
}

Destination Journeys::destination(std::size_t i) const {
  return {aim_of(i), std::max(0.0, reach_of_goal(i) - norm(aim_of(i) - goal_of(i)))};
}

double Journeys::reach_of_goal(std::size_t i) const {
  return reach_of(scenario_.robots[i], journeys_[i].goal, scenario_.arrival_tolerance);
}

bool Journeys::is_within_reach(std::size_t i) const {
  const Vec2 way = goal_of(i) - at_[i];
  const double reach = reach_of_goal(i);
  return std::fabs(way.x) <= reach && std::fabs(way.y) <= reach && norm(way) <= reach;  // most need no root
}

void Journeys::plan_course(std::size_t i) {
  Journey& j = journeys_[i];
  CourseAnswer answer = guide_->course(obstacle_radius(scenario_.robots[i]), at_[i], destination(i));
  j.course = std::move(answer.course);
  j.detour.reset();
  j.cut_by.reset();
  j.has_new_course = true;
  j.nearest = answer.nearest;
  j.has_come_nearest = false;
  j.no_way = answer.defect.empty()
                 ? "cannot reach " + name_of_goal(i) + ": " + answer.why_not
                 : "stays: a way exists, and by a defect of the program no route could be proven: " + answer.defect;
  j.waits_for_room = answer.start_is_blocked;
  routes_.planned += j.course.has_value();
  routes_.nearest += j.nearest.has_value();
  if (j.nearest) add_note(j.note, j.no_way + "; goes as near as it can, " + words_of(*j.nearest));
  if (j.course && !j.nearest) j.no_way.clear();
  if (j.course) return;
  add_note(j.note, j.waits_for_room ? "has no room: moves away before its route is planned" : j.no_way);
}

std::string Journeys::name_of_goal(std::size_t i) const {
  return scenario_.robots[i].goals.size() == 1 ? "its goal" : "its goal " + std::to_string(journeys_[i].goal + 1);
}

bool Journeys::pass_goal(std::size_t i) {
  const bool passes_beside = taken_ == TakenOnTheWay::passed_beside && rests_beside(i);
  if (has_last_goal(i) || !(is_within_reach(i) || passes_beside)) return false;
  ++journeys_[i].goal;
  journeys_[i].has_passed_goal = true;
  add_note(journeys_[i].note, passed_goal_words(journeys_[i].goal));
  set_out(i);  // which may note that the next one is out of reach
  return true;
}

void Journeys::look_along(std::size_t i) {
  Journey& j = journeys_[i];
  const double radius = obstacle_radius(scenario_.robots[i]);
  j.heading = aim_of(i);
  if (!guide_ || at_goal(i)) return;
  if (j.waits_for_room) {
    if (!guide_->has_room(radius, at_[i])) {
      j.heading = guide_->way_out(radius, at_[i]);
      return;
    }
    plan_course(i);
  }
  j.has_come_nearest = j.nearest && norm(at_[i] - j.nearest->place) <= scenario_.arrival_tolerance;
  j.heading = at_[i];
  if (!j.course || j.waits_for_good) return;
  const Heading to = (j.detour ? *j.detour->guide : *guide_).heading(*j.course, radius, at_[i]);
  j.heading = to.place;
  j.margin = to.margin;
  if (!to.is_new) return;
  ++routes_.pushed_off;
  j.has_new_course = true;
  add_note(j.note, "pushed out of sight of its route: a new one is planned");
}

double Journeys::turns_after(std::size_t i) const {
  const Journey& j = journeys_[i];
  const bool has_place = j.course && !j.waits_for_good && !at_goal(i);
  return has_place ? norm(j.heading - at_[i]) / scenario_.robots[i].max_speed : geometry::kInfinity;
}

double Journeys::way_left(std::size_t i) const {
  const Journey& j = journeys_[i];
  return j.course ? guide_->way_left(*j.course, at_[i]) : norm(aim_of(i) - at_[i]);
}

bool Journeys::stays(std::size_t i) const {
  const Journey& j = journeys_[i];
  return j.waits_for_good || j.has_come_nearest || (guide_ && !j.course && !j.waits_for_room);
}

Vec2 Journeys::preferred(std::size_t i) const {
  return straight_for(at_[i], scenario_.robots[i].max_speed, journeys_[i].heading, scenario_.time_step,
                      acceleration_of(scenario_, i));
}

Vec2 Journeys::kept_right(std::size_t i, Vec2 preferred, Vec2 velocity, double least, double patience,
                          bool meets_others) {
  return journeys_[i].keep_right.turned(preferred, velocity, least, patience, norm(end_of(i) - at_[i]),
                                        scenario_.robots[i].radius, meets_others);
}

// --- Moving obstacles that stand on courses ---

void Journeys::look_at_moving_obstacles(double time, const std::vector<MovedObstacle>& moving) {
  now_ = time;
  if (!standing_) return;
  const std::size_t before = standing_->changes();
  standing_->look(time, moving);
  standing_changed_ = standing_->changes() != before;
}

/// An obstacle counts as standing after a moment; then its robots look again, and at last stay for good.
double Journeys::longest_pause() const {
  return standing_ ? (1.0 + kLooksAgainAfter + kForGood) * moment(scenario_.horizons) : 0.0;
}

void Journeys::go_round(std::size_t i, bool goes_by_plan) {
  Journey& j = journeys_[i];
  if (!standing_ || !j.course || j.nearest || at_goal(i)) return;
  if (standing_changed_ && j.detour) take_up_route(i);
  const bool looks = standing_changed_ || j.has_new_course || (j.cut_by && now_ >= j.looks_again);
  if (!looks || goes_by_plan) return;
  const double radius = obstacle_radius(scenario_.robots[i]);
  const std::optional<std::size_t> by = standing_->in_the_way(*j.course, at_[i], radius);
  const bool is_known = by == j.cut_by;
  j.has_new_course = false;
  j.cut_by = by;
  j.looks_again = now_ + kLooksAgainAfter * moment(scenario_.horizons);
  if (!by) return;
  Detour detour = standing_->detour();
  CourseAnswer answer = detour.guide->course(radius, at_[i], destination(i));
  const bool is_way = answer.course && !answer.nearest;
  const std::string words = "moving obstacle '" + scenario_.moving_obstacles[*by].id + "' stands on its route: " +
                            (is_way ? "a new one leads round it" : "none leads round it, waits");
  if (is_way || !is_known) add_note(j.note, words);
  if (!is_way) return;
  j.course = std::move(answer.course);
  j.detour = std::move(detour);
  j.cut_by.reset();
  ++routes_.cut;
}

/// The obstacle that it went round stands there no longer.
void Journeys::take_up_route(std::size_t i) {
  Journey& j = journeys_[i];
  CourseAnswer again = guide_->course(obstacle_radius(scenario_.robots[i]), at_[i], destination(i));
  if (!again.course || again.nearest) return;
  j.course = std::move(again.course);
  j.detour.reset();
  j.cut_by.reset();
  ++routes_.cut;
  add_note(j.note, "what it went round has moved: a new route is planned");
}

void Journeys::look_whether_it_waits(std::size_t i, bool may_wait) {
  Journey& j = journeys_[i];
  if (!j.cut_by || now_ < moving_until_ || !may_wait) j.waits_since = now_;
  j.waits_for_good = now_ - j.waits_since >= kForGood * moment(scenario_.horizons);
}

// --- Ends that are taken ---

EndNow Journeys::end_now(std::size_t i, bool may_rest) const {
  const Journey& j = journeys_[i];
  const bool has_way = j.nearest || j.course || !guide_;
  const bool counts = has_way && (ends_here(i) || taken_ == TakenOnTheWay::passed_beside);
  const bool is_there = j.nearest ? j.has_come_nearest : is_within_reach(i);
  return {at_[i], end_of(i), counts, counts && ends_here(i), !j.nearest, is_there, may_rest};
}

bool Journeys::look_at_claims(std::vector<EndNow> ends) {
  for (Journey& j : journeys_) j.has_passed_goal = false;
  return claims_->look(std::move(ends));
}

Vec2 Journeys::beside_taken(std::size_t i, Vec2 preferred) const {
  return is_taken(i) && !is_at_end(i) ? claims_->beside_taken_place(i, preferred) : preferred;
}

std::string Journeys::why_not_there(std::size_t i) const {
  const Journey& j = journeys_[i];
  std::string text;
  if (!j.no_way.empty()) {
    text = j.no_way;
    const bool is_there = j.has_come_nearest || rests_beside(i);
    if (j.nearest)
      text += std::string(", and ") + (is_there ? "went" : "was on its way") + " as near as it can: it ends " +
              metres(norm(at_[i] - goal_of(i))) + " from it; the nearest place that it can reach is " +
              words_of(*j.nearest);
  }
  if (is_taken(i)) add_note(text, (rests_beside(i) ? "stays: " : "cannot reach its goal: ") + claims_->words(i));
  if (j.cut_by)
    add_note(text, "waits: moving obstacle '" + scenario_.moving_obstacles[*j.cut_by].id +
                       "' stands on its route, and none leads round it");
  return text;
}

// --- Snapshots ---

namespace {

[[noreturn]] void refuse() {
  crowd::refuse_snapshot("other bytes", kSnapshotOfRun);
}

/// Writes or reads the members: `Bytes` is a SnapshotWriter or a SnapshotReader.
template <class Bytes, class AJourney>
void fields_of_journey(Bytes& bytes, AJourney& j, bool& has_course) {
  bytes.fields(j.goal, j.heading, j.margin, j.nearest, j.no_way, j.has_come_nearest, j.waits_for_room, j.has_new_course,
               j.cut_by, j.looks_again, j.waits_since, j.waits_for_good, j.keep_right.held_up, has_course);
  if (!has_course) return;
  if constexpr (!std::is_const_v<AJourney>) j.course.emplace();
  bytes.fields(j.course->points, j.course->keeps, j.course->to, j.course->next, j.course->seen);
}

template <class Bytes, class OfRobot>
void fields_of_claim(Bytes& bytes, OfRobot& r) {
  bytes.fields(r.has_claim, r.place, r.is_goal, r.rests, r.taken_by);
}

}  // namespace

void Journeys::put(std::size_t i, SnapshotWriter& to) const {
  const Journey& j = journeys_[i];
  bool has_course = j.course.has_value();
  fields_of_journey(to, j, has_course);
  to.put(j.detour.has_value());
  if (j.detour) put_standing(to, j.detour->round);
}

void Journeys::get(std::size_t i, SnapshotReader& from) {
  Journey& j = journeys_[i];
  bool has_course = false;
  j = {};
  fields_of_journey(from, j, has_course);
  if (j.goal >= scenario_.robots[i].goals.size() || (j.course && !guide_)) refuse();
  if (j.course && (j.course->next >= j.course->points.size() || j.course->keeps.size() != j.course->points.size()))
    refuse();
  if (j.cut_by && *j.cut_by >= scenario_.moving_obstacles.size()) refuse();
  if (!from.get<bool>()) return;
  if (!standing_) refuse();
  j.detour = standing_->detour(get_standing(from, scenario_.moving_obstacles.size()));
}

void Journeys::put_shared(SnapshotWriter& to) const {
  if (claims_)
    for (const GoalClaims::OfRobot& r : claims_->remembered()) fields_of_claim(to, r);
  if (standing_) standing_->put(to);
}

void Journeys::get_shared(SnapshotReader& from) {
  if (claims_) {
    std::vector<GoalClaims::OfRobot> robots(claims_->remembered().size());
    for (GoalClaims::OfRobot& r : robots) {
      fields_of_claim(from, r);
    }
    for (const GoalClaims::OfRobot& r : robots) {
      const bool has_taker = r.taken_by && *r.taken_by < robots.size() && robots[*r.taken_by].has_claim;
      if (r.taken_by ? !has_taker : r.rests) refuse();
    }
    claims_->remember(std::move(robots));
  }
  if (standing_) standing_->get(from);
}

}  // namespace exactvo::formation::detail
