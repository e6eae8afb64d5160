// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Occupied cells become polygons whose union is the union of the cells: nothing lost, nothing gained.
///
/// A cell is the quadrilateral of its four lattice points *as rounded*; neighbours share them. With no yaw the lattice
/// lines are axis-parallel, so the polygons contain every cell exactly. With a yaw a lattice line is straight only up
/// to the rounding of its points: a polygon whose long edge skips them may miss a cell by that much, at most 4 u of the
/// largest coordinate (two products, a sum and the sum with the origin, each rounded once).

#include <cstddef>
#include <cstdint>
#include <vector>

#include "readers/raw_geometry.h"

namespace exactvo::datasets {

struct Grid {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> occupied;  ///< row by row, row 0 lowest; not 0: occupied

  bool at(std::size_t x, std::size_t y) const { return x < width && y < height && occupied[y * width + x] != 0; }
};

/// Where lattice point (0, 0), the lower-left corner of cell (0, 0), lies, and how the rows run.
struct GridPlacement {
  geometry::Vec2 origin;    ///< m
  double resolution = 1.0;  ///< m a cell
  double yaw = 0.0;         ///< rad
  /// Added to lattice coordinates first, so that a scan's cells may lie anywhere.
  std::int64_t first_column = 0;
  std::int64_t first_row = 0;
};

geometry::Vec2 lattice_point(const GridPlacement& placement, std::size_t column, std::size_t row);

/// One polygon a 4-connected component, holes included, in the order of the components' lowest left cells. Every ring
/// is simple: where a component meets itself at a corner, the ring is cut in two there. A component of more than
/// kMostCorners is rejected (E_SIZE).
void add_grid(const Grid& grid, const GridPlacement& placement, Collector& out);

/// 4096 x 4096: a grid and its tracing take 6 bytes a cell, 100 MB, whatever a header claims; the boundaries come on
/// top, of one component at a time.
inline constexpr std::size_t kMostCells = std::size_t{1} << 24;

/// Corners of the boundary of one component. A picture of some kilobytes may hold millions; each takes 220 bytes until
/// its polygon is validated: 58 MB.
inline constexpr std::size_t kMostCorners = std::size_t{1} << 18;

}  // namespace exactvo::datasets
