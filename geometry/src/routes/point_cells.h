// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The cells of a map as a point needs them. No gate is too narrow for one, so that Links cut nothing, and triangles
/// are joined across their sides as long as what comes out is convex: a search has a third of the cells to look at.
///
/// Vertices, triangles and sides keep their numbers. A cell is convex, and a corner of it is straight only where no
/// straight piece from inside one portal to inside another can pass it: such a piece runs inside the cell. Exact.

#include "routes/cell_map.h"

namespace exactvo::geometry::routing {

/// REQUIRES: map.has_all_gates().
CellMap cells_for_points(const CellMap& map);

}  // namespace exactvo::geometry::routing
