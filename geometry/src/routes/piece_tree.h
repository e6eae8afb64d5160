// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A tree of boxes over the obstacles' pieces: which may come near a segment, and which triangle to start a walk from.
/// Conservative: what it names is a superset. A uniform grid would be coarse wherever one obstacle lies far from all
/// others; the tree does not depend on how far apart obstacles lie. Long pieces are cut, so that their boxes are small.

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactvo/geometry/box.h"
#include "routes/cell_map.h"

namespace exactvo::geometry::routing {

class PieceTree {
 public:
  explicit PieceTree(const CellMap& map);

  /// A triangle near x, or one at a vertex near it.
  int triangle_near(Vec2 x) const;

  /// Calls f(piece) for every piece that may come within r of the segment ab, some of them more than once; a piece is
  /// an edge of the graph, or beyond those an isolated vertex. Stops where f returns false, and returns that.
  template <typename F>
  bool for_each_near(Vec2 a, Vec2 b, double r, const F& f) const {
    if (nodes_.empty()) return true;
    const Strip strip(a, b, r + slack_for(a, b, r));
    int pending[kMostDepth], count = 0;
    pending[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(pending[--count])];
      if (!strip.meets(node.box)) continue;
      if (node.right > 0) {
        pending[count++] = node.right;
        pending[count++] = static_cast<int>(&node - nodes_.data()) + 1;
        continue;
      }
      for (int k = node.first; k < node.last; ++k)
        if (strip.meets(parts_[static_cast<std::size_t>(k)].box) && !f(parts_[static_cast<std::size_t>(k)].piece))
          return false;
    }
    return true;
  }

 private:
  static constexpr int kMostDepth = 64;  ///< halves of at most 2^31 parts, and one beside each

  /// What lies within `reach` of a segment, roughly: its box, and the strip along it.
  struct Strip {
    Vec2 a, d, low, high;
    double reach, width;  ///< width: |d| reach
    Strip(Vec2 from, Vec2 to, double r)
        : a(from),
          d(to - from),
          low{std::min(from.x, to.x) - r, std::min(from.y, to.y) - r},
          high{std::max(from.x, to.x) + r, std::max(from.y, to.y) + r},
          reach(r),
          width(norm(d) * r) {}
    bool meets(const Box& box) const {
      if (box.high.x < low.x || box.low.x > high.x || box.high.y < low.y || box.low.y > high.y) return false;
      // A disc that touches a row of pieces in one point meets few boxes, its own box all of them.
      if (d == Vec2{}) return distance_below(box, a) <= reach;
      const Vec2 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
      constexpr double kRounding = 1.0 + 0x1p-40;  // of each term; that of `middle` is in `reach`
      return std::fabs(cross(d, middle - a)) <= kRounding * (width + std::fabs(d.x) * half.y + std::fabs(d.y) * half.x);
    }
  };
  /// More than rounding makes of a coordinate, and of a box's distance to a line, wherever the segment lies.
  double slack_for(Vec2 a, Vec2 b, double r) const {
    constexpr double kRounding = 0x1p-40;
    return kRounding * std::max({largest_, std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y), r});
  }

  struct Part {
    Box box;
    int piece;
  };
  /// The left child follows its parent. A leaf has no right child.
  struct Node {
    Box box;
    int right, first, last;
  };
  int build(int first, int last);

  double largest_ = 0.0;  ///< m, of a coordinate
  std::vector<Part> parts_;
  std::vector<Node> nodes_;
  std::vector<int> triangle_at_;  ///< of a piece: one at its first vertex
};

}  // namespace exactvo::geometry::routing
