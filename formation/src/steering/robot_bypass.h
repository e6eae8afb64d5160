// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Going round robots that stand between a robot and its slot (how slots are kept is control/consensus.h): three robots
/// whose slots are filled in the wrong order press against each other for ever, since each half of a pair yields only
/// as much as it is pressed.
///
/// Heuristic; ties go left. Touches no half-plane: what comes out is a preference.

#include <optional>
#include <string>
#include <vector>

#include "decision/decision.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {

class RobotBypass {
 public:
  struct Situation {
    double time = 0.0;          ///< s
    double moment = 1.0;        ///< s, `detail::moment`
    double distance = 0.0;      ///< m, to the slot or goal
    double tolerance = 0.0;     ///< m: within this there is nothing to go round for
    double pace = 0.0;          ///< m/s: what closing in at full effort would be
    bool target_rests = false;  ///< a slot that moves away is no stall
    Vec2 preferred;             ///< m/s
  };
  /// The side on which robots are passed, as in RobotStep::side: left.
  static constexpr int kSide = 1;

  /// m/s, what to prefer while going round; nothing otherwise. Says in `note` when that begins and ends.
  std::optional<Vec2> steer(const Situation& s, NeededConstraints& statics, const std::vector<Constraint>& others,
                            std::string& note);

 private:
  bool stalled(const Situation& s);

  bool goes_round_ = false;
  double hit_distance_ = 0.0;    ///< m, to the slot, where going round began
  double best_distance_ = -1.0;  ///< m, least so far
  double best_time_ = 0.0;       ///< s, when that was reached
};

}  // namespace exactvo::formation::detail
