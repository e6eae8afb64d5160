// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Path-finding tasks of the Moving AI benchmarks (Sturtevant, "Benchmarks for Grid-Based Pathfinding", 2012): `.scen`
/// files. Their maps, `.map`, are read by `read_obstacles`.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

/// Column from the left, row from the top, as the format counts.
struct GridCell {
  std::int64_t column = 0;  ///< from the left, 0 first
  std::int64_t row = 0;     ///< from the top, 0 first
};

/// One line of a `.scen` file.
struct PathTask {
  std::int64_t bucket = 0;      ///< the benchmark's class of lengths
  std::string map;              ///< as written: may carry a path
  std::int64_t width = 0;       ///< cells, of the map that the task was made for; not always that of the map at hand
  std::int64_t height = 0;      ///< cells, of the same map
  GridCell start;               ///< where the agent begins
  GridCell goal;                ///< where it is to go
  double optimal_length = 0.0;  ///< cells
};

/// Cells.
struct MapSize {
  std::int64_t columns = 0;  ///< the map's width
  std::int64_t rows = 0;     ///< the map's height
};

/// What the header of a `.map` says, without its cells. Throws DataError with the line.
MapSize read_map_size(const std::filesystem::path& map);

/// Throws DataError with the line.
std::vector<PathTask> read_tasks(const std::filesystem::path& path);

/// Whether start and goal lie inside the size that the task itself states.
bool is_inside_its_map(const PathTask& task);

}  // namespace exactvo::datasets
