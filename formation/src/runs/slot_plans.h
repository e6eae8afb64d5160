// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Robots of a formation that block each other's slots go by joint plans once the leader rests (liveness, rules R2 to
/// R4). What is planned are their brake points x + v/k3, which move at exactly the chosen velocity, as kinematic robots
/// do; the bodies follow behind. Heuristic, as all plans are: half-planes decide, and an audit proves the motion.
///
/// A robot whose slot cannot be filled then goes to a place beside it instead of pressing for it for ever: where an
/// obstacle stands in the slot, or so near that the robot's margin keeps it off, where no way leads to it, or where
/// another robot has a slot too near.

#include <functional>
#include <string>
#include <vector>

#include "decision/decision.h"
#include "liveness/groups.h"
#include "motion/leader.h"
#include "reach/reachability.h"
#include "scene/free_space.h"

namespace exactvo::formation::detail {

class SlotPlans {
 public:
  /// Scenario and rules must outlive it. `offsets`: m, of the slots from the leader. `is_stopped`: as in Groups.
  /// REQUIRES: a formation.
  SlotPlans(const Scenario& scenario, const DecisionRules& rules, std::vector<Vec2> offsets,
            std::function<bool()> is_stopped);
  SlotPlans(const SlotPlans&) = delete;  // groups refer to members

  /// m: what brake points of pairs that fall back, and of robots of a plan and others, keep between the rims. The
  /// bodies behind them cut corners by less, where k3 is large.
  double gap() const { return gap_; }
  /// m: what robots that go by plan keep from obstacles.
  double gap_to_obstacles() const { return gap_to_obstacles_; }

  /// Whether plans are made: once the leader has come to its end, for good.
  bool is_active(double time) const { return time >= leader_arrival_; }

  void begin_step(double time, const std::vector<Anchor>& anchors, const LeaderState& leader);

  /// Where a robot goes once the leader rests.
  struct Place {
    Vec2 at;              ///< m: its slot, or about the nearest place to it that is free and in reach
    std::string why_not;  ///< the slot cannot be filled: "obstacle 'block' stands in it". Empty where it is its slot
  };
  /// The place of each robot; empty until the leader rests.
  const std::vector<Place>& places() const { return places_; }

  Groups& groups() { return groups_; }
  const Groups& groups() const { return groups_; }

 private:
  void choose_places(const std::vector<Anchor>& anchors, Vec2 leader);
  /// m: a little more than the clearance that half-planes let it keep.
  double room_of(std::size_t robot) const;
  std::string why_no_place(std::size_t robot, Vec2 from, Vec2 slot, Reachability& reach) const;
  Vec2 off_the_wall(std::size_t robot, Vec2 slot) const;
  void shift_off_the_wall(std::size_t i);
  Vec2 free_place_near(std::size_t robot, Vec2 from, Vec2 slot, const std::vector<geometry::Disc>& taken,
                       Reachability& reach) const;

  const Scenario& scenario_;
  std::vector<Vec2> offsets_;
  double leader_arrival_;  ///< s
  double tolerance_;       ///< m
  double gap_, gap_to_obstacles_;
  std::vector<Robot> larger_;  ///< the robots, larger by what they keep from obstacles
  ObstacleSpace space_;
  Groups groups_;
  std::vector<Place> places_;
};

}  // namespace exactvo::formation::detail
