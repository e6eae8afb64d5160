// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is known of robots at the beginning of a step, and which joint plans were made in vain: for the same robots
/// with the same goals again and again, while nothing else has moved.

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// In diameters: counts as coming nearer to a goal.
inline constexpr double kNearer = 0.4;

/// A robot at the beginning of a step.
struct RobotNow {
  Vec2 position;                ///< m
  Vec2 goal;                    ///< m: the present one, the nearest place to it that is in reach, or where it stays
  bool has_arrived = false;     ///< at its last goal, or as near to it as it will come by itself
  bool may_join = false;        ///< plans may move it: it cooperates, and has room where it is
  std::size_t goal_number = 0;  ///< which of its goals is the present one
  bool yields = false;          ///< others have their goals before it: its own is taken or out of reach
};

/// s, that the slowest robot needs for its diameter.
double patience_of(const std::vector<Robot>& robots);

class PlanTries {
 public:
  /// Plans for which the same robots waited, with the same goals: beyond that they are in vain, and there are longer
  /// and longer pauses between them.
  static constexpr int kMost = 10;

  /// Both must outlive it.
  PlanTries(const std::vector<Robot>& robots, const std::vector<MovingObstacle>& moving)
      : robots_(robots), moving_(moving), patience_(patience_of(robots)) {}

  /// Whether a plan for the robots in `who` has to wait. `time`: s.
  bool are_in_vain(double time, const std::vector<RobotNow>& now, const std::vector<std::size_t>& who) const;
  /// A plan was made for them.
  void count(double time, const std::vector<RobotNow>& now, const std::vector<std::size_t>& who);

 private:
  /// Robots that were not where they were to go, and the numbers of their goals.
  using Waiting = std::pair<std::vector<std::size_t>, std::vector<std::size_t>>;
  /// m: where moving obstacles are, and robots that no plan moves, by their numbers.
  using Others = std::vector<std::pair<std::size_t, Vec2>>;
  struct Tries {
    int number = 0;
    double last = 0.0;  ///< s
    double left = 0.0;  ///< m, to their goals, straight, all together, when the tries began
    Others others{};    ///< then
  };
  /// The robots that wait, and what could change that.
  struct Look {
    Waiting waiting;
    double left = 0.0;  ///< m
    Others others;
  };

  Look look(double time, const std::vector<RobotNow>& now, const std::vector<std::size_t>& who) const;
  bool has_changed_since(const Tries& tries, const Look& look) const;

  const std::vector<Robot>& robots_;
  const std::vector<MovingObstacle>& moving_;
  double patience_;  ///< s
  std::map<Waiting, Tries> tries_;
};

}  // namespace exactvo::formation::detail
