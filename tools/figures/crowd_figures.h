// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figures of a recording of a crowd: maps of what the whole crowd did on a grid of cells and over time, too many
/// robots for a line each, and a sample of its robots. Read row by row, twice, in memory that grows with neither robots
/// nor rows, but for one row. Rounded, for drawing.
///
/// See also: run_figures.h draws runs of few robots.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/crowd_recording.h"
#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// Square cells, row by row from the lowest.
struct CellGrid {
  Vec2 low;           ///< m
  double cell = 1.0;  ///< m, its side
  std::size_t columns = 1, rows = 1;

  std::size_t size() const { return columns * rows; }
  /// The cell that holds p, or the nearest one.
  std::size_t at(Vec2 p) const;
  Vec2 centre(std::size_t number) const;
};

/// What robots did in a cell. They went straight and evenly from each row of the recording to the next.
struct CellCourse {
  double time = 0.0;  ///< s, of all robots together
  double way = 0.0;   ///< m, the same
  Vec2 moved;         ///< m, the same: ways there and back add up to nothing
};

/// Speeds of all robots between two rows.
struct SpeedsThen {
  double time = 0.0;                            ///< s, the middle
  double slow = 0.0, median = 0.0, fast = 0.0;  ///< m/s: a tenth is slower than `slow`, a tenth faster than `fast`
};

struct CrowdCourse {
  std::string name;  ///< of the scenario
  std::size_t robots = 0;
  double duration = 0.0;  ///< s
  Box view;               ///< m, of all places of robots
  CellGrid grid;
  std::vector<CellCourse> cells;         ///< by number
  std::vector<SpeedsThen> speeds;        ///< at most kMostRowsOver
  std::vector<std::vector<Vec2>> paths;  ///< m, of robots spread evenly over the numbers
  /// The drive of each of these robots, if it has wheels and its headings are known (recordings/crowd_headings.h), and
  /// its headings at the points of its path, as unit vectors; else both are empty.
  std::vector<std::optional<formation::DifferentialDrive>> drives;
  std::vector<std::vector<Vec2>> headings;
  std::vector<geometry::Segment> edges;       ///< of obstacles
  std::vector<geometry::ConvexShape> bodies;  ///< where they stood at the start
  bool cut_off = false;                       ///< the recording is
};

/// Cells along the longer side of the view, at most; paths; points of a path, and rows of the speeds.
inline constexpr std::size_t kMostCells = 120, kMostPaths = 60, kMostRowsOver = 500;

/// Throws DataError. REQUIRES: a file that can be read twice.
CrowdCourse course_of(const std::filesystem::path& recording);

/// `density` (robots a square metre, on average over the run), `flow` (how many pass a metre in a second, with arrows),
/// `speed` (of those who were there), `speeds` (over time) and `paths` (of some robots).
std::vector<Figure> crowd_figures(const CrowdCourse& course);

}  // namespace exactvo::tools
