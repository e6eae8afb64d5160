// SPDX-License-Identifier: GPL-3.0-or-later
// Kinematic robots with goals: Section V.A. The loop over time and when it ends, the order in which a step is decided,
// and the turn to the right of robots in each other's way (`biased`, liveness, rule R1).
#include <algorithm>
#include <string>
#include <utility>

#include "decision/decision.h"
#include "exactvo/formation/passing.h"
#include "liveness/groups.h"
#include "motion/leader.h"
#include "runs/joint_decisions.h"
#include "runs/own_decision.h"
#include "runs/rows.h"
#include "runs/run_schedule.h"
#include "runs/runs.h"
#include "scene/moving.h"
#include "scene/static_field.h"
#include "steering/goal_claims.h"
#include "steering/goals.h"
#include "steering/guide.h"
#include "steering/keep_right.h"
#include "steering/last_places.h"
#include "steering/standing.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

struct KinematicRobot : OwnWay {
  Vec2 position;
  Vec2 velocity;
  std::size_t goal = 0;
  std::string note = {};  ///< for the next row
  // With guidance.
  std::optional<Course> course = {};         ///< to its present goal
  std::optional<double> next_margin = {};    ///< m, of its field from the next look on
  std::shared_ptr<Guide> detour = {};        ///< of a course round obstacles that move and stand for now
  bool has_new_course = false;               ///< nobody has looked whether something stands on it
  std::optional<std::size_t> cut_by = {};    ///< the moving obstacle that stands on it, without a way round
  double looks_again = 0.0;                  ///< s: then it looks again for one
  double waits_since = 0.0;                  ///< s: from then on it stood before that, which rests for good
  bool waits_for_good = false;               ///< so long that it stays there
  std::string no_way = {};                   ///< why it has no course to its goal
  std::optional<NearestPlace> nearest = {};  ///< where its course ends that does not lead to its goal
  bool has_come_nearest = false;             ///< it is there
  bool waits_for_room = false;               ///< it has to be pushed out before its course can be planned
  // With liveness.
  KeepRight keep_right;
};

