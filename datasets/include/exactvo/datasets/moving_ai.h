// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Maps of the Moving AI benchmarks (Sturtevant, "Benchmarks for Grid-Based Pathfinding", 2012): `.map` files, whose
/// obstacles `read_obstacles` reads. `exactvo route --queries` reads their tasks, `.scen`.

#include <cstdint>
#include <filesystem>

namespace exactvo::datasets {

/// Cells.
struct MapSize {
  std::int64_t columns = 0;  ///< the map's width
  std::int64_t rows = 0;     ///< the map's height
};

/// What the header of a `.map` says, without its cells. Throws DataError with the line.
MapSize read_map_size(const std::filesystem::path& map);

}  // namespace exactvo::datasets
