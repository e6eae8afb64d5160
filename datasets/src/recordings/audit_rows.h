// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The rows of an audited run, which come one after the other and only once: of those that have been checked it is
/// known where robots were.

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

using SharedRow = std::shared_ptr<const formation::Step>;

/// What is asked of a row when the next one is checked, robot by robot: its half-planes would be most of the memory.
struct RobotBefore {
  geometry::Vec2 chosen;  ///< m/s
  formation::Mode mode;
};
using RowBefore = std::vector<RobotBefore>;

/// A row among its neighbours.
struct RowInRun {
  std::size_t number;
  const formation::Step& row;
  const RowBefore* before;      ///< null of the first
  const formation::Step* next;  ///< null of the last, which does not decide
};

// What keeps a run from being audited at all; empty where nothing does.

/// In what is said before the first row.
std::string obstruction_in(const RecordingFile& beginning);
std::string obstruction_in(const formation::Step& row);
/// The same for a joint plan in a run of `rows` rows.
std::string obstruction_in(const formation::JointPlan& plan, std::size_t rows);

/// Where robots were when goals' bodies and plans begin. Plans begin in rows that have passed: of these the last are
/// known.
class PlacesInRows {
 public:
  /// 2^23 positions are 128 MiB: as many as a run has memory for (formation's `History`).
  static constexpr std::size_t kMostPositions = std::size_t{1} << 23;

  /// `run` must outlive it, and grows while rows are taken.
  explicit PlacesInRows(const RecordingFile& run, std::size_t most = kMostPositions) : run_(run), most_(most) {}

  /// The next row, before which `run` has the goals' bodies and plans that begin with it.
  void take(const formation::Step& row);

  /// m, where half-planes of the robot were built. Null where there is no row of that time.
  const geometry::Vec2* at_begin(const formation::GoalBodies& of_goal) const;
  /// Where a robot of the plan was when it began.
  const geometry::Vec2* at_begin(const formation::JointPlan& plan, std::size_t robot) const;
  /// Whether the row in which it begins had been forgotten when the plan came up.
  bool is_forgotten(const formation::JointPlan& plan, std::size_t robot) const;

 private:
  using Key = std::pair<std::size_t, std::size_t>;  ///< row and robot
  std::optional<std::size_t> row_of(const formation::GoalBodies& of_goal) const;
  void ask_for(const Key& key);
  const geometry::Vec2* at(const Key& key) const;

  const RecordingFile& run_;
  std::size_t most_;
  std::size_t rows_ = 0, first_ = 0;                    ///< so far; of these the first that is known
  std::deque<geometry::Vec2> known_;                    ///< m, anchors of all robots, row after row
  std::size_t goal_bodies_ = 0, plans_ = 0;             ///< of the run, so far
  std::map<Key, std::optional<geometry::Vec2>> asked_;  ///< m; nothing as long as its row has not come
};

}  // namespace exactvo::datasets
