// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Snap rounding (Hobby, Practical segment intersection with finite precision output, 1999): the plane is divided into
/// square pixels, those that hold a vertex or a crossing are hot, and every edge is bent to run through the centres of
/// the hot pixels that it meets. What comes out meets in vertices only, and no point moves farther than a pixel is
/// wide.

#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// The rings bent. A pixel is its centre plus [-grid/2, grid/2) in both coordinates. Exact. Takes time in proportion to
/// the edges times the hot pixels in an edge's range of x. REQUIRES: `hot` holds the centre of every pixel with a
/// vertex or a crossing; grid a power of two, and the centres multiples of it.
std::vector<Ring> snap_rounded(const std::vector<Ring>& rings, std::vector<Vec2> hot, double grid);

}  // namespace exactvo::geometry::detail
