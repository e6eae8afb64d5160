// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Robots of a formation that block each other's slots go by joint plans once the leader rests (liveness, rules R2 to
/// R4). What is planned are their brake points x + v/k3, which move at exactly the chosen velocity, as kinematic robots
/// do; the bodies follow behind. Heuristic, as all plans are: half-planes decide, and an audit proves the motion.

#include <functional>
#include <string>
#include <vector>

#include "decision/decision.h"
#include "liveness/groups.h"
#include "motion/leader.h"
#include "scene/free_space.h"

namespace exactvo::formation::detail {

class SlotPlans {
 public:
  /// `offsets`: m, of the slots from the leader. `is_stopped`: as in Groups. REQUIRES: a formation.
  SlotPlans(const Scenario& scenario, std::vector<Vec2> offsets, int threads, std::function<bool()> is_stopped);
  SlotPlans(const SlotPlans&) = delete;  // groups refer to members

  /// m: what brake points of pairs that fall back, and of robots of a plan and others, keep between the rims. The
  /// bodies behind them cut corners by less, where k3 is large.
  double gap() const { return gap_; }
  /// m: what robots that go by plan keep from obstacles.
  double gap_to_obstacles() const { return gap_to_obstacles_; }

  /// Whether plans are made: once the leader has come to its end, for good.
  bool is_active(double time) const { return time >= leader_arrival_; }

  void begin_step(double time, const std::vector<Anchor>& anchors, const LeaderState& leader);

  Groups& groups() { return groups_; }
  const Groups& groups() const { return groups_; }

 private:
  bool has_place(std::size_t robot, Vec2 slot) const;

  std::vector<Vec2> offsets_;
  double leader_arrival_;  ///< s
  double tolerance_;       ///< m
  double gap_, gap_to_obstacles_;
  Scenario larger_;  ///< with robots larger by what they keep from obstacles
  ObstacleSpace space_;
  Groups groups_;
  std::vector<char> has_place_;  ///< whether nothing stands in its slot; empty until the leader rests
};

}  // namespace exactvo::formation::detail
