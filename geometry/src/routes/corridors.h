// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Rows of portals between cells that have one way on, and how far a view passes along them without meeting an end.
///
/// A shortest way round a curve of n vertices turns at all of them, and behind each a narrow view opens between two
/// rays. Where the triangles fan out from the curve, each view crosses up to n portals and sees no end of one:
///
///      C-.__                      C: the far end of all portals; 1..4: vertices of the curve. The view from 1 between
///      |\ `-.`--.__               its two rays crosses every portal after it.
///      | \   `-. `-.`--.__
///      1--2----3----4----5
///
/// To take them one at a time is quadratic. Here the ends on either side are kept in boxes that are turned along the
/// curve (strip trees, Ballard 1981), and a view leaps over a box that it leaves on its side. A leap is conservative:
/// what it passes over changes nothing in a view.

#include <cstddef>
#include <vector>

#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry::routing {

/// A portal as it is crossed on the way along a row.
struct Crossing {
  int portal, cell;  ///< the cell behind it
  Vec2 left, right;
  double size;  ///< m: its ends are rounded as numbers of this size are
};

/// What is seen from `root` between two rays.
struct View {
  Vec2 root, left_ray, right_ray;
  double snap;  ///< m, as a share of the coordinates: a ray that passes an end this closely meets it
  double size;  ///< m, of the root's coordinates
};

/// Crossings, one after the other, that are asked for as far as they are needed.
class Corridor {
 public:
  int size() const { return static_cast<int>(crossings_.size()); }
  const Crossing& operator[](int k) const { return crossings_[static_cast<std::size_t>(k)]; }
  void add(const Crossing& crossing) { crossings_.push_back(crossing); }

  /// The last crossing from `from` on up to which `view` passes between the ends, `from` where it does not pass the
  /// next. `grow(n)` makes the corridor n long, or says that it ends before that; `passes(crossing)` decides one.
  template <typename Grow, typename Passes>
  int last_passed(int from, const View& view, const Grow& grow, const Passes& passes);

 private:
  /// A rectangle: its middle and half of its sides.
  struct Strip {
    Vec2 middle, along, across;
  };
  struct Block {
    Strip left, right;
    double size = 0.0;
  };
  static constexpr int kBlock = 3;  ///< blocks of 2^3 crossings and more

  /// The block of crossings [number 2^level, (number + 1) 2^level). REQUIRES: the corridor is that long.
  const Block& block(int level, int number);
  Block lowest_block(int number);
  Block block_of_two(const std::vector<Block>& below, int number);
  static Strip strip_round(const std::vector<Vec2>& points);
  static bool passes(const Block& block, const View& view);

  std::vector<Crossing> crossings_;
  std::vector<std::vector<Block>> blocks_;  ///< by level above kBlock; of each level those made so far
  std::vector<Vec2> scratch_;
};

template <typename Grow, typename Passes>
int Corridor::last_passed(int from, const View& view, const Grow& grow, const Passes& passes_one) {
  int next = from + 1, level = 0;  // level 0: one crossing
  const auto length = [&] { return level == 0 ? 1 : 1 << level; };
  for (;;) {
    const bool passed =
        grow(next + length()) && (level == 0 ? passes_one((*this)[next]) : passes(block(level, next >> level), view));
    if (!passed && level == 0) return next - 1;
    if (!passed) {
      level = level == kBlock ? 0 : level - 1;
      continue;
    }
    next += length();
    // Up while the place allows it, so that the number of steps is logarithmic in the number passed.
    const int higher = level == 0 ? kBlock : level + 1;
    if (next % (1 << higher) == 0) level = higher;
  }
}

}  // namespace exactvo::geometry::routing
