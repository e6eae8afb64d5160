// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A survey of trajectories before they are checked: the numbers of rows and agents, time and extent, the interval
/// between rows, the implied speeds and accelerations, and the bounds beyond which a move is a jump and a pause is a
/// gap. Its memory grows with the number of agents only.
///
/// Speeds, accelerations and bounds are rounded; nothing exact depends on them.

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "exactvo/datasets/trajectory_file.h"
#include "exactvo/geometry/box.h"

namespace exactvo::datasets {

/// Numbers above 0 by their size, eight bins to each doubling.
class LogHistogram {
 public:
  /// Counts a value; one that is not above 0, or not finite, is left out.
  void add(double value);
  /// How many values were counted.
  std::uint64_t count() const { return count_; }
  /// A number that this share of the values does not exceed: the upper end of its bin. REQUIRES: count() > 0.
  double quantile(double share) const;

 private:
  std::map<int, std::uint64_t> bins_;
  std::uint64_t count_ = 0;
};

/// A greatest value and where it was.
struct Extreme {
  double value = 0.0;      ///< rounded
  double time = 0.0;       ///< s, the start of the move
  std::uint64_t line = 0;  ///< of the row at its end; 0: none, or on a curve
};

/// One agent, over all its rows.
struct AgentSurvey {
  std::uint64_t rows = 0;                                     ///< how many there are
  double first = 0.0;                                         ///< s, of the first row
  double last = 0.0;                                          ///< s, of the last row
  Extreme speed;                                              ///< m/s
  Extreme acceleration;                                       ///< m/s^2, from one move to the next
  double heading = std::numeric_limits<double>::quiet_NaN();  ///< rad, of the first row that has one
  std::uint64_t turns_at = 0;                                 ///< the first row with another heading; 0: none
  LogHistogram intervals;                                     ///< s, between rows
};

/// A move from one row of an agent to the next.
struct Move {
  std::size_t agent = 0;                                   ///< its number
  TrajectoryRow from;                                      ///< where it begins
  TrajectoryRow to;                                        ///< where it ends
  double interval() const { return to.time - from.time; }  ///< s
  double speed() const;                                    ///< m/s
};

/// Pairs rows of the same agent as they come.
class Moves {
 public:
  /// The move that ends with this row; false for an agent's first.
  bool next(const TrajectoryRow& row, Move& move);

 private:
  std::vector<TrajectoryRow> last_;
  std::vector<bool> known_;
};

/// The survey of a file.
class TrajectorySurvey {
 public:
  /// Takes rows in the order of the file.
  void add(const TrajectoryRow& row);
  /// Takes a piece of motion. Once one of an agent's is a curve, the greatest speed and acceleration of the agent are
  /// those on its curves, which name no line, instead of those from row to row.
  void add(std::size_t agent, const geometry::Motion& piece);

  /// By number.
  const std::vector<AgentSurvey>& agents() const { return agents_; }
  /// How many rows were taken.
  std::uint64_t rows() const { return rows_; }
  double first() const { return first_; }  ///< s
  double last() const { return last_; }    ///< s
  /// Holds all places, m.
  const geometry::Box& extent() const { return extent_; }
  bool is_in_order() const { return in_order_; }  ///< rows come by time
  /// Whether any row has a heading.
  bool has_headings() const { return has_headings_; }
  /// Whether any row has a velocity.
  bool has_velocities() const { return has_velocities_; }
  double usual_interval() const;  ///< s, the median; 0 where no agent has two rows

  /// m/s: a faster move is a jump. Three times the speed that 95 of 100 moves do not exceed, those of speed 0 left out;
  /// infinite where there are fewer than kLeastMoves.
  double jump_speed() const;
  /// Fewer moves say nothing of the usual speed.
  static constexpr std::uint64_t kLeastMoves = 20;
  /// s: a longer pause between two rows of an agent is a gap. 1.5 times the median of the agent's own intervals, where
  /// it has at least four, else of all.
  double gap_of(std::size_t agent) const;

 private:
  std::vector<AgentSurvey> agents_;
  Moves moves_;
  struct Pace {
    geometry::Vec2 velocity;
    double interval = 0.0;  ///< s; 0: none
    bool on_curves = false;
  };
  std::vector<Pace> paces_;
  LogHistogram intervals_, speeds_;
  std::uint64_t rows_ = 0;
  double first_ = std::numeric_limits<double>::infinity(), last_ = -std::numeric_limits<double>::infinity();
  double latest_ = -std::numeric_limits<double>::infinity();
  geometry::Box extent_;
  bool in_order_ = true, has_headings_ = false, has_velocities_ = false;
};

}  // namespace exactvo::datasets
