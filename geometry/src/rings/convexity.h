// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether a list of vertices runs once round a convex polygon: what partitions are certified by and shapes judged by.

#include <vector>

#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry::detail {

/// Whether the closed ring turns nowhere to the right, somewhere to the left, never back, and only once round:
/// then it bounds a convex polygon of positive area, counter-clockwise. Vertices on a straight run are tolerated, two
/// equal ones running are not. Exact, O(n).
bool is_convex_ccw(const std::vector<Vec2>& ring);

/// Whether all points lie on one line. Exact, O(n).
bool on_one_line(const std::vector<Vec2>& points);

}  // namespace exactvo::geometry::detail
