// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Rows of trajectories into pieces of motion, in the order in which a geometry::MotionStream takes them.

#include <functional>
#include <limits>
#include <queue>
#include <vector>

#include "exactvo/datasets/trajectory_survey.h"
#include "exactvo/geometry/motion_check.h"

namespace exactvo::datasets {

/// Makes pieces of rows. A piece is known when its second row comes (of a Catmull-Rom spline, its third), so it waits
/// until no other agent can have one that begins earlier.
class TrajectoryPieces {
 public:
  /// What lies between rows.
  struct Options {
    /// `cubic` takes the rows' velocities; where a row has none, that of a Catmull-Rom spline, and of the chord at the
    /// first and the last row of a stay.
    geometry::Between between = geometry::Between::straight;
    double longest_gap =
        std::numeric_limits<double>::infinity();  ///< s: an agent without a row for longer counts as absent
  };
  /// Gets an agent's number, its next piece, and how the agent is turned: by its headings, evenly from one row to the
  /// next by less than half a turn (of `hold` and `none` not between rows). A row without a heading has that of
  /// the row before; rows before the first heading have this one. Cubics and polynomials have headings at their start
  /// only.
  using Take = std::function<void(std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned)>;

  /// `agents`: of the survey, which knows how many rows each agent has. They must outlive this object.
  TrajectoryPieces(const std::vector<AgentSurvey>& agents, const Options& options, Take take);

  /// REQUIRES: rows by time.
  void add(const TrajectoryRow& row);
  /// Hands on the pieces that still wait.
  void finish();

 private:
  /// A row, and the velocity there.
  struct Knot {
    geometry::TimedPoint point;
    geometry::Vec2 velocity;
    double heading = 0.0;
  };
  struct Agent {
    TrajectoryRow last;
    double heading = 0.0;  ///< rad, at `last`
    Knot before{};         ///< where a cubic begins that ends at `last`
    std::uint64_t rows = 0;
    bool is_open = false;    ///< a piece that begins at `last` may follow
    bool has_cubic = false;  ///< from `before` to `last`: its last velocity is not known yet
    bool has_piece = false;  ///< since the agent was last away
    double begin() const { return has_cubic ? before.point.time : last.time; }
  };
  struct Waiting {
    geometry::Motion piece;
    geometry::Turned turned;
    double begin;
    std::size_t agent;
    std::uint64_t number;
    friend bool operator>(const Waiting& a, const Waiting& b) {
      return std::tie(a.begin, a.agent, a.number) > std::tie(b.begin, b.agent, b.number);
    }
  };
  using Begin = std::pair<double, std::size_t>;

  void put(std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned);
  /// From the agent's last row to this one.
  void go_on(std::size_t agent, const TrajectoryRow& row, double heading);
  void put_cubic(std::size_t agent, geometry::Vec2 end_velocity);
  /// Ends a stay. If it has one row, or the data is held, its last row is a piece of its own.
  void close(std::size_t agent);
  void hand_on(double now);

  const std::vector<AgentSurvey>& surveys_;
  Options options_;
  Take take_;
  std::vector<Agent> agents_;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
  std::priority_queue<Begin, std::vector<Begin>, std::greater<>> begins_;  ///< of what open agents may still have
  std::uint64_t count_ = 0;
};

/// Reads a surveyed file once more. `look` gets each row by time (sorted in memory where the file is not in order), and
/// may move it; `take` gets the pieces of all agents by the time at which they begin: those between rows, or the curves
/// of a file of polynomials. Throws DataError.
void for_each_piece(TrajectoryReader& reader, const TrajectorySurvey& survey, const TrajectoryPieces::Options& options,
                    const std::function<void(TrajectoryRow&)>& look, const TrajectoryPieces::Take& take);

}  // namespace exactvo::datasets
