// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/grid.h"

#include <algorithm>
#include <unordered_map>

namespace exactvo::datasets {
namespace {

/// 32 bits: a corner of a long boundary takes 8 bytes.
struct Lattice {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
};

bool operator==(Lattice a, Lattice b) {
  return a.x == b.x && a.y == b.y;
}

/// East, north, west, south.
enum Direction : std::uint8_t { kEast, kNorth, kWest, kSouth };

Direction turned_left(Direction d) {
  return static_cast<Direction>((d + 1) % 4);
}
Direction turned_right(Direction d) {
  return static_cast<Direction>((d + 3) % 4);
}

Lattice step(Lattice p, Direction d) {
  constexpr std::uint32_t kMinusOne = ~std::uint32_t{0};
  constexpr std::uint32_t kX[] = {1, 0, kMinusOne, 0}, kY[] = {0, 1, 0, kMinusOne};
  return {p.x + kX[d], p.y + kY[d]};
}

using Corners = std::vector<Lattice>;

double signed_area(const Corners& ring) {
  double doubled = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Lattice a = ring[i];
    const Lattice b = ring[(i + 1) % ring.size()];
    doubled +=
        static_cast<double>(a.x) * static_cast<double>(b.y) - static_cast<double>(b.x) * static_cast<double>(a.y);
  }
  return doubled / 2;
}

/// A corner of a walk, and whether two cells touch there at their corners only: no others are passed twice.
struct WalkCorner {
  Lattice at;
  bool is_touched = false;
};

/// A walk that passes a corner twice, cut there into walks that do not.
///
///      +---+
///      | B |        walk: ... A -> v -> B -> ... -> back to v -> A
///      +---v---+    two rings that touch at v
///          | A |
std::vector<Corners> cut_at_repeats(const std::vector<WalkCorner>& walk) {
  std::vector<Corners> rings;
  Corners open;
  std::unordered_map<std::size_t, std::size_t> place_of;  // looked up, never iterated
  const auto key = [](Lattice p) { return p.y * (kMostCells + 2) + p.x; };
  for (const auto& [p, is_touched] : walk) {
    if (!is_touched) {
      open.push_back(p);
      continue;
    }
    const auto seen = place_of.find(key(p));
    if (seen != place_of.end()) {
      const auto begin = open.begin() + static_cast<std::ptrdiff_t>(seen->second);
      rings.emplace_back(begin, open.end());
      for (auto it = begin; it != open.end(); ++it) place_of.erase(key(*it));
      open.erase(begin, open.end());
    }
    place_of[key(p)] = open.size();
    open.push_back(p);
  }
  rings.push_back(open);
  return rings;
}

/// Only the corners at which the ring turns.
Corners without_straight_corners(const Corners& ring) {
  Corners kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Lattice before = ring[(i + ring.size() - 1) % ring.size()];
    const Lattice after = ring[(i + 1) % ring.size()];
    const bool straight =
        (before.x == ring[i].x && after.x == ring[i].x) || (before.y == ring[i].y && after.y == ring[i].y);
    if (!straight) kept.push_back(ring[i]);
  }
  return kept;
}

std::size_t count_occupied(const Grid& grid) {
  return grid.occupied.size() - static_cast<std::size_t>(std::count(grid.occupied.begin(), grid.occupied.end(), 0));
}

/// What has been seen of a cell.
enum Seen : std::uint8_t { kInComponent = 1, kBottomWalked = 2, kTopWalked = 4 };

/// Takes a byte a cell, 4 for each occupied one, and the boundary of one component at a time.
class Tracer {
 public:
  explicit Tracer(const Grid& grid) : grid_(grid), seen_(grid.occupied.size(), 0) {
    cells_.reserve(count_occupied(grid));
  }

  struct Component {
    Lattice first;               ///< its lowest left cell
    std::vector<Corners> rings;  ///< the outer one first
    std::size_t corners = 0;     ///< beyond kMostCorners the rings are not all there
  };

  /// Every component, in the order of their lowest left cells.
  template <class Take>
  void trace(const Take& take) {
    for (std::uint32_t y = 0; y < grid_.height; ++y) {
      for (std::uint32_t x = 0; x < grid_.width; ++x) {
        if (grid_.at(x, y) && !has_seen({x, y}, kInComponent)) take(component_from({x, y}));
      }
    }
  }

 private:
  std::size_t index(Lattice cell) const { return cell.y * grid_.width + cell.x; }
  bool has_seen(Lattice cell, Seen what) const { return (seen_[index(cell)] & what) != 0; }
  void see(Lattice cell, Seen what) { seen_[index(cell)] = static_cast<std::uint8_t>(seen_[index(cell)] | what); }

  Component component_from(Lattice first) {
    flood(first);
    std::sort(cells_.begin(), cells_.end());
    Component component{first, {}, 0};
    for (const std::uint32_t number : cells_) {
      const Lattice cell = cell_of(number);
      const Lattice beyond{cell.x + 1, cell.y + 1};
      if (!grid_.at(cell.x, cell.y - std::size_t{1}) && !has_seen(cell, kBottomWalked))
        add_walk(cell, kEast, component);
      if (!grid_.at(cell.x, beyond.y) && !has_seen(cell, kTopWalked)) add_walk(beyond, kWest, component);
      if (component.corners > kMostCorners) break;
    }
    return component;
  }

