// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where ways end, at last goals (last_places.h) or as near to them as robots can get: places too near to each other
/// for all robots that have them. The first robot there keeps its place for good; the others stop next to it and stay
/// there, instead of pressing for it for ever.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "scene/cells.h"
#include "steering/last_places.h"

namespace exactvo::formation::detail {

/// What of a robot concerns its end.
struct EndNow {
  Vec2 position;          ///< m
  Vec2 end;               ///< m, where its way to its present goal ends
  bool counts = false;    ///< it may be taken
  bool is_last = false;   ///< it goes to no other goal after that, and may take it
  bool is_goal = true;    ///< the goal, not a place as near to it as it can get
  bool is_there = false;  ///< within reach of it
  bool may_rest = false;  ///< it goes by no plan
};

class GoalClaims {
 public:
  /// `horizon`: s, for which half-planes between robots look ahead. `scenario` must outlive it. REQUIRES: robots with
  /// goals.
  GoalClaims(const Scenario& scenario, const RoomAtEnds& room, double horizon);

  /// Before the decisions of a step, an entry a robot. Whether a claim came, or somebody's rest came or went.
  bool look(std::vector<EndNow> now);

  /// The robot that was first at a place too near to its own.
  std::optional<std::size_t> taken_by(std::size_t i) const { return robots_[i].taken_by; }
  /// It stays beside its place, which is taken.
  bool rests(std::size_t i) const { return robots_[i].rests; }
  /// Since this step.
  bool has_come_to_rest(std::size_t i) const { return robots_[i].has_come_to_rest; }

  // REQUIRES of what follows: its place is taken.

  /// The preferred velocity of a robot whose goal is taken. Inside the taken place: out of it. At rest beside it: 0.
  /// Otherwise `preferred`, slowed down so that the half-planes do not push the robot that has taken the place off it.
  Vec2 beside_taken_place(std::size_t i, Vec2 preferred) const;
  /// "R1 was first at its goal, 0.3 m from that of R2, which leaves no room for both".
  std::string words(std::size_t i) const;

  /// What is remembered of a robot from step to step.
  struct OfRobot {
    bool has_claim = false;
    Vec2 place;           ///< m, claimed
    bool is_goal = true;  ///< the claimed place
    std::optional<std::size_t> taken_by = {};
    bool rests = false, has_come_to_rest = false;
    std::size_t seen = 0;  ///< how many claims there were when `taken_by` was found, for `end`
    Vec2 end;
  };
  /// But for `has_come_to_rest`, `seen` and `end`, which follow.
  const std::vector<OfRobot>& remembered() const { return robots_; }
  /// Goes on from there. REQUIRES: one entry for each robot; a robot that has taken a place has a claim.
  void remember(std::vector<OfRobot> robots);

 private:
  template <class PlaceOf>
  std::optional<std::size_t> nearest_in(const Cells<std::size_t>& others, const PlaceOf& place_of, std::size_t i,
                                        Vec2 place) const;
  double gap_beside(double radii) const;
  double gap_to_taken(std::size_t i) const;
  std::optional<Vec2> way_out(std::size_t i) const;
  void claim(std::size_t i);
  struct Resting;
  bool is_beside(std::size_t i, const Resting& resting) const;

  const Scenario& scenario_;
  RoomAtEnds room_;
  double horizon_;  ///< s
  double largest_;  ///< m, the radius
  Cells<std::size_t> claimed_;
  std::size_t claims_ = 0;
  std::vector<OfRobot> robots_;
  std::vector<EndNow> now_;
};

}  // namespace exactvo::formation::detail
