// SPDX-License-Identifier: GPL-3.0-or-later
// Kinematic robots with goals: Section V.A. The order in which a step is decided, with every decision on record.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "decision/decision.h"
#include "exactvo/formation/passing.h"
#include "exactvo/geometry/require.h"
#include "liveness/groups.h"
#include "runs/joint_decisions.h"
#include "runs/measuring.h"
#include "runs/own_decision.h"
#include "runs/robot_run.h"
#include "runs/rows.h"
#include "runs/run_schedule.h"
#include "runs/runs.h"
#include "runs/wheels_of_run.h"
#include "scene/goals.h"
#include "scene/moving.h"
#include "scene/static_field.h"
#include "steering/guide.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

class KinematicSteps final : public Stepper {
 public:
  /// Without a guide robots head straight for their goals. All must outlive it.
  KinematicSteps(RobotsOfRun& robots, const SimulationOptions& options, Guide* guide, RunSchedule& schedule,
                 Recording& recording, RunSink& sink)
      : scenario_(robots.scenario),
        guide_(guide),
        liveness_(liveness_of(scenario_, options)),
        rules_(rules_of(scenario_, options)),
        scene_(scenario_, options),
        schedule_(schedule),
        options_(options),
        own_(rules_, scene_.bodies()),
        robots_(robots),
        positions_(robots.at),
        velocities_(robots.velocity),
        journeys_(robots.journeys),
        wheels_(scenario_.robots, rules_),
        ways_(robots.size()),
        here_(robots.size()),
        steered_(robots.size()),
        meets_movers_(meets_movers(scenario_)),
        asked_(robots.size()),
        walls_(guide ? std::vector<SceneObstacle>{} : scenario_.obstacles),
        joint_(
            rules_, scenario_.robots, scene_, schedule_, own_.decider(), [this](std::size_t i) { return here_[i]; },
            [this](std::size_t i, RobotStep& step) { choose_again(i, step); }),
        recording_(recording) {
    if ((liveness_ != Liveness::off && robots.size() > 1) || rules_.has_brakes() || rules_.separate)
      groups_.emplace(scenario_, rules_, scenario_.robots, guide ? guide->space() : open_space_,
                      liveness_ == Liveness::plan, [this] { return schedule_.is_stopped(now_); });
    if (rules_.measurements) measuring_.emplace(rules_, scenario_.robots);
    for (const Robot& robot : scenario_.robots) {
      positions_.push_back(robot.position);
      velocities_.push_back(robot.velocity);
      before_.push_back(robot.velocity);
      stopping_steps_.push_back(
          meets_movers_ && robot.velocity != Vec2{}
              ? stopping_steps(norm(robot.velocity), scenario_.acceleration->max, rules_.time_step)
              : 0);
    }
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      look_at_goal(i);
      journeys_.set_out(i);
    }
    recording.motion = MotionLaw::straight;
    recording.time_step = scenario_.time_step;
    rows_.emplace(recording, scene_.bodies(), goal_bodies_, groups_ ? &groups_->plans() : nullptr, sink);
  }

  void decide() override { row_ = decide_all(schedule_.time(robots_.report.steps)); }

  void move() override {
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      if (wheels_.of(i)) wheels_.drive(i, row_.robots[i].chosen);
      before_[i] = velocities_[i];
      velocities_[i] = row_.robots[i].chosen;
      stopping_steps_[i] = row_.robots[i].stopping_steps;
      positions_[i] += scenario_.time_step * row_.robots[i].chosen;
    }
    rows_->add(std::move(row_));
  }

  /// Not where all have arrived; else also where something still comes to push one.
  bool goes_on() const override {
    bool all_arrived = true, all_done = true;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      all_arrived = all_arrived && journeys_.at_goal(i);
      all_done = all_done && (journeys_.at_goal(i) || stays(i));
    }
    return !all_arrived && (robots_.report.steps == 0 || now_ < journeys_.moving_until() || !all_done);
  }

  bool finish() override {
    rows_->add(final_row(schedule_.time(robots_.report.steps)));
    if (guide_) recording_.routes = journeys_.routes();
    if (liveness_ == Liveness::plan) recording_.liveness = groups_ ? groups_->course() : LivenessCourse{};
    rows_->finish();
    return true;
  }

  std::string why_not_there(std::size_t i) const override {
    std::string why = journeys_.why_not_there(i);
    if (!wheels_.has_room(i)) add_note(why, WheelsOfRun::kNoRoom);
    if (!ways_[i].follower.circled()) return why;
    const std::string circled = "completed a full circuit of the obstacle without finding a way to its goal";
    return why.empty() ? circled : circled + "; " + scenario_.robots[i].id + " " + why;
  }

  std::size_t most_named() const override { return ways_.size(); }

  void add_words(std::string& outcome) const override {
    outcome += no_passing_words();
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < ways_.size(); ++i)
      if (!journeys_.at_goal(i) && !journeys_.rests_beside(i)) waiting.push_back(i);
    if (!groups_ || waiting.empty()) return;
    add_note(outcome, groups_->no_plan_words(waiting));
    add_note(outcome, groups_->still_going_words());
  }

 private:
  /// Obstacles are seen anew on the way to another goal.
  void look_at_goal(std::size_t i) {
    ways_[i].head_for(journeys_.aim_of(i), scene_, rules_, obstacle_radius(scenario_.robots[i]), positions_[i]);
    goal_bodies_.push_back({now_, i, journeys_[i].goal, ways_[i].field->shapes()});
  }

  Step decide_all(double time) {
    now_ = time;
    for (std::size_t i = 0; i < ways_.size(); ++i) here_[i] = viewpoint(i);
    if (journeys_.has_claims()) look_at_claims();
    if (groups_) look_at_groups();
    joint_.begin_step();
    if (liveness_ != Liveness::off)
      for (std::size_t i = 0; i < ways_.size(); ++i) joint_.eases[i] = wheels_.of(i) && is_clear_for(i, 1.0);
    if (measuring_) {
      measuring_->look(positions_, velocities_);
      joint_.look_at_measured(measuring_->measured());
    } else {
      joint_.look_at_robots(groups_ ? &*groups_ : nullptr);
    }
    Step row;
    row.time = time;
    move_obstacles(scenario_.moving_obstacles, time, scene_, row.moving);
    journeys_.look_at_moving_obstacles(time, row.moving);
    for (std::size_t i = 0; i < ways_.size(); ++i) journeys_.go_round(i, goes_by_plan(i));
    if (options_.steering || options_.half_planes) ask_user();
    row.robots.reserve(ways_.size());
    for (std::size_t i = 0; i < ways_.size(); ++i) row.robots.push_back(decide_one(i));
    if (groups_) joint_.settle(&*groups_, row);
    return row;
  }

  /// With all robots on their ways to their present goals.
  void ask_user() {
    const RobotSlice all{0, ways_.size(), now_, positions_, velocities_};
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      prepare(i);
      journeys_.look_along(i);
      steered_[i] = journeys_.beside_taken(i, journeys_.preferred(i));
      asked_[i].clear();
    }
    if (options_.steering) steer_by(options_.steering, all, steered_);
    if (!options_.half_planes) return;
    std::vector<OwnHalfPlane> asked;
    options_.half_planes(all, steered_, asked);
    for (const OwnHalfPlane& h : asked) {
      EXACTVO_REQUIRE(h.robot < ways_.size(), "half_planes: robot " + std::to_string(h.robot) + ", of " +
                                                  std::to_string(ways_.size()) + " robots");
      EXACTVO_REQUIRE(geometry::is_finite(h.half_plane.normal) && h.half_plane.normal != Vec2{} &&
                          std::isfinite(h.half_plane.offset),
                      "half_planes: one of " + scenario_.robots[h.robot].id + " is not finite, or has the normal 0");
      asked_[h.robot].push_back({h.half_plane, h.hard});
    }
  }

  void look_at_claims() {
    std::vector<EndNow> ends;
    for (std::size_t i = 0; i < ways_.size(); ++i) ends.push_back(journeys_.end_now(i, !goes_by_plan(i)));
    journeys_.look_at_claims(std::move(ends));
  }

  // --- Robots that go by plan ---

  void look_at_groups() {
    std::vector<RobotNow> now;
    now.reserve(ways_.size());
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      const Journey& j = journeys_[i];
      // Without a way to its goal it stays where it is, and makes way.
      const bool has_no_way = guide_ && !j.course && !j.waits_for_room;
      const Vec2 goal = has_no_way ? positions_[i] : j.course ? j.course->points.back() : journeys_.aim_of(i);
      now.push_back({positions_[i], goal, journeys_.is_at_end(i) || journeys_.rests_beside(i) || has_no_way,
                     scenario_.robots[i].cooperates && !j.waits_for_room, j.goal,
                     has_no_way || j.nearest || journeys_.is_taken(i)});
    }
    groups_->begin_step(now_, std::move(now), [&](std::size_t i) { return journeys_.way_left(i); });
  }

  bool goes_by_plan(std::size_t i) const { return groups_ && groups_->is_member(i); }

  void choose_again(std::size_t i, RobotStep& step) {
    if (goes_by_plan(i)) return choose_by_plan(i, step);
    look(i);
    choose(i, step.preferred, step);
  }

  void choose_by_plan(std::size_t i, RobotStep& step) {
    journeys_.take_margin(i);
    ways_[i].field->set_margin(0.0);
    joint_.choose_by_plan(i, *groups_, *ways_[i].field, now_, step);
  }

  // --- One robot ---

  void prepare(std::size_t i) {
    if (journeys_.pass_goal(i)) look_at_goal(i);
    journeys_.look_whether_it_waits(i, is_at_rest(i) && !goes_by_plan(i));
  }

  RobotStep decide_one(std::size_t i) {
    const bool is_prepared = options_.steering || options_.half_planes;
    if (!is_prepared) prepare(i);
    if (guide_ && !goes_by_plan(i)) journeys_.look_along(i);
    here_[i].turns_after = journeys_.turns_after(i);
    if (!goes_by_plan(i)) look(i);
    if (!meets_movers_) add_moving_constraints(rules_, here_[i], scene_, joint_.others[i]);
    RobotStep step = undecided_now(i);
    if (measuring_) step.measured = measuring_->measured()[i];
    step.note = journeys_.take_note(i);
    if (journeys_.has_come_to_rest(i)) add_note(step.note, "stays: " + journeys_.words_of_claim(i));
    if (groups_) add_note(step.note, groups_->note(i));
    if (goes_by_plan(i)) {
      choose_by_plan(i, step);
      return step;
    }
    const std::optional<Vec2> apart = rules_.separate ? way_apart(scene_, joint_.others[i]) : std::optional<Vec2>();
    if (apart) step.mode = Mode::pushing_out;
    const Vec2 preferred = apart               ? scenario_.robots[i].max_speed * *apart
                           : options_.steering ? steered(i, step)
                                               : journeys_.beside_taken(i, steer(i, step));
    const Vec2 wish = liveness_ == Liveness::off ? preferred : kept_right(i, preferred, step);
    choose(i, wheels_.aside(i, wish), step);
    return step;
  }

  /// In this step; when it turns is known after a look along its course.
  Viewpoint viewpoint(std::size_t i) const {
    const Robot& spec = scenario_.robots[i];
    Viewpoint here{positions_[i], velocities_[i], obstacle_radius(spec), spec.max_speed};
    here.robot = i;
    here.body = scene_.robot(i);
    here.wheels = wheels_.of(i);
    return here;
  }

  const FreeSpace& space() const { return guide_ ? guide_->space() : walls_; }

  /// A decision adds half-planes to those of its look as it needs them, so that the margin may change only here.
  void look(std::size_t i) {
    StaticField& field = *ways_[i].field;
    if (const std::optional<double> margin = journeys_.take_margin(i)) field.set_margin(*margin);
    own_.look(field, joint_.brakes(i) ? joint_.braked(here_[i]) : here_[i]);
  }

  /// REQUIRES: it has looked, and nobody after it.
  void choose(std::size_t i, Vec2 preferred, RobotStep& step) {
    if (meets_movers_) return choose_among_movers(i, preferred, step);
    if (!promises_between_robots(rules_.method)) joint_.take_sides(i, preferred);
    wheels_.choose(i, preferred, joint_.anchors[i], space(), step, [&](Vec2 wish) {
      own_.choose(wish, here_[i], joint_.others[i], schedule_.keeps_all(now_), asked_[i], step);
    });
  }

  /// The best choice that lets it stand one step later than it would have, at the same time, or one step earlier.
  /// If nothing else is left it brakes, which is always allowed (lemma 8), or stands.
  void choose_among_movers(std::size_t i, Vec2 preferred, RobotStep& step) {
    const std::size_t last = stopping_steps_[i];
    const double acceleration = scenario_.acceleration->max, most = fastest(rules_.speed_bound, here_[i].max_speed);
    std::optional<RobotStep> best;
    for (const std::size_t steps : {last + 1, last, last - 1}) {
      if (steps == 0 || steps > last + 1) continue;
      if (steps > stopping_steps(most, acceleration, rules_.time_step)) continue;
      std::optional<RobotStep> found = within_steps(i, steps, velocities_[i], preferred, step);
      const bool is_better = found && (!best || norm(found->chosen - preferred) < norm(best->chosen - preferred));
      if (is_better) best = std::move(found);
    }
    if (!best) {
      own_.look(*ways_[i].field, joint_.braked(here_[i]));
      const Vec2 braked = last > 1 ? (1.0 - 1.0 / static_cast<double>(last)) * velocities_[i] : Vec2{};
      if (last > 1) best = within_steps(i, last - 1, braked, preferred, step);
      if (last > 1 && !best) best = within_steps(i, last - 1, braked, braked, step);
    }
    if (best) {
      step = std::move(*best);
      return;
    }
    step.stopping_steps = 0;
    own_.choose({}, here_[i], joint_.others[i], schedule_.keeps_all(now_), asked_[i], step);
  }

  /// The choice of a robot that is to stand after this many steps; nothing where half-planes leave it none. `from`: the
  /// velocity that those against movers are to leave the most room.
  std::optional<RobotStep> within_steps(std::size_t i, std::size_t steps, Vec2 from, Vec2 preferred,
                                        const RobotStep& undecided) {
    Viewpoint here = here_[i];
    here.most = stopping_speed(scenario_.acceleration->max, rules_.time_step, steps);
    std::vector<Constraint> others = joint_.others[i];
    for (std::size_t k = 0; k < scene_.moving_obstacles(); ++k)
      if (!add_mover_constraint(rules_, here, *scenario_.moving_obstacles[k].max_speed, steps, from, scene_, k, others))
        return std::nullopt;
    RobotStep step = undecided;
    step.stopping_steps = steps;
    own_.choose(preferred, here, others, schedule_.keeps_all(now_), asked_[i], step);
    return bodies_gave(step) ? std::nullopt : std::optional(std::move(step));
  }

  /// Rule R1, for robots that others may hold up.
  Vec2 kept_right(std::size_t i, Vec2 preferred, RobotStep& step) {
    const bool is_free = step.mode == Mode::direct || step.mode == Mode::guided;
    if (!is_free || preferred == Vec2{}) return preferred;
    const Vec2 turned = journeys_.kept_right(i, preferred, unhindered(i, preferred), least_turn(i), 0.0,
                                             meets_robots(i, preferred));
    step.turned_right = std::atan2(cross(turned, preferred), dot(turned, preferred));
    return turned;
  }

  /// rad: wheels turn slowly, so that they pass each other sooner if they begin early. Beside obstacles that would lead
  /// them off their routes.
  double least_turn(std::size_t i) const {
    return wheels_.of(i) && is_clear_for(i, 2.0) ? KeepRight::kLeastOnWheels : KeepRight::kLeast;
  }

  /// Whether no obstacle is within `ways` times its reach: its radius and its way in `horizons.robots` at full speed.
  bool is_clear_for(std::size_t i, double ways) const {
    const Robot& robot = scenario_.robots[i];
    const double sees = ways * (robot.radius + robot.max_speed * rules_.horizons.robots);
    return space().is_clear(positions_[i], positions_[i], sees);
  }

  /// Its velocity, and as much of what it lacks to the preferred one as it lacks for its acceleration alone: of what
  /// was within its reach in the last step, the share that it took. (Turns on wheels are tight: there all counts.)
  Vec2 unhindered(std::size_t i, Vec2 preferred) const {
    const double most = acceleration_of(scenario_, i) * scenario_.time_step, wanted = norm(preferred - before_[i]);
    if (wheels_.of(i) || !(wanted > most)) return velocities_[i];
    const Vec2 within_reach = (most / wanted) * (preferred - before_[i]);
    const double taken = dot(velocities_[i] - before_[i], within_reach) / (most * most);
    return velocities_[i] + std::clamp(taken, 0.0, 1.0) * (preferred - velocities_[i]);
  }

  /// Whether it sees another robot that may be in its way: one whose half-plane excludes the preferred velocity, or
  /// that does not move apart from it.
  bool meets_robots(std::size_t i, Vec2 preferred) const {
    const FreeSpace& among = space();
    const auto is_in_the_way = [&](std::size_t other, const geometry::HalfPlane& h) {
      const bool moves_apart = dot(positions_[other] - positions_[i], velocities_[other] - velocities_[i]) > 0.0;
      return !(moves_apart && dot(h.normal, preferred) >= h.offset);
    };
    return std::any_of(joint_.others[i].begin(), joint_.others[i].end(), [&](const Constraint& c) {
      return is_of_robot(scene_, c) && is_in_the_way(c.index, c.half_plane) &&
             among.is_clear(positions_[i], positions_[c.index], kContactSkin);
    });
  }

  /// As the user wants it. A robot that rests at its goal counts as there all the same.
  Vec2 steered(std::size_t i, RobotStep& step) const {
    step.mode = journeys_.at_goal(i) ? Mode::arrived : own_.is_in_contact() ? Mode::pushing_out : Mode::steered;
    return steered_[i];
  }

  Vec2 steer(std::size_t i, RobotStep& step) {
    if (journeys_.rests_beside(i)) {
      step.mode = Mode::staying;
      return {};
    }
    const bool at_goal = journeys_.at_goal(i);
    if (!guide_ || at_goal)
      return own_.steer(ways_[i], {now_, here_[i], journeys_.aim_of(i), at_goal, acceleration_of(scenario_, i)}, step);
    if (own_.is_in_contact()) step.mode = Mode::pushing_out;
    return guided(i, step);
  }

  /// Along its course. A robot without one stays, and so does one whose course has led it as near as it can get.
  Vec2 guided(std::size_t i, RobotStep& step) {
    const Journey& j = journeys_[i];
    if (j.waits_for_room) return journeys_.preferred(i);
    if (step.mode == Mode::direct) step.mode = journeys_.stays(i) ? Mode::staying : Mode::guided;
    return journeys_.preferred(i);
  }

  bool is_at_rest(std::size_t i) const {
    constexpr double kAtRest = 0.01;  // of the greatest speed
    return norm(velocities_[i]) <= kAtRest * scenario_.robots[i].max_speed;
  }

  RobotStep undecided_now(std::size_t i) const {
    RobotStep step = undecided(positions_[i], velocities_[i]);
    if (const WheelsNow* wheels = wheels_.of(i)) step.wheels = wheels->state;
    return step;
  }

  // --- The end ---

  bool stays(std::size_t i) const {
    if (goes_by_plan(i)) return false;
    return journeys_.rests_beside(i) && journeys_.ends_here(i) ? is_at_rest(i) : journeys_.stays(i);
  }

  Step final_row(double time) const {
    Step row;
    row.time = time;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      row.robots.push_back(undecided_now(i));
      if (journeys_.at_goal(i)) row.robots.back().mode = Mode::arrived;
    }
    return row;
  }

  /// The first pairs that cannot both be where they are to go.
  std::string no_passing_words() const {
    constexpr std::size_t kNamed = 3;
    const std::vector<NoPassing> proofs = robots_without_passing(scenario_);
    std::string text;
    for (std::size_t k = 0; k < std::min(kNamed, proofs.size()); ++k) text += "; " + words_of(scenario_, proofs[k]);
    return text;
  }

  const Scenario& scenario_;
  Guide* guide_;
  Liveness liveness_;
  DecisionRules rules_;
  Scene scene_;
  RunSchedule& schedule_;
  double now_ = 0.0;  ///< s, of the present row
  const SimulationOptions& options_;
  OwnDecision own_;
  RobotsOfRun& robots_;
  std::vector<Vec2>&positions_, &velocities_;
  std::vector<Vec2> before_;  ///< m/s, at the beginning of the last step
  Journeys& journeys_;
  WheelsOfRun wheels_;
  std::vector<OwnWay> ways_;
  std::vector<Viewpoint> here_;                    ///< of each robot, in the present step
  std::vector<Vec2> steered_;                      ///< m/s, by the user
  std::vector<std::size_t> stopping_steps_;        ///< `RobotStep::stopping_steps` of the last step
  bool meets_movers_;                              ///< moving obstacles have a max_speed
  std::vector<std::vector<OwnConstraint>> asked_;  ///< by the user, of each robot
  ObstacleSpace walls_, open_space_{{}};
  std::optional<Groups> groups_;  ///< of several robots, but with Liveness::off
  JointDecisions joint_;
  std::optional<Measuring> measuring_;  ///< where robots measure each other
  std::vector<GoalBodies> goal_bodies_;
  Recording& recording_;
  std::optional<RowFeed> rows_;
  Step row_;  ///< decided, but not carried out
};

}  // namespace

void run_kinematic(const Scenario& scenario, const SimulationOptions& options, Guide* guide, Recording& recording,
                   RunSink& sink) {
  RunSchedule schedule(scenario, options);
  RobotsOfRun robots(scenario, guide, liveness_of(scenario, options), room_at_ends(scenario),
                     takes_edges(options.method) ? scenario.horizons.orca : scenario.horizons.robots,
                     TakenOnTheWay::reached);
  KinematicSteps steps(robots, options, guide, schedule, recording, sink);
  sink.add_state(state_of(robots, nullptr));
  recording.outcome = RobotRun(robots, steps, schedule, &sink).run().outcome;
}

}  // namespace exactvo::formation::detail
