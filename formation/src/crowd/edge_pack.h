// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Half-planes against edges for sixteen robots at once, one robot per lane: each round makes the half-plane of the
/// nearest edge left in every lane and drops the edges that it excludes. The same operations in the same order as
/// `edge_lines`, which serves one robot, hence the same bits.

#include "crowd/edges.h"
#include "crowd/layout.h"

namespace exactvo::formation::crowd {

/// Edges of a cell that a lane has room for.
inline constexpr std::size_t kMostPackEdges = 96;

/// Lane by lane what ObstacleQuery says of one robot.
template <class T>
struct EdgePackQuery {
  const Segment* edges = nullptr;
  const std::uint32_t* items = nullptr;  ///< numbers of edges, those of a cell next to each other
  alignas(64) double x[kPack], y[kPack], vx[kPack], vy[kPack], radius[kPack], horizon[kPack], max_speed[kPack];
  alignas(64) T least[kPack];             ///< m/s, no offset is below it
  alignas(64) std::int32_t first[kPack];  ///< of the lane's cell in `items`
  alignas(64) std::int32_t count[kPack];  ///< at most kMostPackEdges; 0: no edges
  T slack = 0;                            ///< m/s, added to every offset before it is rounded up
};

/// Memory of a thread.
struct EdgePackTable {
  static constexpr std::size_t kRoom = kMostPackEdges * kPack;
  alignas(64) double ax[kRoom], ay[kRoom], bx[kRoom], by[kRoom], error[kRoom], squared[kRoom];
};

/// Line k of lane l goes to [k * stride + l], k < lines[l]. There is room for kMostEdges; the rows beyond a lane's
/// lines are not written, or with anything.
template <class T>
struct EdgePackLines {
  T *x = nullptr, *y = nullptr, *c = nullptr;
  std::size_t stride = 0;
  std::int32_t* lines = nullptr;
};

/// Bit `lane`: it needs more than kMostEdges lines, and has none.
std::uint32_t make_edge_lines(const EdgePackQuery<float>& query, EdgePackTable& table, const EdgePackLines<float>& out);
std::uint32_t make_edge_lines(const EdgePackQuery<double>& query, EdgePackTable& table,
                              const EdgePackLines<double>& out);

}  // namespace exactvo::formation::crowd