  Lattice cell_of(std::uint32_t number) const {
    const auto width = static_cast<std::uint32_t>(grid_.width);
    return {number % width, number / width};
  }

  void take_cell(Lattice cell) {
    see(cell, kInComponent);
    cells_.push_back(static_cast<std::uint32_t>(index(cell)));
  }

  /// The cells of a component, in `cells_`.
  void flood(Lattice first) {
    cells_.clear();
    take_cell(first);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      for (const Direction d : {kEast, kNorth, kWest, kSouth}) {
        const Lattice next = step(cell_of(cells_[k]), d);  // wraps below 0, which `at` takes for outside
        if (grid_.at(next.x, next.y) && !has_seen(next, kInComponent)) take_cell(next);
      }
    }
  }

  /// The cells round p, from the one between east and north on, counter-clockwise.
  bool is_occupied_round(Lattice p, int quarter) const {
    const bool is_left = quarter == 1 || quarter == 2;
    const bool is_below = quarter >= 2;
    return grid_.at(std::size_t{p.x} - (is_left ? 1 : 0), std::size_t{p.y} - (is_below ? 1 : 0));
  }

  /// Whether the boundary runs from p in direction d: occupied on its left, free on its right.
  bool runs(Lattice p, Direction d) const { return is_occupied_round(p, d) && !is_occupied_round(p, (d + 3) % 4); }

  /// Whether two occupied cells meet at p and nowhere else round it.
  bool is_touched(Lattice p) const {
    const bool first = is_occupied_round(p, 0);
    const bool second = is_occupied_round(p, 1);
    return first != second && first == is_occupied_round(p, 2) && second == is_occupied_round(p, 3);
  }

  void mark(Lattice p, Direction d) {
    if (d == kEast) see(p, kBottomWalked);
    if (d == kWest) see({p.x - 1, p.y - 1}, kTopWalked);
  }

  /// Keeps the component on the left; where two of its cells meet at a corner only, stays with the nearer one (left).
  /// Where it starts, and where it turns; breaks off beyond kMostCorners.
  std::vector<WalkCorner> walk_from(Lattice start, Direction direction) {
    std::vector<WalkCorner> walk{{start, is_touched(start)}};
    Lattice at = start;
    Direction d = direction;
    while (walk.size() <= kMostCorners) {
      mark(at, d);
      at = step(at, d);
      const Direction left = turned_left(d);
      const Direction next = runs(at, left) ? left : runs(at, d) ? d : turned_right(d);
      if (at == start && next == direction) return walk;
      if (next != d) walk.push_back({at, is_touched(at)});
      d = next;
    }
    return walk;
  }

  void add_walk(Lattice start, Direction direction, Component& component) {
    const std::vector<WalkCorner> walk = walk_from(start, direction);
    component.corners += walk.size();
    if (component.corners > kMostCorners) return;
    std::vector<Corners>& rings = component.rings;
    for (const Corners& ring : cut_at_repeats(walk)) {
      const bool is_outer = signed_area(ring) > 0.0;
      rings.insert(is_outer ? rings.begin() : rings.end(), without_straight_corners(ring));
    }
  }

  const Grid& grid_;
  std::vector<std::uint8_t> seen_;    ///< sums of Seen
  std::vector<std::uint32_t> cells_;  ///< of the component under way, by their index
};

geometry::Ring placed(const Corners& corners, const GridPlacement& placement) {
  geometry::Ring ring;
  ring.reserve(corners.size() + 1);
  for (const Lattice p : corners) ring.push_back(lattice_point(placement, p.x, p.y));
  ring.push_back(ring.front());
  return ring;
}

}  // namespace

geometry::Vec2 lattice_point(const GridPlacement& placement, std::size_t column, std::size_t row) {
  const double x =
      placement.resolution * static_cast<double>(placement.first_column + static_cast<std::int64_t>(column));
  const double y = placement.resolution * static_cast<double>(placement.first_row + static_cast<std::int64_t>(row));
  if (placement.yaw == 0.0) return placement.origin + geometry::Vec2{x, y};
  return placement.origin + geometry::rotated({x, y}, placement.yaw);
}

void add_grid(const Grid& grid, const GridPlacement& placement, Collector& out) {
  std::size_t number = 0;
  Tracer(grid).trace([&](const Tracer::Component& component) {
    RawGeometry raw;
    raw.id = std::to_string(number++);
    raw.place = "cells from column " + std::to_string(component.first.x) + ", row " +
                std::to_string(component.first.y) + " from below";
    if (component.corners > kMostCorners) {
      return out.reject({DataCode::size, out.file(), raw.place,
                         "a connected component of more than " + std::to_string(kMostCorners) + " corners",
                         "smaller ones, or a coarser grid"});
    }
    for (const Corners& ring : component.rings) raw.rings.push_back(placed(ring, placement));
    out.add(raw);
  });
  out.set_coverage({grid.width * grid.height, count_occupied(grid), placement.resolution * placement.resolution});
}

}  // namespace exactvo::datasets
