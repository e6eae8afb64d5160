// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the robots of a run decide with regard to each other: half-planes of pairs, motion along joint plans, and
/// repair (liveness, rules R0 and R4). Both kinds of run go through it alike.

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "decision/decision.h"
#include "decision/sides.h"
#include "liveness/groups.h"
#include "runs/run_schedule.h"

namespace exactvo::formation::detail {

class JointDecisions {
 public:
  /// Where robot i is, and how fast.
  using ViewpointOf = std::function<Viewpoint(std::size_t i)>;
  /// Robot i decides again with `others[i]` as they are now.
  using ChooseAgain = std::function<void(std::size_t i, RobotStep& step)>;

  /// All must outlive it.
  JointDecisions(const DecisionRules& rules, const std::vector<Robot>& robots, Scene& scene,
                 const RunSchedule& schedule, Decider& decider, ViewpointOf viewpoint, ChooseAgain choose_again)
      : eases(robots.size(), 0),
        rules_(rules),
        robots_(robots),
        scene_(scene),
        schedule_(schedule),
        decider_(decider),
        viewpoint_(std::move(viewpoint)),
        choose_again_(std::move(choose_again)),
        held_by_all_(robots.size(), 0),
        brakes_(robots.size(), 0) {}

  // One entry for each robot, in their order:

  std::vector<Anchor> anchors;                  ///< where half-planes of this step are built
  std::vector<std::vector<Constraint>> others;  ///< its half-planes against robots and moving obstacles
  std::vector<char> eases;                      ///< `RobotsAt::eases`: none, unless the run says so
  double gap = kContactSkin;  ///< m, that pairs keep of which one goes by plan, and pairs that fall back at least

  /// Takes the robots as they are.
  void begin_step();

  /// Whether it keeps to what braking satisfies, as its other half-planes contradicted each other in this step: then it
  /// looks at static obstacles from `braked`.
  bool brakes(std::size_t i) const { return brakes_[i] != 0; }
  /// The place from which half-planes are made that braking satisfies.
  Viewpoint braked(Viewpoint here) const { return after_braking(rules_, here); }

  /// Half-planes of robots against robots, as they are or as plans have them. `groups`: null without plans.
  void look_at_robots(const Groups* groups);

  /// The same where robots measure each other.
  void look_at_measured(const std::vector<std::vector<MeasuredRobot>>& measured) {
    own_side_constraints(now(), measured, others);
  }

  /// For a method that promises nothing between robots: replaces the half-planes against the others by those that
  /// leave the robot the velocity nearest to its preferred one.
  void take_sides(std::size_t i, Vec2 preferred) { formation::detail::take_sides(now(), i, preferred, others[i]); }

  /// Along the plan, as fast as all half-planes allow. Those of `field` have one time step as their horizon, so that
  /// they hold the planned velocity back no more than safety requires.
  void choose_by_plan(std::size_t i, const Groups& groups, const StaticField& field, double time, RobotStep& step);

  /// Once all have decided: half-planes that contradict each other are repaired, groups that are held back are halted,
  /// whereupon all decide again, and the groups hear how the step ended. `groups`: null without any.
  void settle(Groups* groups, Step& row);

 private:
  RobotsAt now() const { return {rules_, robots_, anchors, scene_, &eases}; }
  void repair(const Groups* groups, Step& row);
  void record_both_halves(const std::vector<std::vector<std::size_t>>& fallen, Step& row) const;

  const DecisionRules& rules_;
  const std::vector<Robot>& robots_;
  Scene& scene_;
  const RunSchedule& schedule_;
  Decider& decider_;
  ViewpointOf viewpoint_;
  ChooseAgain choose_again_;
  std::vector<char> held_by_all_;  ///< of those who go by plan: no share of what they want is allowed
  std::vector<char> brakes_;       ///< of robots with an acceleration
  PairMemory pairs_;
  std::vector<Constraint> statics_;  ///< of one who goes by plan; memory that is kept
};

}  // namespace exactvo::formation::detail
