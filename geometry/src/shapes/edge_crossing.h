// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether the ray from a point towards +x crosses an edge: the even-odd rule, one edge at a time. Exact.

#include <algorithm>

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

enum class Crossing { none, right, on_edge };

/// The upper end of an edge does not count, so a vertex counts once.
inline Crossing crossing(const Segment& edge, Vec2 x) {
  const auto between = [](double p, double q, double v) { return std::min(p, q) <= v && v <= std::max(p, q); };
  const bool upward = edge.a.y <= x.y && x.y < edge.b.y;
  const bool downward = edge.b.y <= x.y && x.y < edge.a.y;
  const bool near = between(edge.a.x, edge.b.x, x.x) && between(edge.a.y, edge.b.y, x.y);
  if (!upward && !downward && !near) return Crossing::none;
  const Sign turn = orientation(edge.a, edge.b, x);
  if (turn == Sign::zero && near) return Crossing::on_edge;
  const bool right = (upward && turn == Sign::positive) || (downward && turn == Sign::negative);
  return right ? Crossing::right : Crossing::none;
}

/// Where x lies by the even-odd rule over the edges that `for_each_edge(visit)` visits. Exact.
template <class ForEachEdge>
Place even_odd_place(Vec2 x, const ForEachEdge& for_each_edge) {
  bool odd = false, on_edge = false;
  for_each_edge([&](const Segment& edge) {
    const Crossing c = crossing(edge, x);
    on_edge = on_edge || c == Crossing::on_edge;
    odd = odd != (c == Crossing::right);
  });
  if (on_edge) return Place::boundary;
  return odd ? Place::inside : Place::outside;
}

}  // namespace exactvo::geometry::detail
