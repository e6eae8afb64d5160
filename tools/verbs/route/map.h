// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The map of `exactvo route`: the obstacles of a file, and how points are given on it. Points are metres of the plane
/// that the reader lays the obstacles out on, except on a Moving AI map: there they are cells, as in its .scen files.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/moving_ai.h"
#include "exactvo/formation/scenario.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

/// How cells become metres: columns from the left, rows from the top, y upward.
struct CellPlaces {
  datasets::MapSize size;
  double side = 1.0;    ///< m
  double offset = 0.5;  ///< of what is meant from the cell's top left corner, in cells
};

struct AskedMap {
  std::string file;
  std::string format;
  std::vector<formation::SceneObstacle> obstacles;
  std::vector<geometry::Obstacle> shapes;  ///< theirs
  std::optional<CellPlaces> cells;         ///< of a Moving AI map

  /// A point as it was given, in metres. Nothing where it is no number within 2^100 or lies outside of the cells.
  std::optional<geometry::Vec2> in_metres(geometry::Vec2 given) const;
  /// What `in_metres` accepts, in words.
  std::string accepted_points() const;
  /// An obstacle's id; "wall 7" or "polygon 7" where that is a number.
  std::string name_of(std::size_t obstacle) const;
};

/// "middle" or "corner" of the cell.
inline constexpr const char* kCellPoints[] = {"middle", "corner"};

/// Reads the obstacles, all of them: one that cannot be used refuses the file. A Moving AI map gets a wall round it,
/// since what lies outside of it is out of bounds; `cell_point` is what numbers of cells mean there. Throws DataError,
/// UsageError.
AskedMap read_asked_map(const std::string& file, const datasets::ReadOptions& reading, const std::string& cell_point);

}  // namespace exactvo::tools
