// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Rows of trajectories into pieces of motion, in the order in which a MotionStream takes them. A piece is known when
/// its second row comes, so it waits until no other agent can have one that begins earlier.

#include <functional>
#include <limits>
#include <queue>
#include <vector>

#include "exactvo/datasets/trajectory_survey.h"
#include "exactvo/geometry/motion_check.h"

namespace exactvo::tools {

class PieceFeed {
 public:
  struct Options {
    geometry::Between between = geometry::Between::straight;
    /// s: where an agent has no row for longer, it is not there.
    double longest_gap = std::numeric_limits<double>::infinity();
  };
  using Take = std::function<void(std::size_t agent, const geometry::StraightMotion& piece)>;

  /// `agents`: of the survey, which knows each agent's last row. They must outlive the feed.
  PieceFeed(const std::vector<datasets::AgentSurvey>& agents, const Options& options, Take take);

  /// REQUIRES: rows by time.
  void add(const datasets::TrajectoryRow& row);
  /// Hands on what still waits.
  void finish();

 private:
  struct Agent {
    geometry::TimedPoint last;
    std::uint64_t rows = 0;
    bool is_open = false;  ///< a piece that begins at `last` may follow
  };
  struct Waiting {
    geometry::StraightMotion piece;
    std::size_t agent;
    std::uint64_t number;
    friend bool operator>(const Waiting& a, const Waiting& b) {
      return std::tie(a.piece.from.time, a.agent, a.number) > std::tie(b.piece.from.time, b.agent, b.number);
    }
  };
  using Begin = std::pair<double, std::size_t>;

  void put(std::size_t agent, const geometry::StraightMotion& piece);
  /// Ends a stay: of one row, and of data that is held, its last row is a piece of its own.
  void close(std::size_t agent, bool is_alone);
  void hand_on(double now);

  const std::vector<datasets::AgentSurvey>& surveys_;
  Options options_;
  Take take_;
  std::vector<Agent> agents_;
  std::vector<bool> has_piece_;  ///< since the agent was last away
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
  std::priority_queue<Begin, std::vector<Begin>, std::greater<>> begins_;  ///< when open agents were seen last
  std::uint64_t count_ = 0;
};

}  // namespace exactvo::tools
