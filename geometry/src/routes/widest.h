// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The widest disc that gets from one cell to another: the narrowest gate on the widest way, from a maximum spanning
/// tree of the cells over the widths of gates. Exact: widths are compared, not rounded.

#include <vector>

#include "routes/cell_map.h"
#include "routes/piece_tree.h"

namespace exactvo::geometry::routing {

class GateTree {
 public:
  explicit GateTree(const CellMap& map);

  bool connects(int one, int other) const;
  /// The largest double radius for which the disc fits through all gates of some way between two cells; infinite if no
  /// gate is in the way. REQUIRES: `connects`.
  double widest_radius(int one, int other) const;

 private:
  int root_of(int cell) const;

  const CellMap* map_;
  std::vector<int> gates_;   ///< portals that joined two parts, widest first
  std::vector<int> parent_;  ///< of a cell
  std::vector<int> joined_;  ///< by which of `gates_` the cell came under its parent: increasing towards the root
};

/// Whether every piece stays at least r away from x. Exact.
bool is_clear(const CellMap& map, const PieceTree& grid, Vec2 x, double r);

/// The largest double r such that every piece stays at least r away from x; infinite where there are none.
double clearance_of(const CellMap& map, const PieceTree& grid, Vec2 x);

}  // namespace exactvo::geometry::routing
