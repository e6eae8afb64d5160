// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The wheels of the robots of a run: what they may do and how they stand. Runs with goals and formations drive alike.

#include <cstddef>
#include <optional>
#include <vector>

#include "decision/decision.h"
#include "exactvo/formation/recording.h"
#include "motion/differential.h"
#include "scene/chain.h"
#include "scene/decision_rules.h"
#include "scene/free_space.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {

class WheelsOfRun {
 public:
  static constexpr const char* kNoRoom =
      "has no room between obstacles to turn its footprint towards where it wants to go";

  /// Both must outlive it.
  WheelsOfRun(const std::vector<Robot>& robots, const DecisionRules& rules)
      : robots_(robots), rules_(rules), has_room_(robots.size(), 1) {
    for (const Robot& robot : robots)
      limits_.push_back(
          robot.drive ? std::optional<WheelLimits>(std::in_place, *robot.drive, rules.time_step, rules.braking_time)
                      : std::nullopt);
    for (std::size_t i = 0; i < robots.size(); ++i)
      now_.push_back({limits_[i] ? &*limits_[i] : nullptr,
                      {robots[i].drive ? heading_vector(robots[i].drive->heading) : Vec2{}, {}}});
  }
  WheelsOfRun(const WheelsOfRun&) = delete;  // what it hands out refers to members
  WheelsOfRun& operator=(const WheelsOfRun&) = delete;

  /// Null for a robot without wheels.
  const WheelsNow* of(std::size_t i) const { return limits_[i] ? &now_[i] : nullptr; }
  /// Whether the footprint had room to turn as the robot wanted, in its last choice.
  bool has_room(std::size_t i) const { return has_room_[i] != 0; }

  /// What it is to prefer instead of `preferred` (motion/differential.h, `turned_aside`); without wheels the same.
  Vec2 aside(std::size_t i, Vec2 preferred) const {
    return limits_[i] ? turned_aside(now_[i].state.heading, preferred) : preferred;
  }

  /// By the twist that takes its reference point on by a step of `u`. REQUIRES: it has wheels.
  void drive(std::size_t i, Vec2 u) {
    OnWheels& state = now_[i].state;
    const TwistOfStep twist = twist_of(*robots_[i].drive, rules_.time_step, state.heading, u);
    state = {turned(state.heading, twist.turn), twist.wheels};
  }

  /// What robot i chooses where it prefers `wish`: `decide` fills `step` for a preferred velocity. On wheels the twist
  /// keeps their limits, and the body has room to turn (`keep_wheels_within_limits`).
  template <class Decide>
  void choose(std::size_t i, Vec2 wish, const Anchor& at, const FreeSpace& space, RobotStep& step,
              const Decide& decide) {
    decide(wish);
    if (!limits_[i]) return;
    bool has_room = true;
    keep_wheels_within_limits(now_[i], rules_.braked(at.velocity), step, decide, [&](Vec2 u) {
      const bool is_clear =
          links_are_clear(space, *robots_[i].drive, at.position, now_[i].state.heading, u, rules_.braking_time);
      has_room = has_room && is_clear;
      return is_clear;
    });
    if (!has_room && has_room_[i]) add_note(step.note, kNoRoom);
    step.lacks_room_to_turn = !has_room;
    has_room_[i] = has_room;
  }

 private:
  const std::vector<Robot>& robots_;
  const DecisionRules& rules_;
  std::vector<std::optional<WheelLimits>> limits_;
  std::vector<WheelsNow> now_;
  std::vector<char> has_room_;
};

}  // namespace exactvo::formation::detail
