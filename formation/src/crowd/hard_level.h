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

#include "crowd/few_rows.h"
#include "crowd/near_pairs.h"
#include "crowd/one_robot.h"
#include "crowd/pair_row.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::formation {

/// One per thread.
struct HardBuffers {
  crowd::NearPairs near;
  std::vector<std::uint64_t> order;  ///< of a robot's pairs: the place of the other, the pair, whether it is b of it
  std::vector<crowd::MotionRow> rows;
  crowd::FewRows few;
  std::size_t robots_of_few[crowd::FewRows::kLanes];
  std::vector<double> x, y, offset;  ///< of the linear program
  lp::Solution answer;
};

template <class T>
class HardLevel {
 public:
  HardLevel(const CrowdCore& crowd, const crowd::KindTable<T>& table, const OneRobot<T>& one)
      : crowd_(crowd), table_(table), one_(one) {}

  void take_kinds();

  /// The motions of robots, into `to_x` and `to_y` by robot. Their wishes, and those of all robots near them, stand in
  /// Robots::wish_mx and wish_my. `round`: 0: from rest on; says in Robots::next_kept which have met another; 1: from
  /// Robots::safe_mx and safe_my on, and says which are cut short. `lists`: of these robots.
  void decide(std::size_t first, std::size_t last, int round, crowd::NearLists& lists, HardBuffers& b,
              OneRobotBuffers<T>& one, StepReport& counts, crowd::Robots& robots, std::int32_t* to_x,
              std::int32_t* to_y) const;

 private:
  crowd::Motion wish_of(std::size_t robot) const;
  crowd::Motion safe_of(std::size_t robot, int round) const;
  void find_cut(std::size_t first, std::size_t last, int round, crowd::NearLists& lists, HardBuffers& b,
                crowd::Robots& robots) const;
  crowd::Motion within_rows(std::size_t robot, crowd::Motion safe, crowd::Few found, crowd::Motion few, HardBuffers& b,
                            OneRobotBuffers<T>& one) const;
  bool add_few(std::size_t robot, HardBuffers& b) const;
  double squared_way(std::size_t robot) const;
  crowd::Motion shortened(std::size_t robot, crowd::Motion safe, const HardBuffers& b, OneRobotBuffers<T>& one) const;
  std::size_t solve(std::size_t robot, HardBuffers& b, OneRobotBuffers<T>& one) const;
  crowd::Motion rounded(std::size_t robot, crowd::Motion safe, crowd::Motion first, std::size_t obstacles,
                        const HardBuffers& b, const OneRobotBuffers<T>& one) const;

  const CrowdCore& crowd_;
  const crowd::KindTable<T>& table_;
  const OneRobot<T>& one_;
  std::vector<crowd::StepsOfKind> kinds_;
};

}  // namespace exactvo::formation
