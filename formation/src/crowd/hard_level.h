// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The second level of a step: from what each robot wishes to a motion that keeps all robots apart. Exact.
///
/// The first level (half-planes between neighbours, relaxed where they contradict each other) says what each robot
/// wishes. Then, for every pair that could meet within the step (and does not overlap by more than `kRoundedContact`),
/// `pair_rows` makes two half-planes of motions that rest satisfies. A robot takes its wish if that satisfies its rows;
/// else the motion nearest to it, found in doubles and accepted only by the integer test of every row; else rest. So
/// whatever the wishes, the density and the rounding are, two robots that do not overlap at the beginning of a step do
/// not overlap at any moment of it (lemmas of pair_row.h).
///
/// A second round repeats this from the motions of the first on, for robots whose wish was cut short: what their
/// neighbours did not use is shared out again.

#include <cstdint>
#include <vector>

#include "crowd/one_robot.h"
#include "crowd/pair_row.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::formation {

/// What the second level looks up of each kind, lattice steps.
struct StepsOfKind {
  std::int64_t radius = 0;     ///< rounded up
  double reach = 0.0;          ///< farther than this no robot can be met within the step
  double squared_speed = 0.0;  ///< (max_speed dt / q)^2, rounded down
};

/// Of a thread.
struct HardBuffers {
  std::vector<crowd::MotionRow> rows;
  std::vector<double> x, y, offset;  ///< of the linear program
  lp::Solution answer;
};

template <class T>
class HardLevel {
 public:
  HardLevel(const CrowdCore& crowd, const crowd::KindTable<T>& table, const OneRobot<T>& one)
      : crowd_(crowd), table_(table), one_(one) {}

  void take_kinds();

  /// The motion of a robot whose wish, and those of all robots near it, stand in Robots::wish_mx and wish_my. `round`:
  /// 0: from rest on; 1: from Robots::safe_mx and safe_my on.
  crowd::Motion decide(std::size_t robot, int round, HardBuffers& b, OneRobotBuffers<T>& one, StepReport& counts) const;

 private:
  crowd::Motion wish_of(std::size_t robot) const;
  crowd::Motion safe_of(std::size_t robot, int round) const;
  bool put_rows(std::size_t robot, int round, HardBuffers& b, StepReport& counts) const;
  void put_row(std::size_t robot, std::size_t other, int round, HardBuffers& b, bool& found) const;
  crowd::Motion nearest(std::size_t robot, crowd::Motion safe, HardBuffers& b, OneRobotBuffers<T>& one) const;
  crowd::Motion shortened(std::size_t robot, crowd::Motion safe, const HardBuffers& b, OneRobotBuffers<T>& one) const;
  crowd::Motion rounded(std::size_t robot, crowd::Motion safe, std::size_t obstacles, const HardBuffers& b,
                        const OneRobotBuffers<T>& one) const;

  const CrowdCore& crowd_;
  const crowd::KindTable<T>& table_;
  const OneRobot<T>& one_;
  std::vector<StepsOfKind> kinds_;
};

}  // namespace exactvo::formation
