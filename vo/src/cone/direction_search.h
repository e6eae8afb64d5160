// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The local minima over |n| = 1 of f(n) = h_S(n) - n.y: the outward normals of S at the points nearest to y. Rounded.

#include <array>
#include <cstddef>

#include "exactvo/geometry/support.h"

namespace exactvo::vo::detail {

using geometry::GrownShape;
using geometry::Vec2;

/// The candidates that can be the best under h_S(n) <= 0: a disc has one, an ellipse at most two, a segment its
/// nearest and both sides, a polygon its nearest and the shallowest edge that faces the robot.
struct Normals {
  std::array<Vec2, 3> n{};
  std::size_t count = 0;
  void add(Vec2 normal) { n[count++] = normal; }
};

/// REQUIRES: nothing; degenerate positions (a centre, a vertex) give some unit normal, the same one on every machine.
Normals nearest_normals(const GrownShape& s, Vec2 y);

}  // namespace exactvo::vo::detail
