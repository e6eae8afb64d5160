// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where ways end, at last goals (last_places.h) or as near to them as robots can get: places too near to each other
/// for all who have them. Who is there first keeps its own for good, the others come beside it and stay there, instead
/// of pressing for it for ever.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "liveness/cells.h"

namespace exactvo::formation::detail {

/// What of a robot concerns its end.
struct EndNow {
  Vec2 position;          ///< m
  Vec2 end;               ///< m, where its way to its present goal ends
  bool is_last = false;   ///< it goes to no other goal after that
  bool is_goal = true;    ///< the goal, not a place as near to it as it can get
  bool is_there = false;  ///< within reach of it
  bool may_rest = false;  ///< it goes by no plan
};

class GoalClaims {
 public:
  /// `scenario` must outlive it. REQUIRES: robots with goals.
  explicit GoalClaims(const Scenario& scenario);

  /// Whether any two of these places are too near to each other; a place a robot.
  bool are_needed(const std::vector<Vec2>& places) const;

  /// Before the decisions of a step, an entry a robot.
  void look(std::vector<EndNow> now);

  /// Who was first at a place too near to its own.
  std::optional<std::size_t> taken_by(std::size_t i) const { return robots_[i].taken_by; }
  /// It stays beside its place, which is taken.
  bool rests(std::size_t i) const { return robots_[i].rests; }
  /// Since this step.
  bool has_come_to_rest(std::size_t i) const { return robots_[i].has_come_to_rest; }

  // REQUIRES of what follows: its place is taken.

  /// Where it goes to leave the taken place to who has it; nothing where it does.
  std::optional<Vec2> way_out(std::size_t i) const;
  /// So slowly that half-planes do not push off its place who has taken it.
  Vec2 slowed(std::size_t i, Vec2 preferred) const;
  /// "R1 was first at its goal, 0.3 m from that of R2, which leaves no room for both".
  std::string words(std::size_t i) const;

 private:
  struct OfRobot {
    bool has_claim = false;
    Vec2 place;           ///< m, claimed
    bool is_goal = true;  ///< the claimed place
    std::optional<std::size_t> taken_by = {};
    bool rests = false, has_come_to_rest = false;
  };
  template <class PlaceOf>
  std::optional<std::size_t> nearest_in(const Cells<std::size_t>& others, const PlaceOf& place_of, std::size_t i,
                                        Vec2 place) const;
  double gap_beside(double radii) const;
  double gap_to_taken(std::size_t i) const;
  bool is_beside(std::size_t i, const Cells<std::size_t>& resting) const;

  const Scenario& scenario_;
  double largest_;  ///< m, the radius
  Cells<std::size_t> claimed_;
  std::vector<OfRobot> robots_;
  std::vector<EndNow> now_;
};

}  // namespace exactvo::formation::detail
