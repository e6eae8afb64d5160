// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How one robot decides by itself, without a route: it looks at the static obstacles, forms a preferred velocity and
/// chooses. Simulated robots (kinematic_run.cpp) and navigators (navigator.h) go through it alike.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "decision/decision.h"
#include "decision/needed_constraints.h"
#include "scene/static_field.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {

/// What a robot keeps from one decision to the next.
struct OwnWay {
  std::optional<StaticField> field;  ///< for its present goal
  BoundaryFollower follower;
  bool tied = false;  ///< the last preference was turned to break a tie

  /// Another goal: the obstacles are seen anew, and whatever was followed is forgotten.
  void head_for(Vec2 goal, Scene& scene, const DecisionRules& rules, double radius, Vec2 start) {
    field.emplace(scene, rules, radius, start, goal, HorizonRule::clamped);
    follower.reset();
  }
};

/// Where a robot is and wants to go.
struct Errand {
  double time = 0.0;  ///< s
  Viewpoint here;
  Vec2 goal;  ///< m
  bool has_arrived = false;
  double acceleration = geometry::kInfinity;  ///< m/s^2
};

/// That it heads for goal number `next` (from 0) from now on.
std::string passed_goal_words(std::size_t next);

/// Decides for one robot after the other, in memory of its own: `look`, `steer`, `choose`.
class OwnDecision {
 public:
  /// Both must outlive it.
  OwnDecision(const DecisionRules& rules, const vo::BodyTable& bodies) : rules_(rules), decider_(rules, bodies) {}

  /// Room for this many static bodies and other ones within reach: decisions among them allocate nothing.
  void reserve(std::size_t statics, std::size_t others);

  /// At the static obstacles.
  void look(const StaticField& field, const Viewpoint& here);

  // REQUIRES of what follows: it has looked, and nobody after it.

  /// What was seen so far, nearest first. It grows as far as decisions need it.
  const std::vector<Constraint>& statics() const { return needed_.lines(); }
  bool is_in_contact() const { return !statics().empty() && statics().front().clearance < 0.0; }

  /// The preferred velocity, by the run's method; sets `mode` and `side` and adds to `note`.
  Vec2 steer(OwnWay& way, const Errand& errand, Decision& decision);

  /// What it chooses goes on the record. `others`: robots and moving obstacles; `own`: what the user asks for.
  void choose(Vec2 preferred, const Viewpoint& here, const std::vector<Constraint>& others, bool keep_all,
              const std::vector<OwnConstraint>& own, RobotStep& step) {
    DecisionInput in = input(preferred, here, others, keep_all);
    in.own = &own;
    decider_.decide(in, step);
  }
  /// The same into a list.
  void choose(Vec2 preferred, const Viewpoint& here, const std::vector<Constraint>& others, Decision& decision,
              std::vector<DecisionConstraint>& kept) {
    decider_.decide(input(preferred, here, others, false), decision);
    decider_.kept(kept);
  }

  Decider& decider() { return decider_; }

 private:
  DecisionInput input(Vec2 preferred, const Viewpoint& here, const std::vector<Constraint>& others, bool keep_all);
  Vec2 ties_broken(OwnWay& way, Vec2 preferred, Decision& decision);

  const DecisionRules& rules_;
  Decider decider_;
  NeededConstraints needed_;
  BoundaryFollower::Memory following_;
};

}  // namespace exactvo::formation::detail