class KinematicRun {
 public:
  /// Without a guide robots head straight for their goals.
  KinematicRun(const Scenario& scenario, const SimulationOptions& options, Guide* guide)
      : scenario_(scenario),
        options_(options),
        guide_(guide),
        liveness_(liveness_of(scenario, options)),
        scene_(scenario, options),
        schedule_(scenario, options),
        own_(scenario, options, scene_.bodies()),
        joint_(
            scenario, options, scene_, schedule_, own_.decider(), [this](std::size_t i) { return viewpoint(i); },
            [this](std::size_t i, RobotStep& step) { choose_again(i, step); }) {
    if (liveness_ != Liveness::off && scenario.robots.size() > 1)
      groups_.emplace(scenario, guide ? guide->space() : open_space_, liveness_ == Liveness::plan, options.threads,
                      [this] { return schedule_.is_stopped(now_); });
    if (guide && !scenario.moving_obstacles.empty()) standing_.emplace(scenario, guide->most_margin());
    for (const MovingObstacle& o : scenario.moving_obstacles)
      moving_until_ = std::max(moving_until_, rests_from(o.motion));
    if (liveness_ != Liveness::off) last_places_ = last_places(scenario, room_at_ends(scenario));
    for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
      KinematicRobot& robot = robots_.emplace_back();
      robot.position = scenario.robots[i].position;
      robot.velocity = scenario.robots[i].velocity;
      look_at_goal(i);
    }
    const bool may_end_elsewhere = guide && scenario.unreachable == Unreachable::nearest;
    const RoomAtEnds room = room_at_ends(scenario);
    std::vector<RobotPlace> ends;
    for (std::size_t i = 0; i < last_places_.size(); ++i) ends.push_back({i, last_places_[i]});
    if (liveness_ != Liveness::off && (may_end_elsewhere || any_leave_no_room(scenario, ends, room)))
      claims_.emplace(scenario, room,
                      options.method == Method::orca ? scenario.horizons.orca : scenario.horizons.robots);
  }

  void run(Recording& recording, RunSink& sink) {
    recording.motion = MotionLaw::straight;
    recording.time_step = scenario_.time_step;
    RowFeed rows(recording, scene_.bodies(), goal_bodies_, groups_ ? &groups_->plans() : nullptr, sink);
    std::size_t k = 0;
    for (; !schedule_.ends_at(k) && !all_arrived() && (k == 0 || !nobody_goes_on()); ++k) {
      Step row = decide_all(schedule_.time(k));
      move(row);
      rows.add(std::move(row));
    }
    rows.add(final_row(schedule_.time(k)));
    recording.outcome = outcome();
    if (guide_) recording.routes = routes_;
    if (liveness_ == Liveness::plan) recording.liveness = groups_ ? groups_->course() : LivenessCourse{};
    rows.finish();
  }

 private:
  Vec2 goal_of(std::size_t i) const { return scenario_.robots[i].goals[robots_[i].goal]; }

  /// Within reach of its goal.
  Vec2 aim_of(std::size_t i) const { return has_last_goal(i) && !last_places_.empty() ? last_places_[i] : goal_of(i); }

  void look_at_goal(std::size_t i) {
    const Robot& spec = scenario_.robots[i];
    robots_[i].head_for(aim_of(i), scene_, scenario_, options_, spec.radius, robots_[i].position);
    if (guide_) plan_course(i);
    goal_bodies_.push_back({now_, i, robots_[i].goal, robots_[i].field->shapes()});
  }

  void plan_course(std::size_t i) {
    KinematicRobot& r = robots_[i];
    CourseAnswer answer = guide_->course(scenario_.robots[i].radius, r.position, destination(i));
    r.course = std::move(answer.course);
    r.detour.reset();
    r.cut_by.reset();
    r.has_new_course = true;
    r.nearest = answer.nearest;
    r.has_come_nearest = false;
    r.no_way = answer.defect.empty()
                   ? "cannot reach " + name_of_goal(i) + ": " + answer.why_not
                   : "stays: a way exists, and by a defect of the program no route could be proven: " + answer.defect;
    r.waits_for_room = answer.start_is_blocked;
    routes_.planned += r.course.has_value();
    routes_.nearest += r.nearest.has_value();
    if (r.nearest) add_note(r.note, r.no_way + "; goes as near as it can, " + words_of(*r.nearest));
    if (r.course && !r.nearest) r.no_way.clear();
    if (r.course) return;
    add_note(r.note, r.waits_for_room ? "has no room: moves away before its route is planned" : r.no_way);
  }

  std::string name_of_goal(std::size_t i) const {
    return scenario_.robots[i].goals.size() == 1 ? "its goal" : "its goal " + std::to_string(robots_[i].goal + 1);
  }

  bool has_last_goal(std::size_t i) const { return robots_[i].goal + 1 == scenario_.robots[i].goals.size(); }

  double reach_of_goal(std::size_t i) const { return reach_of(scenario_, scenario_.robots[i], robots_[i].goal); }

  bool is_within_reach(std::size_t i) const { return norm(goal_of(i) - robots_[i].position) <= reach_of_goal(i); }

  bool at_goal(std::size_t i) const { return has_last_goal(i) && is_within_reach(i); }

  /// Where its way to its present goal ends.
  Vec2 end_of(std::size_t i) const { return robots_[i].nearest ? robots_[i].nearest->place : aim_of(i); }

  bool is_at_end(std::size_t i) const { return at_goal(i) || robots_[i].has_come_nearest; }

  bool all_arrived() const {
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (!at_goal(i)) return false;
    return true;
  }

  void look_at_claims() {
    std::vector<EndNow> now;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const KinematicRobot& r = robots_[i];
      const bool is_last = has_last_goal(i) || r.nearest;
      now.push_back({r.position, end_of(i), is_last, is_last, !r.nearest, is_at_end(i), !goes_by_plan(i)});
    }
    claims_->look(std::move(now));
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (claims_->has_come_to_rest(i)) add_note(robots_[i].note, "stays: " + claims_->words(i));
  }

  /// Its place is taken by another robot.
  bool is_taken(std::size_t i) const { return claims_ && claims_->taken_by(i); }
  bool rests_beside(std::size_t i) const { return claims_ && claims_->rests(i); }

  void pass_waypoint(std::size_t i) {
    if (has_last_goal(i) || !is_within_reach(i)) return;
    ++robots_[i].goal;
    robots_[i].note = passed_goal_words(robots_[i].goal);
    look_at_goal(i);  // which may note that the next one is out of reach
  }

  Step decide_all(double time) {
    now_ = time;
    if (claims_) look_at_claims();
    if (groups_) look_at_groups();
    joint_.begin_step();
    joint_.look_at_robots(groups_ ? &*groups_ : nullptr);
    Step row;
    row.time = time;
    move_obstacles(scenario_, time, scene_, row.moving);
    if (standing_) look_at_what_stands(row.moving);
    row.robots.reserve(robots_.size());
    for (std::size_t i = 0; i < robots_.size(); ++i) row.robots.push_back(decide_one(i));
    if (groups_) joint_.settle(*groups_, row);
    return row;
  }

  // --- Moving obstacles that stand on routes ---

  void look_at_what_stands(const std::vector<MovedObstacle>& moving) {
    const std::size_t before = standing_->changes();
    standing_->look(now_, moving);
    const bool changed = standing_->changes() != before;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      KinematicRobot& r = robots_[i];
      if (!r.course || r.nearest || at_goal(i)) continue;
      if (changed && r.detour) take_up_route(i);
      const bool looks = changed || r.has_new_course || (r.cut_by && now_ >= r.looks_again);
      if (looks && !goes_by_plan(i)) go_round(i);
    }
  }

  Destination destination(std::size_t i) const {
    return {aim_of(i), std::max(0.0, reach_of_goal(i) - norm(aim_of(i) - goal_of(i)))};
  }

  /// What it went round stands there no longer.
  void take_up_route(std::size_t i) {
    KinematicRobot& r = robots_[i];
    CourseAnswer again = guide_->course(scenario_.robots[i].radius, r.position, destination(i));
    if (!again.course || again.nearest) return;
    r.course = std::move(again.course);
    r.detour.reset();
    r.cut_by.reset();
    ++routes_.cut;
    add_note(r.note, "what it went round has moved: a new route is planned");
  }

  /// Where something that stands now cuts its route and there is a way round. Else it waits before it, and looks again.
  void go_round(std::size_t i) {
    constexpr double kLooksAgainAfter = 1.0;  // s
    KinematicRobot& r = robots_[i];
    const double radius = scenario_.robots[i].radius;
    const std::optional<std::size_t> by = standing_->in_the_way(*r.course, r.position, radius);
    const bool is_known = by == r.cut_by;
    r.has_new_course = false;
    r.cut_by = by;
    r.looks_again = now_ + kLooksAgainAfter;
    if (!by) return;
    std::shared_ptr<Guide> detour = standing_->guide();
    CourseAnswer answer = detour->course(radius, r.position, destination(i));
    const bool is_way = answer.course && !answer.nearest;
    const std::string words = "moving obstacle '" + scenario_.moving_obstacles[*by].id + "' stands on its route: " +
                              (is_way ? "a new one leads round it" : "none leads round it, waits");
    if (is_way || !is_known) add_note(r.note, words);
    if (!is_way) return;
    r.course = std::move(answer.course);
    r.detour = std::move(detour);
    r.cut_by.reset();
    ++routes_.cut;
  }

  void look_whether_it_waits(std::size_t i) {
    constexpr double kForGood = 2.0;  // s
    KinematicRobot& r = robots_[i];
    if (!r.cut_by || now_ < moving_until_ || !is_at_rest(i) || goes_by_plan(i)) r.waits_since = now_;
    r.waits_for_good = now_ - r.waits_since >= kForGood;
  }

  // --- Robots that go by plan ---

  void look_at_groups() {
    std::vector<RobotNow> now;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const KinematicRobot& r = robots_[i];
      // Without a way to its goal it stays where it is, and makes way.
      const bool has_no_way = guide_ && !r.course && !r.waits_for_room;
      const Vec2 goal = has_no_way ? r.position : r.course ? r.course->points.back() : aim_of(i);
      now.push_back({r.position, goal, at_goal(i) || r.has_come_nearest || rests_beside(i) || has_no_way,
                     scenario_.robots[i].cooperates && !r.waits_for_room, r.goal,
                     has_no_way || r.nearest || is_taken(i)});
    }
    groups_->begin_step(now_, std::move(now), [&](std::size_t i) {
      const KinematicRobot& r = robots_[i];
      return r.course ? guide_->way_left(*r.course, r.position) : norm(aim_of(i) - r.position);
    });
  }

  bool goes_by_plan(std::size_t i) const { return groups_ && groups_->is_member(i); }

  void choose_again(std::size_t i, RobotStep& step) {
    if (goes_by_plan(i)) return choose_by_plan(i, step);
    look(i);
    choose(i, step.preferred, step);
  }

  void choose_by_plan(std::size_t i, RobotStep& step) {
    robots_[i].next_margin.reset();
    robots_[i].field->set_margin(0.0);
    joint_.choose_by_plan(i, *groups_, *robots_[i].field, now_, step);
  }

  bool meets_robots(std::size_t i) const {
    return std::any_of(joint_.others[i].begin(), joint_.others[i].end(),
                       [&](const Constraint& c) { return is_of_robot(scene_, c); });
  }

  RobotStep decide_one(std::size_t i) {
    pass_waypoint(i);
    look_whether_it_waits(i);
    if (!goes_by_plan(i)) look(i);
    add_moving_constraints(scenario_, viewpoint(i), scene_, joint_.others[i]);
    KinematicRobot& r = robots_[i];
    RobotStep step = undecided(r.position, r.velocity);
    step.note = std::exchange(r.note, {});
    if (groups_) add_note(step.note, groups_->note(i));
    if (goes_by_plan(i)) {
      choose_by_plan(i, step);
      return step;
    }
    Vec2 preferred = steer(i, step);
    if (is_taken(i) && !rests_beside(i) && !is_at_end(i)) preferred = claims_->beside_taken_place(i, preferred);
    choose(i, liveness_ == Liveness::off ? preferred : biased(i, preferred, step.mode), step);
    return step;
  }

  Viewpoint viewpoint(std::size_t i) const {
    const Robot& spec = scenario_.robots[i];
    return {robots_[i].position, robots_[i].velocity, spec.radius, spec.max_speed};
  }

  /// A decision adds half-planes to those of its look as it needs them, so that the margin may change only here.
  void look(std::size_t i) {
    KinematicRobot& r = robots_[i];
    if (r.next_margin) r.field->set_margin(*r.next_margin);
    r.next_margin.reset();
    own_.look(*r.field, viewpoint(i));
  }

  /// REQUIRES: it has looked, and nobody after it.
  void choose(std::size_t i, Vec2 preferred, RobotStep& step) {
    own_.choose(preferred, viewpoint(i), joint_.others[i], schedule_.keeps_all(now_), step);
  }

  /// To the right of the way, the more the longer the robot was held up, while others are near (liveness, rule R1).
  /// Less near the goal: else it could go round and round it.
  Vec2 biased(std::size_t i, Vec2 preferred, Mode mode) {
    const bool is_free = mode == Mode::direct || mode == Mode::guided;
    if (!is_free || preferred == Vec2{} || !meets_robots(i)) return preferred;
    KinematicRobot& r = robots_[i];
    return r.keep_right.turned(preferred, r.velocity, KeepRight::kLeast, 0.0, norm(end_of(i) - r.position),
                               scenario_.robots[i].radius);
  }

  Vec2 straight_for(std::size_t i, Vec2 place) const {
    return detail::straight_for(robots_[i].position, scenario_.robots[i].max_speed, place, scenario_.time_step);
  }

  bool stays(std::size_t i) const {
    const KinematicRobot& r = robots_[i];
    if (goes_by_plan(i)) return false;
    if (rests_beside(i)) return is_at_rest(i);
    return r.waits_for_good || (guide_ && (r.has_come_nearest || (!r.course && !r.waits_for_room)));
  }

  bool is_at_rest(std::size_t i) const {
    constexpr double kAtRest = 0.01;  // of the greatest speed
    return norm(robots_[i].velocity) <= kAtRest * scenario_.robots[i].max_speed;
  }

  /// Whether all robots have arrived or stay, and nothing comes to push them.
  bool nobody_goes_on() const {
    if (now_ < moving_until_) return false;
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (!at_goal(i) && !stays(i)) return false;
    return true;
  }

  /// Along its course; a robot without one stays, and so does one whose course has led it as near as it can get.
  Vec2 guided(std::size_t i, RobotStep& step) {
    KinematicRobot& r = robots_[i];
    const double radius = scenario_.robots[i].radius;
    if (r.waits_for_room) {
      if (!guide_->has_room(radius, r.position)) return straight_for(i, guide_->way_out(radius, r.position));
      plan_course(i);
    }
    r.has_come_nearest = r.nearest && norm(r.position - r.nearest->place) <= scenario_.arrival_tolerance;
    const bool goes_on = r.course && !r.has_come_nearest && !r.waits_for_good;
    if (step.mode == Mode::direct) step.mode = goes_on ? Mode::guided : Mode::staying;
    if (!r.course || r.waits_for_good) return {};
    const Heading to = (r.detour ? *r.detour : *guide_).heading(*r.course, radius, r.position);
    r.next_margin = to.margin;
    if (to.is_new) {
      ++routes_.pushed_off;
      r.has_new_course = true;
      add_note(step.note, "pushed out of sight of its route: a new one is planned");
    }
    return straight_for(i, to.place);
  }

  Vec2 steer(std::size_t i, RobotStep& step) {
    if (rests_beside(i)) {
      step.mode = Mode::staying;
      return claims_->beside_taken_place(i, {});
    }
    if (!guide_ || at_goal(i)) return own_.steer(robots_[i], {now_, viewpoint(i), aim_of(i), at_goal(i)}, step);
    if (own_.is_in_contact()) step.mode = Mode::pushing_out;
    return guided(i, step);
  }

  void move(const Step& row) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      robots_[i].velocity = row.robots[i].chosen;
      robots_[i].position += scenario_.time_step * row.robots[i].chosen;
    }
  }

  Step final_row(double time) const {
    Step row;
    row.time = time;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      row.robots.push_back(undecided(robots_[i].position, robots_[i].velocity));
      if (at_goal(i)) row.robots.back().mode = Mode::arrived;
    }
    return row;
  }

  std::string outcome() const {
    std::string text = arrivals();
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (!at_goal(i) && robots_[i].follower.circled())
        text += "; " + scenario_.robots[i].id +
                " completed a full circuit of the obstacle without finding a way to its goal";
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (!robots_[i].no_way.empty() && !at_goal(i)) text += "; " + scenario_.robots[i].id + " " + why_not_there(i);
    bool all_there = true;
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (at_goal(i)) continue;
      const KinematicRobot& r = robots_[i];
      all_there = false;
      if (!rests_beside(i)) waiting.push_back(i);
      if (is_taken(i))
        text += "; " + scenario_.robots[i].id + (rests_beside(i) ? " stays: " : " cannot reach its goal: ") +
                claims_->words(i);
      if (r.cut_by)
        text += "; moving obstacle '" + scenario_.moving_obstacles[*r.cut_by].id + "' stands on the route of " +
                scenario_.robots[i].id + ", and none leads round it";
    }
    if (!all_there) text += no_passing_words();
    if (!groups_ || waiting.empty()) return text;
    add_note(text, groups_->no_plan_words(waiting));
    add_note(text, groups_->still_going_words());
    return text;
  }

  /// The first pairs that cannot both be where they are to go.
  std::string no_passing_words() const {
    constexpr std::size_t kNamed = 3;
    const std::vector<NoPassing> proofs = robots_without_passing(scenario_);
    std::string text;
    for (std::size_t k = 0; k < std::min(kNamed, proofs.size()); ++k) text += "; " + words_of(scenario_, proofs[k]);
    return text;
  }

  std::string why_not_there(std::size_t i) const {
    const KinematicRobot& r = robots_[i];
    if (!r.nearest) return r.no_way;
    const bool is_there = r.has_come_nearest || rests_beside(i);
    return r.no_way + ", and " + (is_there ? "went" : "was on its way") + " as near as it can: it ends " +
           metres(norm(r.position - goal_of(i))) + " from it; the nearest place that it can reach is " +
           words_of(*r.nearest);
  }

  std::string arrivals() const {
    std::size_t arrived = 0;
    for (std::size_t i = 0; i < robots_.size(); ++i) arrived += at_goal(i);
    const std::size_t all = robots_.size();
    if (arrived == all) return all == 1 ? "the robot arrived" : "all robots arrived";
    const std::string until = nobody_goes_on() ? "" : " within the time limit";
    if (all == 1) return "the robot did not arrive" + until;
    return (arrived == 0 ? "none of " + std::to_string(all) + " robots arrived"
                         : std::to_string(all - arrived) + " of " + std::to_string(all) + " robots did not arrive") +
           until;
  }

  const Scenario& scenario_;
  const SimulationOptions& options_;
  Guide* guide_;
  std::optional<StandingObstacles> standing_;  ///< with guidance, where there are moving obstacles
  RoutesCourse routes_;
  Liveness liveness_;
  Scene scene_;
  RunSchedule schedule_;
  double now_ = 0.0;           ///< s, of the present row
  double moving_until_ = 0.0;  ///< s: from then on all moving obstacles rest for good
  OwnDecision own_;
  std::vector<KinematicRobot> robots_;
  ObstacleSpace open_space_{{}};
  std::vector<Vec2> last_places_;     ///< empty with Liveness::off
  std::optional<GoalClaims> claims_;  ///< where these are too near to each other, but with Liveness::off
  std::optional<Groups> groups_;      ///< of several robots, but with Liveness::off
  JointDecisions joint_;
  std::vector<GoalBodies> goal_bodies_;
};

}  // namespace

void run_kinematic(const Scenario& scenario, const SimulationOptions& options, Guide* guide, Recording& recording,
                   RunSink& sink) {
  KinematicRun(scenario, options, guide).run(recording, sink);
}

}  // namespace exactvo::formation::detail
