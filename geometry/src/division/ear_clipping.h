// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Triangles of small rings, some ten times quicker than a triangulation's data structure can be set up.

#include <array>
#include <cstddef>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// Three numbers of vertices, counter-clockwise.
using Triangle = std::array<std::size_t, 3>;

/// Up to here cutting ears, O(n^2) to O(n^3), is quicker.
inline constexpr std::size_t kMostForEars = 32;

/// Cuts ears off a simple counter-clockwise ring (Meisters, Polygons have ears, 1975): vertices that turn left with no
/// other vertex in their closed triangle. Exact predicates. Empty where rings with straight vertices leave no such ear
/// before the end: then the caller triangulates otherwise. Deterministic.
std::vector<Triangle> ears_of(const Ring& ring);

}  // namespace exactvo::geometry::detail
