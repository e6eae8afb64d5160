// SPDX-License-Identifier: GPL-3.0-or-later
// Formations: Sections IV and V.B, with the options of controller_options.h. The loop over time and when it ends, and
// how the controller is put together from the terms of control/consensus.h: `wanted_velocity`, `tracked_velocity`.
// Robots on wheels do not track: their reference points drive at what the filter chooses, and brake as all robots on
// wheels do (scene/braking.h).
#include <algorithm>
#include <string>
#include <utility>

#include "control/consensus.h"
#include "decision/decision.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/stability.h"
#include "metrics/divergence.h"
#include "motion/integrators.h"
#include "motion/leader.h"
#include "runs/joint_decisions.h"
#include "runs/rows.h"
#include "runs/run_schedule.h"
#include "runs/runs.h"
#include "runs/slot_plans.h"
#include "runs/wheels_of_run.h"
#include "scene/moment.h"
#include "scene/moving.h"
#include "scene/number_text.h"
#include "scene/static_field.h"
#include "scene/step_limits.h"
#include "steering/robot_bypass.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;

struct FormationRobot {
  BodyState body;
  Vec2 tracked;  ///< w of the step before
  StaticField field;
  SideCommitment side;
  RobotBypass bypass;
  // With joint plans.
  std::string note = {};                   ///< for the next row
  std::optional<StaticField> pieces = {};  ///< what it sees of obstacles while it goes by plan, made when it first does
  bool goes_beside = false;                ///< its slot: SlotPlans::places
  bool sees_pieces = false;                ///< it went by plan when it decided last
};

DecisionRules formation_rules(const Scenario& scenario, const SimulationOptions& options,
                              const ControllerOptions& switches) {
  DecisionRules rules = rules_of(scenario, options);
  if (!switches.margins) rules.margins.robot = 0.0;
  return rules;
}

