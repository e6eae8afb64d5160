// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A sequence of single moves, and how it is driven by all at once (liveness, rules R3 and R4).
///
/// A move need only wait for those earlier ones whose sweep comes near its own. While it waits it goes as far as its
/// sweep stays clear of all that these have still to sweep. Then all distances stay as the sequence has them, and the
/// earliest move that is not done is never held back (lemma 3 of docs/guide/liveness.md).

#include <cstddef>
#include <vector>

#include "liveness/joint_search.h"

namespace exactvo::formation::detail {

struct PlannedMove {
  std::size_t robot = 0;                ///< among the plan's robots
  Vec2 from, to;                        ///< m
  std::vector<std::size_t> after = {};  ///< of each robot the last earlier move that it must keep clear of
};

/// The moves without those of robots that came back to a place where nobody came meanwhile: they have stayed there.
/// `radii`: m, of the robots.
std::vector<JointMove> without_loops(const Roadmap& map, std::vector<JointMove> moves,
                                     const std::vector<double>& radii);

/// The same moves; each knows what it waits for.
std::vector<PlannedMove> plan_of(const Roadmap& map, const std::vector<JointMove>& moves,
                                 const std::vector<double>& radii);

/// Where robots are on a plan.
class Following {
 public:
  Following(std::vector<PlannedMove> plan, std::vector<double> radii);

  const std::vector<PlannedMove>& plan() const { return plan_; }
  std::size_t moves_left() const { return left_; }
  /// Whether the robot has no moves left.
  bool is_there(std::size_t robot) const { return next_[robot] == of_robot_[robot].size(); }

  /// Takes note of moves that are done. `at`: m, where the robots are.
  void advance(const std::vector<Vec2>& at);

  /// m: as far as the robot may go at once along its present move; where it is if it has none.
  Vec2 within_reach(std::size_t robot, const std::vector<Vec2>& at) const;

 private:
  bool is_done(std::size_t move) const { return rank_[move] < next_[plan_[move].robot]; }
  bool may_finish(std::size_t move) const;
  double clear_share(std::size_t move, std::size_t earlier, double share, const std::vector<Vec2>& at) const;

  std::vector<PlannedMove> plan_;
  std::vector<double> radii_;
  std::vector<std::vector<std::size_t>> of_robot_;  ///< its moves
  std::vector<std::size_t> next_;                   ///< of its moves, the present one
  std::vector<std::size_t> rank_;                   ///< of each move among its robot's
  std::size_t left_ = 0;
};

}  // namespace exactvo::formation::detail
