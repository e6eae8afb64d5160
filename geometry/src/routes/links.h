// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The strict Gabriel links between vertices and the insides of walls (cell_map.h says what they are). Exact.

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "routes/cell_map.h"

namespace exactvo::geometry::routing {

struct LinkBounds {
  std::size_t steps = std::numeric_limits<std::size_t>::max();      ///< triangles looked at
  std::size_t crossings = std::numeric_limits<std::size_t>::max();  ///< of links with sides of triangles
};

/// Where the search for links starts. Both find all of them; one may take linearly many steps where the other takes
/// quadratically many: between two curves that face each other a vertex sees many sides of triangles and no wall behind
/// them, and many short walls may see the same sides below one long wall.
enum class LinksFrom { vertices, walls };

/// All of them that are no longer than the map's widest gate, and perhaps others; or nothing where that takes more than
/// the bounds allow. REQUIRES: `map` has triangles and sides.
std::optional<std::vector<Link>> gabriel_links(const CellMap& map, LinkBounds bounds,
                                               LinksFrom from = LinksFrom::vertices);

/// Cuts walls that very many triangles lie in front of. Where n vertices face one long wall, the triangles fan out from
/// its ends, and n links cross n/2 sides each:
///
///        a______________________wall______________________b
///          \   `-._ `--..__   `---....___      ___...---'/
///           \      `-._    ``--..__      ``--..         /
///            c         c            c            c     c        feet on the wall lie above the vertices c
///
/// The walls are cut at such feet, found from vertices sampled all over the map, so that each fan is split into as many
/// as were sampled. A cut point is exact: the wall's points stay the same. False where there was nothing to cut.
bool cut_crowded_walls(const CellMap& map, std::size_t most_steps, PlanarGraph& graph);

}  // namespace exactvo::geometry::routing