class FormationRun {
 public:
  FormationRun(const Scenario& scenario, const SimulationOptions& options)
      : switches_(controller_options_in_use(scenario, options)),
        scenario_(scenario),
        rules_(formation_rules(scenario, options, switches_)),
        spec_(*scenario.formation),
        options_(options),
        tracks_(tracks_choices(scenario)),
        scene_(scenario, options),
        schedule_(scenario, options),
        decider_(rules_, scene_.bodies()),
        offsets_(offsets_in_use(spec_, switches_)),
        wheels_(scenario.robots, rules_),
        walls_(tracks_ ? std::vector<SceneObstacle>{} : scenario.obstacles),
        joint_(
            rules_, scenario.robots, scene_, schedule_, decider_, [this](std::size_t i) { return viewpoint(i); },
            [this](std::size_t i, RobotStep& step) { choose_again(i, step); }) {
    if (liveness_of(scenario, options) == Liveness::plan) {
      plans_.emplace(scenario_, rules_, offsets_, [this] { return schedule_.is_stopped(now_); });
      joint_.gap = plans_->gap();
    }
    const HorizonRule rule = switches_.horizon_clamp ? HorizonRule::clamped : HorizonRule::literal;
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const Robot& r = scenario_.robots[i];
      const Vec2 slot = spec_.leader.path.back() + offsets_[i];
      robots_.push_back({{r.position, r.velocity},
                         r.velocity,
                         StaticField(scene_, rules_, obstacle_radius(r), r.position, slot, rule),
                         {},
                         {}});
    }
  }

  void run(Recording& recording, RunSink& sink) {
    recording.motion = tracks_ ? motion_of(options_.integrator) : MotionLaw::straight;
    recording.time_step = scenario_.time_step;
    recording.tracking_gain = tracks_ ? spec_.gains.k3 : 0.0;
    recording.relative_frame = !switches_.absolute_frame;
    recording.controller_options = switches_;
    recording.offsets = offsets_;
    for (std::size_t i = 0; i < robots_.size(); ++i) goal_bodies_.push_back({0.0, i, 0, robots_[i].field.shapes()});
    RowFeed rows(recording, scene_.bodies(), goal_bodies_, plans_ ? &plans_->groups().plans() : nullptr, sink);
    const double first_error = formation_error(state_row(0.0), offsets_);
    std::size_t k = 0;
    for (; !schedule_.ends_at(k) && !schedule_.is_stopped(schedule_.time(k)) && !out_of_bounds(); ++k) {
      Step row = decide_all(schedule_.time(k));
      move(row);
      rows.add(std::move(row));
    }
    const Step last = state_row(schedule_.time(k));
    rows.add(last);
    rows.finish();
    if (plans_) recording.liveness = plans_->groups().course();
    note_divergence(first_error, last, recording);
  }

 private:
  /// Where half-planes are built: the brake point x + v / k3, whose velocity is exactly w; the paper builds them at x.
  Vec2 anchor(std::size_t i) const {
    const BodyState& b = robots_[i].body;
    return switches_.brake_point ? b.position + b.velocity / spec_.gains.k3 : b.position;
  }
  Vec2 anchor_velocity(std::size_t i) const {
    return switches_.brake_point ? robots_[i].tracked : robots_[i].body.velocity;
  }

  /// m: from its slot, or from where it goes as that cannot be filled, to the robot.
  Vec2 relative_position(std::size_t i, Vec2 leader) const {
    const Vec2 here = robots_[i].body.position;
    return robots_[i].goes_beside ? here - plans_->places()[i].at : here - leader - offsets_[i];
  }
  bool misses_slot(std::size_t i) const {
    return plans_ && !plans_->places().empty() && !plans_->places()[i].why_not.empty();
  }

  void take_relative_states(const LeaderState& leader) {
    relative_.position.clear();
    relative_.velocity.clear();
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      relative_.position.push_back(relative_position(i, leader.position));
      relative_.velocity.push_back(robots_[i].body.velocity - leader.velocity);
    }
  }

  Step decide_all(double time) {
    now_ = time;
    Step row = state_row(time);
    const LeaderState leader{row.leader_position, row.leader_velocity};
    joint_.begin_step();
    if (plans_) begin_plans(time, leader);
    take_relative_states(leader);
    joint_.look_at_robots(plans_ ? &plans_->groups() : nullptr);
    move_obstacles(scenario_.moving_obstacles, time, scene_, row.moving);
    for (std::size_t i = 0; i < robots_.size(); ++i) decide_one(i, time, leader, row.robots[i]);
    if (plans_ || rules_.has_brakes()) joint_.settle(plans_ ? &plans_->groups() : nullptr, row);
    return row;
  }

  void begin_plans(double time, const LeaderState& leader) {
    const bool had_places = !plans_->places().empty();
    plans_->begin_step(time, joint_.anchors, leader);
    if (had_places || plans_->places().empty()) return;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const SlotPlans::Place& place = plans_->places()[i];
      const Vec2 slot = leader.position + offsets_[i];
      if (!(place.at == slot)) go_beside_slot(i, time, place, norm(place.at - slot));
    }
  }

  /// Its obstacles are seen anew for where it goes now. `distance`: m, from its slot.
  void go_beside_slot(std::size_t i, double time, const SlotPlans::Place& place, double distance) {
    FormationRobot& r = robots_[i];
    r.goes_beside = true;
    r.field = StaticField(scene_, rules_, scenario_.robots[i].radius, anchor(i), place.at, HorizonRule::clamped);
    r.side = {};
    note_goal_bodies(i, time, r.field.shapes());
    if (!place.why_not.empty())
      r.note = "cannot take its slot: " + place.why_not + "; goes to a place " + metres(distance) + " from it";
  }

  Viewpoint viewpoint(std::size_t i) const {
    const Robot& spec = scenario_.robots[i];
    Viewpoint here{anchor(i), anchor_velocity(i), obstacle_radius(spec), spec.max_speed};
    here.robot = i;
    here.body = scene_.robot(i);
    here.wheels = wheels_.of(i);
    return here;
  }

  void decide_one(std::size_t i, double time, const LeaderState& leader, RobotStep& step) {
    const Viewpoint here = viewpoint(i);
    step.anchor = here.position;
    step.anchor_velocity = here.velocity;
    add_moving_constraints(rules_, here, scene_, joint_.others[i]);
    step.note = std::exchange(robots_[i].note, {});
    if (plans_) add_note(step.note, plans_->groups().note(i));
    if (goes_by_plan(i) != robots_[i].sees_pieces) look_otherwise(i, time);
    if (goes_by_plan(i)) return choose_by_plan(i, step);
    look(i);
    const Vec2 wanted = wanted_velocity(i, leader);
    const RobotBypass::Situation situation{time,
                                           moment(scenario_.horizons),
                                           norm(relative_.position[i]),
                                           scenario_.arrival_tolerance,
                                           spec_.catch_up_speed,
                                           leader.velocity == Vec2{},
                                           wanted};
    const Vec2 preferred = steered(i, situation, step);
    if (misses_slot(i) && norm(relative_.position[i]) <= scenario_.arrival_tolerance) step.mode = Mode::staying;
    // Math: v_pref <- (v_pref + 4 w_prev) / 5, projected.
    choose(i, wheels_.aside(i, switches_.smoothing ? (preferred + 4.0 * robots_[i].tracked) / 5.0 : preferred), step);
  }

  void look(std::size_t i) {
    const Viewpoint here = viewpoint(i);
    statics_.look(robots_[i].field, joint_.brakes(i) ? joint_.braked(here) : here,
                  reach_of_step(rules_.time_step, here.max_speed));
  }

  /// REQUIRES: it has looked, and nobody after it.
  void choose(std::size_t i, Vec2 preferred, RobotStep& step) {
    wheels_.choose(i, preferred, joint_.anchors[i], walls_, step, [&](Vec2 wish) {
      decider_.decide({wish, viewpoint(i), &statics_.lines(), &joint_.others[i], schedule_.keeps_all(now_), &statics_},
                      step);
    });
  }

  // --- Robots that go by plan ---

  bool goes_by_plan(std::size_t i) const { return plans_ && plans_->groups().is_member(i); }

  /// A robot that begins to go by plan sees the pieces of obstacles instead of what encloses them; one whose plan ends
  /// sees what encloses them again.
  void look_otherwise(std::size_t i, double time) {
    FormationRobot& r = robots_[i];
    r.sees_pieces = !r.sees_pieces;
    if (r.sees_pieces && !r.pieces) r.pieces = field_of_pieces(i);
    r.side = {};
    r.bypass = {};
    note_goal_bodies(i, time, (r.sees_pieces ? *r.pieces : r.field).shapes());
  }

  /// One for each robot and row: the last that it has before it decides.
  void note_goal_bodies(std::size_t i, double time, std::vector<vo::BodyTable::Number> bodies) {
    const auto same = std::find_if(goal_bodies_.rbegin(), goal_bodies_.rend(),
                                   [&](const GoalBodies& o) { return o.time != time || o.robot == i; });
    if (same != goal_bodies_.rend() && same->time == time)
      same->bodies = std::move(bodies);
    else
      goal_bodies_.push_back({time, i, 0, std::move(bodies)});
  }

  void choose_by_plan(std::size_t i, RobotStep& step) {
    joint_.choose_by_plan(i, plans_->groups(), *robots_[i].pieces, now_, step);
  }

  StaticField field_of_pieces(std::size_t i) {
    const double radius = scenario_.robots[i].radius;
    StaticField field(scene_, rules_, radius, anchor(i), anchor(i), HorizonRule::clamped, SeenAs::pieces);
    field.set_margin(plans_->gap_to_obstacles());
    return field;
  }

  void choose_again(std::size_t i, RobotStep& step) {
    if (goes_by_plan(i)) return choose_by_plan(i, step);
    look(i);
    choose(i, step.preferred, step);
  }

  /// The preference, with the consensus term in it where the filter comes last.
  Vec2 wanted_velocity(std::size_t i, const LeaderState& leader) const {
    const Vec2 slotwards =
        preference(spec_, switches_, relative_.position[i], leader.velocity, scenario_.robots[i].max_speed);
    if (!switches_.filter_last) return slotwards;
    return slotwards + consensus_input(spec_, relative_, i, switches_.signs ? -1.0 : 1.0) / spec_.gains.k3;
  }

  Vec2 steered(std::size_t i, RobotBypass::Situation situation, RobotStep& step) {
    const Vec2 wanted = situation.preferred;
    if (!switches_.side_commitment) return wanted;
    const double speed = std::min(norm(wanted), scenario_.robots[i].max_speed);
    const SideCommitment::Answer answer = robots_[i].side.steer(wanted, speed, statics_);
    step.side = answer.side;
    if (answer.side != 0) step.mode = Mode::following;
    situation.preferred = answer.preferred;
    add_note(step.note, answer.note);
    // A robot that others block stands still then, and a plan is made.
    if (plans_ && plans_->is_active(situation.time)) return answer.preferred;
    const std::optional<Vec2> round = robots_[i].bypass.steer(situation, statics_, joint_.others[i], step.note);
    if (!round) return answer.preferred;
    step.mode = Mode::following;
    step.side = RobotBypass::kSide;
    return *round;
  }

  /// What v follows: the filter's answer itself, or, in the paper's order, the sum in which it is one term.
  Vec2 tracked_velocity(std::size_t i, const Step& row) const {
    Vec2 w = row.robots[i].chosen;
    if (!switches_.filter_last)
      w += consensus_input(spec_, relative_, i, switches_.signs ? -1.0 : 1.0) / spec_.gains.k3;
    if (!switches_.absolute_frame) w += row.leader_velocity;
    return bounded_change(i, w);
  }

  /// w drawn towards v so that |k3 (v - w)| keeps the bound. Between two allowed velocities all are allowed; from a
  /// velocity that is not, this may stay outside a half-plane for as long as the bound needs.
  Vec2 bounded_change(std::size_t i, Vec2 w) const {
    if (!(switches_.acceleration_bound > 0.0)) return w;
    const Vec2 v = robots_[i].body.velocity;
    const double most = switches_.acceleration_bound / spec_.gains.k3;
    const double asked = norm(w - v);
    return asked <= most ? w : v + (most / asked) * (w - v);
  }

  /// From where the row was decided.
  void move(const Step& row) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      BodyState& body = robots_[i].body;
      robots_[i].tracked = tracked_velocity(i, row);
      if (tracks_) {
        body = step_body(options_.integrator, body, robots_[i].tracked, decay_);
      } else {
        wheels_.drive(i, robots_[i].tracked);
        body = {body.position + scenario_.time_step * robots_[i].tracked, robots_[i].tracked};
      }
    }
  }

  Step state_row(double time) const {
    Step row;
    row.time = time;
    const LeaderState leader = leader_at(spec_.leader, time);
    row.leader_position = leader.position;
    row.leader_velocity = leader.velocity;
    row.robots.reserve(robots_.size());
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      row.robots.push_back(undecided(robots_[i].body.position, robots_[i].body.velocity));
      if (const WheelsNow* wheels = wheels_.of(i)) row.robots.back().wheels = wheels->state;
    }
    return row;
  }

  bool out_of_bounds() const {
    for (const FormationRobot& r : robots_)
      if (is_out_of_bounds(r.body.position, r.body.velocity)) return true;
    return false;
  }

  void note_divergence(double first, const Step& end, Recording& recording) const {
    const double last = formation_error(end, offsets_);
    recording.diverged = out_of_bounds() || has_diverged(first, error_of_moving(end, offsets_, scenario_.time_step));
    const auto [less, more] =
        first < last ? geometry::told_apart(first, last) : std::pair(number_text(first, 3), number_text(last, 3));
    recording.outcome = recording.diverged ? "diverged: the formation error grew from " + less + " m to " + more + " m"
                                           : "formation error " + metres(last) + " at the end";
    if (plans_) add_words_of_plans(end, recording);
    if (leader_arrival(spec_.leader) > end.time) recording.outcome += "; the leader did not reach its end";
    add_note(recording.outcome, spec_.leader.why_short);
    for (std::size_t i = 0; i < robots_.size(); ++i)
      if (!wheels_.has_room(i) &&
          norm(end.robots[i].position - end.leader_position - offsets_[i]) > scenario_.arrival_tolerance)
        add_note(recording.outcome, scenario_.robots[i].id + " " + WheelsOfRun::kNoRoom);
    if (!tracks_) add_note(recording.outcome, "on wheels no theorem says that robots reach their slots");
    add_note(recording.outcome, assumed_words(scenario_));
  }

  void add_words_of_plans(const Step& end, Recording& recording) const {
    std::vector<std::size_t> not_there;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const Vec2 slot = end.leader_position + offsets_[i];
      const double error = norm(end.robots[i].position - slot);
      if (!(error > scenario_.arrival_tolerance)) continue;
      not_there.push_back(i);
      if (misses_slot(i))
        recording.outcome += "; " + scenario_.robots[i].id + " cannot take its slot, " + printed_place(slot) + ": " +
                             plans_->places()[i].why_not + "; it ends " + metres(error) + " from it";
    }
    add_note(recording.outcome, plans_->groups().no_plan_words(not_there));
  }

  ControllerOptions switches_;
  const Scenario& scenario_;
  DecisionRules rules_;
  const FormationSpec& spec_;
  const SimulationOptions& options_;
  bool tracks_;  ///< not on wheels: these drive at what they choose
  Scene scene_;
  RunSchedule schedule_;
  Decider decider_;
  std::vector<Vec2> offsets_;
  Decay decay_{spec_.gains.k3, scenario_.time_step};
  std::vector<FormationRobot> robots_;
  double now_ = 0.0;                ///< s, of the present row
  std::optional<SlotPlans> plans_;  ///< with Liveness::plan
  std::vector<GoalBodies> goal_bodies_;
  // Memory that a step leaves to the next.
  RelativeState relative_;  ///< of the row that is decided
  WheelsOfRun wheels_;
  ObstacleSpace walls_;  ///< that footprints keep clear of
  JointDecisions joint_;
  NeededConstraints statics_;  ///< of the robot that decides
};

}  // namespace

void run_formation(const Scenario& scenario, const SimulationOptions& options, Recording& recording, RunSink& sink) {
  FormationRun(scenario, options).run(recording, sink);
}

}  // namespace exactvo::formation::detail
