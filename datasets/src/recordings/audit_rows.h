// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The rows of an audited run. They are read twice, so that none is kept: first for what is asked of them as a whole,
/// then to judge one after the other.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

using SharedRow = std::shared_ptr<const formation::Step>;
/// Gives `take` every row in order, as often as it is called.
using EachRow = std::function<void(const std::function<void(SharedRow row)>& take)>;

/// A row among its neighbours.
struct RowInRun {
  std::size_t number;
  const formation::Step& row;
  const formation::Step* before;  ///< null of the first
  const formation::Step* next;    ///< null of the last, which does not decide
};
/// Keeps three rows at a time.
void walk(const EachRow& each, const std::function<void(const RowInRun& at)>& judge);

/// What is asked of the rows as a whole.
class RunOutline {
 public:
  /// Of a row where and in which mode robots were.
  struct Places {
    struct Robot {
      geometry::Vec2 position, velocity;
      formation::Mode mode;
    };
    double time = 0.0;  ///< s
    std::vector<Robot> robots;
  };

  void add(const formation::Step& row);

  std::size_t rows = 0;
  Places first, before_last, last;
  double latest = 0.0;      ///< s
  std::string obstruction;  ///< in the first row that has one
};

/// What keeps a run from being audited at all; empty where nothing does. `run` may be without rows.
std::string obstruction_of(const RecordingFile& run, const RunOutline& outline);

/// Where robots were in the rows that outlooks and plans speak of: memory by how many those are.
class PlacesInRows {
 public:
  struct Place {
    double time;              ///< s, of the row
    geometry::Vec2 position;  ///< m
    geometry::Vec2 anchor;    ///< m, the place itself or, of second-order robots, the brake point
  };

  /// REQUIRES: rows of the number that `outline` says.
  PlacesInRows(const RecordingFile& run, const RunOutline& outline);

  void take(std::size_t number, const formation::Step& row);

  /// Null of what no outlook and no plan speaks of, and where there is no such row.
  const Place* of_outlook(const formation::Outlook& outlook) const;
  const Place* of(std::size_t row, std::size_t robot) const;

 private:
  std::optional<std::size_t> row_of(const formation::Outlook& outlook) const;

  double time_step_;  ///< s
  std::size_t rows_;
  std::map<std::pair<std::size_t, std::size_t>, Place> places_;  ///< by row and robot
};

}  // namespace exactvo::datasets
