// SPDX-License-Identifier: GPL-3.0-or-later
#include "preflight/square_cover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "exactvo/geometry/distance.h"

namespace exactvo::formation::detail {
namespace {

std::array<GridSquare, 8> squares_beside(GridSquare q) {
  return {{{q.x - 1, q.y - 1},
           {q.x, q.y - 1},
           {q.x + 1, q.y - 1},
           {q.x - 1, q.y},
           {q.x + 1, q.y},
           {q.x - 1, q.y + 1},
           {q.x, q.y + 1},
           {q.x + 1, q.y + 1}}};
}

}  // namespace

bool fits_grid(Vec2 p, double side) {
  constexpr double kMost = 0x1p30;
  return std::fabs(p.x) < kMost * side && std::fabs(p.y) < kMost * side;
}

GridSquare square_at(Vec2 p, double side) {
  return {static_cast<std::int32_t>(std::floor(p.x / side)), static_cast<std::int32_t>(std::floor(p.y / side))};
}

/// The distance to an edge is convex, so that it is largest at a corner.
bool CoverWalls::exclude(GridSquare q, double side, double radius) const {
  const Vec2 low{side * q.x, side * q.y}, high{side * (q.x + 1.0), side * (q.y + 1.0)};
  return exclude_hull({low, {high.x, low.y}, high, {low.x, high.y}}, radius);
}

bool CoverWalls::exclude_hull(std::initializer_list<Vec2> corners, double radius) const {
  double largest = 0.0;
  for (const Vec2 p : corners) largest = std::max(largest, edges_.largest_with(p));
  const double near = radius - 2.0 * geometry::rounding_of_distance(largest);
  bool found = false;
  edges_.grid().for_each_within(*corners.begin(), radius, [&](std::size_t k) {
    found = found || std::all_of(corners.begin(), corners.end(),
                                 [&](Vec2 p) { return geometry::distance(edges_[k], p) < near; });
  });
  return found;
}

bool CoverWalls::is_outside(GridSquare q, double side, double radius) const {
  return side * q.x > box_.high.x + radius || side * (q.x + 1.0) < box_.low.x - radius ||
         side * q.y > box_.high.y + radius || side * (q.y + 1.0) < box_.low.y - radius;
}

bool leads_outside(Vec2 start, double radius, double side, const CoverWalls& walls, std::size_t& looks) {
  const GridSquare ways[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (const GridSquare way : ways) {
    GridSquare q = square_at(start, side);
    for (std::size_t k = 0; k < kMostSquares && !walls.is_outside(q, side, radius); ++k) {
      q = {q.x + way.x, q.y + way.y};
      if (looks == 0) return false;
      --looks;
      if (walls.exclude(q, side, radius)) break;
    }
    if (walls.is_outside(q, side, radius)) return true;
  }
  return false;
}

SquareCover cover_from(Vec2 start, double radius, double side, const CoverWalls& walls, std::size_t& looks) {
  SquareCover cover;
  cover.radius = radius;
  cover.side = side;
  std::vector<GridSquare>& squares = cover.squares;
  squares.push_back(square_at(start, side));
  cover.number.emplace(key_of(squares[0]), 0);
  for (std::size_t k = 0; k < squares.size(); ++k)
    for (const GridSquare q : squares_beside(squares[k])) {
      if (cover.has(q)) continue;
      if (squares.size() > kMostSquares || looks == 0) return cover;
      --looks;
      if (walls.exclude(q, side, radius)) continue;
      cover.number.emplace(key_of(q), static_cast<std::uint32_t>(squares.size()));
      squares.push_back(q);
    }
  cover.is_whole = true;
  for (const GridSquare middle : squares) {
    SquaresBeside& beside = cover.beside.emplace_back();
    for (const GridSquare q : squares_beside(middle))
      if (cover.has(q)) beside.number[beside.count++] = cover.number.at(key_of(q));
  }
  return cover;
}

std::vector<char> squares_at(Vec2 goal, double reach, const SquareCover& cover) {
  constexpr double kHalfDiagonal = 0.70711;  // of a square, rounded up
  std::vector<char> is_at(cover.squares.size());
  for (std::size_t k = 0; k < is_at.size(); ++k) {
    const Vec2 middle{cover.side * (cover.squares[k].x + 0.5), cover.side * (cover.squares[k].y + 0.5)};
    is_at[k] = norm(middle - goal) * kProductRoundedDown <= reach + kHalfDiagonal * cover.side;
  }
  return is_at;
}

}  // namespace exactvo::formation::detail
