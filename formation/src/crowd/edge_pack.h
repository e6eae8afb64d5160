// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Half-planes that keep up to sixteen robots off static edges, one robot per lane. Each edge is a segment of its own,
/// seen from both sides. With a and b its ends seen from the robot, r the radius and h(n) = max(n.a, n.b) + r |n|, the
/// half-plane n.v >= c excludes what meets the edge within the horizon t iff h(n) <= 0 and h(n) <= t c: for any n
/// (docs/guide/velocity-obstacles.md). The best of finitely many n is that at which the velocity is deepest inside.
///
/// Each round makes the half-plane of the nearest edge left in every lane and drops the edges that it provably
/// excludes. Certified: a velocity that satisfies all half-planes of its lane meets no edge within the horizon that is
/// not touching.

#include <vector>

#include "crowd/edges.h"
#include "crowd/layout.h"

namespace exactvo::formation::crowd {

/// What each lane asks for its robot: m, m/s, s.
template <class T>
struct EdgePackQuery {
  const Segment* edges = nullptr;
  const std::uint32_t* items = nullptr;  ///< numbers of edges, those of a cell next to each other
  alignas(64) double x[kPack], y[kPack], vx[kPack], vy[kPack], radius[kPack], horizon[kPack], max_speed[kPack];
  alignas(64) T least[kPack];             ///< m/s, no offset is below it
  alignas(64) std::int32_t first[kPack];  ///< of the lane's cell in `items`
  alignas(64) std::int32_t count[kPack];  ///< 0: no edges, and the rest of the lane may be anything
  T slack = 0;                            ///< m/s, added to every offset before it is rounded up
};

/// Memory of a thread: what is known of edges, by row and lane, and the rows that a lane still has an edge in. Only
/// edges within range of a robot have rows, however many the cell has.
struct EdgePackTable {
  static constexpr std::size_t kFields = 6;  ///< of an edge: its ends, the error of its support values, its distance
  Array<double> cells;
  std::vector<std::uint32_t> row_at;
  std::vector<double> row_number;
  std::vector<std::uint32_t> row_in_cell;  ///< place of a row's edges in the lists of the lanes' cells

  void double_rows();
};

/// Line k of lane l goes to [k * stride + l], k < lines[l]. The rows beyond a lane's lines are not written, or with
/// anything.
template <class T>
struct EdgePackLines {
  T *x = nullptr, *y = nullptr, *c = nullptr;
  std::size_t stride = 0;
  std::int32_t* lines = nullptr;
  std::size_t room = kMostEdges;     ///< lines a lane
  std::uint32_t* edge = nullptr;     ///< numbers of the edges, unless null
  std::uint8_t* touching = nullptr;  ///< whether the disc meets the edge, or all but; written with `edge`
};

/// Bit `lane`: it needs more lines than there is room for, and has none.
std::uint32_t make_edge_lines(const EdgePackQuery<float>& query, EdgePackTable& table, const EdgePackLines<float>& out);
std::uint32_t make_edge_lines(const EdgePackQuery<double>& query, EdgePackTable& table,
                              const EdgePackLines<double>& out);

}  // namespace exactvo::formation::crowd
