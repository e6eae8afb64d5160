// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Squares of a grid that cover the places that the middle of a disc can get to among static obstacles. A square is
/// left out only where all of it is nearer than the radius to one edge. Certified: rounding only leaves more squares
/// in.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <unordered_map>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "scene/edges_by_place.h"

namespace exactvo::formation::detail {

inline constexpr std::size_t kMostSquares = 4000;             ///< of a cover: about 250 squares of the radius
inline constexpr double kProductRoundedDown = 1.0 - 0x1p-40;  ///< of a few factors

/// x and y times the side are the coordinates of its lower left corner, without rounding: the side is a power of two.
struct GridSquare {
  std::int32_t x, y;
};

/// The square as one number.
inline std::uint64_t key_of(GridSquare q) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(q.x)) << 32 | static_cast<std::uint32_t>(q.y);
}

/// Whether the place has a square: its numbers are no larger than they can be.
bool fits_grid(Vec2 p, double side);

/// One that contains the place. REQUIRES: it fits the grid.
GridSquare square_at(Vec2 p, double side);

/// The squares that share a side or a corner with one.
struct SquaresBeside {
  std::uint32_t count = 0;
  std::uint32_t number[8] = {};

  const std::uint32_t* begin() const { return number; }
  const std::uint32_t* end() const { return number + count; }
};

/// The squares that cover where a disc can get from its start.
struct SquareCover {
  double radius = 0.0, side = 0.0;
  bool is_whole = false;  ///< else there are more squares than are looked at
  std::vector<GridSquare> squares;
  std::vector<SquaresBeside> beside;                        ///< of each square; of none where the cover is not whole
  std::unordered_map<std::uint64_t, std::uint32_t> number;  ///< of a square, by its key

  bool has(GridSquare q) const { return number.count(key_of(q)) > 0; }
};

/// The edges of all obstacles.
class CoverWalls {
 public:
  explicit CoverWalls(const std::vector<SceneObstacle>& obstacles) : edges_(obstacles) {
    for (const geometry::Segment& edge : edges_.all()) box_.add(geometry::box_of(edge));
  }

  const EdgesByPlace& edges() const { return edges_; }

  /// Whether some edge is nearer than the radius to every point of the square; false where rounding leaves it open.
  bool exclude(GridSquare q, double side, double radius) const;

  /// The same for a single point.
  bool exclude(Vec2 p, double radius) const { return exclude_hull({p}, radius); }

  /// Whether the square lies beyond all edges, and farther from their box than the radius: from there any number of
  /// squares can be reached.
  bool is_outside(GridSquare q, double side, double radius) const;

 private:
  bool exclude_hull(std::initializer_list<Vec2> corners, double radius) const;

  EdgesByPlace edges_;
  geometry::Box box_;  ///< of them
};

/// Whether a row or a column of squares leads from the start beyond all walls: then no cover from there is whole.
/// `looks`: as of cover_from.
bool leads_outside(Vec2 start, double radius, double side, const CoverWalls& walls, std::size_t& looks);

/// `looks`: at squares, how many are allowed and then how many are left.
SquareCover cover_from(Vec2 start, double radius, double side, const CoverWalls& walls, std::size_t& looks);

/// For each square, whether a point of it is within `reach`, m, of the goal.
std::vector<char> squares_at(Vec2 goal, double reach, const SquareCover& cover);

}  // namespace exactvo::formation::detail
