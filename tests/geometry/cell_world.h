// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Blocked cells of a grid, and the shortest route of a point among them by a visibility graph in integers. It shares
/// nothing with routes.h. A point passes no place where two blocked cells touch at a corner.

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "exactvo/geometry/shapes.h"
#include "support/seeded_random.h"

namespace exactvo::test {

class CellWorld {
 public:
  /// `side` cells a side, in a closed wall; `share` of them blocked. Start and goal are middles of free cells.
  CellWorld(SeededRandom& random, int side, double share) : side_(side) {
    blocked_.resize(static_cast<std::size_t>(side) * side);
    for (std::size_t k = 0; k < blocked_.size(); ++k) blocked_[k] = random.uniform(0.0, 1.0) < share;
    blocked_.front() = blocked_.back() = false;
    const auto free_cell = [&] {
      for (;;) {
        const Place p{2 * random.integer(0, side - 1) + 1, 2 * random.integer(0, side - 1) + 1};
        if (!is_blocked(p.x / 2, p.y / 2)) return p;
      }
    };
    start_ = free_cell();
    goal_ = free_cell();
  }

  /// Start and goal become corners of cells, or middles of their sides, inside the wall.
  void put_ends_on_cells_borders(SeededRandom& random) {
    for (Place* end : {&start_, &goal_}) {
      do *end = {random.integer(1, 2 * side_ - 1), random.integer(1, 2 * side_ - 1)};
      while (end->x % 2 != 0 && end->y % 2 != 0);
    }
  }
  /// What an end is in contact with.
  enum class Contact { none, a_side_or_corner, pinch, blocked_on_every_side };
  Contact contact_of_start() const { return contact_of(start_); }
  Contact contact_of_goal() const { return contact_of(goal_); }

  std::vector<geometry::Obstacle> obstacles() const {
    const double n = side_;
    std::vector<geometry::Obstacle> out{geometry::Polyline{{{0, 0}, {n, 0}, {n, n}, {0, n}, {0, 0}}}};
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x)
        if (is_blocked(x, y))
          out.push_back(
              geometry::Polygon{{{1.0 * x, 1.0 * y}, {x + 1.0, 1.0 * y}, {x + 1.0, y + 1.0}, {1.0 * x, y + 1.0}}, {}});
    return out;
  }
  geometry::Vec2 start() const { return {0.5 * start_.x, 0.5 * start_.y}; }
  geometry::Vec2 goal() const { return {0.5 * goal_.x, 0.5 * goal_.y}; }

  /// m; infinite where there is no route.
  double shortest() const {
    std::vector<Place> nodes{start_, goal_};
    for (int y = 1; y < side_; ++y)
      for (int x = 1; x < side_; ++x)
        if (is_turn(x, y)) nodes.push_back({2 * x, 2 * y});
    std::vector<double> best(nodes.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, std::size_t>, std::vector<std::pair<double, std::size_t>>, std::greater<>>
        queue;
    queue.emplace(best[0] = 0.0, 0);
    while (!queue.empty()) {
      const auto [length, at] = queue.top();
      queue.pop();
      if (length > best[at]) continue;
      for (std::size_t to = 1; to < nodes.size(); ++to) {
        const double there = length + 0.5 * norm(as_vector(nodes[to]) - as_vector(nodes[at]));
        if (there < best[to] && sees(nodes[at], nodes[to])) queue.emplace(best[to] = there, to);
      }
    }
    return best[1];
  }

 private:
  /// In half cells.
  struct Place {
    int x, y;
  };
  static geometry::Vec2 as_vector(Place p) { return {1.0 * p.x, 1.0 * p.y}; }

  bool is_blocked(int x, int y) const {
    return x < 0 || y < 0 || x >= side_ || y >= side_ || blocked_[static_cast<std::size_t>(y) * side_ + x];
  }
  Contact contact_of(Place p) const {
    int blocked = 0;
    for (const int x : {(p.x - 1) / 2, p.x / 2})
      for (const int y : {(p.y - 1) / 2, p.y / 2}) blocked += is_blocked(x, y);
    if (blocked == 4) return Contact::blocked_on_every_side;
    if (p.x % 2 == 0 && p.y % 2 == 0 && is_pinch(p.x / 2, p.y / 2)) return Contact::pinch;
    return blocked > 0 ? Contact::a_side_or_corner : Contact::none;
  }
  int blocked_round(int x, int y) const {
    return is_blocked(x - 1, y - 1) + is_blocked(x, y - 1) + is_blocked(x - 1, y) + is_blocked(x, y);
  }
  /// A corner of one blocked cell alone: only there does a shortest route turn.
  bool is_turn(int x, int y) const { return blocked_round(x, y) == 1; }
  /// Two blocked cells touch at this corner.
  bool is_pinch(int x, int y) const { return blocked_round(x, y) == 2 && is_blocked(x, y) == is_blocked(x - 1, y - 1); }

  static int turn(Place a, Place b, int x, int y) { return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x); }

  /// Whether the segment meets the inside of the cell: no side of it, and not the segment's own line, parts them.
  static bool meets_inside(Place a, Place b, int x, int y) {
    const int x0 = 2 * x, x1 = x0 + 2, y0 = 2 * y, y1 = y0 + 2;
    if (std::max(a.x, b.x) <= x0 || std::min(a.x, b.x) >= x1 || std::max(a.y, b.y) <= y0 || std::min(a.y, b.y) >= y1)
      return false;
    const int turns[] = {turn(a, b, x0, y0), turn(a, b, x1, y0), turn(a, b, x1, y1), turn(a, b, x0, y1)};
    return *std::min_element(turns, turns + 4) < 0 && *std::max_element(turns, turns + 4) > 0;
  }

  bool sees(Place a, Place b) const {
    const int low_x = std::min(a.x, b.x) / 2, high_x = (std::max(a.x, b.x) + 1) / 2;
    const int low_y = std::min(a.y, b.y) / 2, high_y = (std::max(a.y, b.y) + 1) / 2;
    for (int y = low_y; y <= high_y; ++y) {
      for (int x = low_x; x <= high_x; ++x) {
        if (is_blocked(x, y) && meets_inside(a, b, x, y)) return false;
        const bool inside = (2 * x != a.x || 2 * y != a.y) && (2 * x != b.x || 2 * y != b.y);
        const bool within = 2 * x >= std::min(a.x, b.x) && 2 * x <= std::max(a.x, b.x) && 2 * y >= std::min(a.y, b.y) &&
                            2 * y <= std::max(a.y, b.y);
        if (inside && within && turn(a, b, 2 * x, 2 * y) == 0 && is_pinch(x, y)) return false;
      }
    }
    return !runs_between_blocked(a, b);
  }

  /// Along the common side of two blocked cells.
  bool runs_between_blocked(Place a, Place b) const {
    if (a.x == b.x && a.x % 2 == 0) {
      for (int y = std::min(a.y, b.y) / 2; 2 * y < std::max(a.y, b.y); ++y)
        if (is_blocked(a.x / 2 - 1, y) && is_blocked(a.x / 2, y)) return true;
    }
    if (a.y == b.y && a.y % 2 == 0) {
      for (int x = std::min(a.x, b.x) / 2; 2 * x < std::max(a.x, b.x); ++x)
        if (is_blocked(x, a.y / 2 - 1) && is_blocked(x, a.y / 2)) return true;
    }
    return false;
  }

  int side_;
  std::vector<bool> blocked_;
  Place start_{}, goal_{};
};

}  // namespace exactvo::test
