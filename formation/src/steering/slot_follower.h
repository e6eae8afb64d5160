// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Going round robots that stand between a robot and its slot (how slots are kept is control/consensus.h): three robots
/// whose slots are filled in the wrong order press against each other for ever, since each half of a pair yields only
/// as much as it is pressed.
///
/// Heuristic; ties go left. Touches no half-plane: what comes out is a preference.

#include "decision/decision.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {

class SlotFollower {
 public:
  struct Situation {
    double time = 0.0;          ///< s
    double distance = 0.0;      ///< m, to the slot or goal
    double tolerance = 0.0;     ///< m: within this there is nothing to go round for
    double pace = 0.0;          ///< m/s: what closing in at full effort would be
    bool target_rests = false;  ///< a slot that moves away is no stall
    Vec2 preferred;             ///< m/s
  };
  struct Answer {
    Vec2 preferred;
    Mode mode = Mode::direct;
    int side = 0;
    std::string note;
  };
  /// Mode::following with the turned preference while going round; Mode::direct otherwise.
  Answer steer(const Situation& s, const std::vector<Constraint>& statics, const std::vector<Constraint>& others);

 private:
  bool stalled(const Situation& s);

  bool following_ = false;
  int side_ = 0;
  double hit_distance_ = 0.0;    ///< m, to the slot, where following began
  double best_distance_ = -1.0;  ///< m, least so far
  double best_time_ = 0.0;       ///< s, when that was reached
};

}  // namespace exactvo::formation::detail
