// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/grid.h"

#include <cmath>
#include <unordered_map>

namespace exactvo::datasets {
namespace {

constexpr std::uint32_t kNoLabel = 0;

struct Lattice {
  std::size_t x = 0;
  std::size_t y = 0;
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
  switch (d) {
    case kEast:
      return {p.x + 1, p.y};
    case kNorth:
      return {p.x, p.y + 1};
    case kWest:
      return {p.x - 1, p.y};
    default:
      return {p.x, p.y - 1};
  }
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

/// A walk that passes a corner twice, cut there into walks that do not.
///
///      +---+
///      | B |        walk: ... A -> v -> B -> ... -> back to v -> A
///      +---v---+    two rings that touch at v
///          | A |
std::vector<Corners> cut_at_repeats(const Corners& walk) {
  std::vector<Corners> rings;
  Corners open;
  std::unordered_map<std::size_t, std::size_t> place_of;  // looked up, never iterated
  const auto key = [](Lattice p) { return p.y * (kMostCells + 2) + p.x; };
  for (const Lattice p : walk) {
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

class Tracer {
 public:
  explicit Tracer(const Grid& grid)
      : grid_(grid),
        label_(grid.occupied.size(), kNoLabel),
        bottom_done_(grid.occupied.size(), 0),
        top_done_(bottom_done_) {
    for (std::size_t y = 0; y < grid.height; ++y) {
      for (std::size_t x = 0; x < grid.width; ++x) {
        if (grid.at(x, y) && label_[index(x, y)] == kNoLabel) flood({x, y});
      }
    }
  }

  struct Component {
    Lattice first;               ///< its lowest left cell
    std::vector<Corners> rings;  ///< the outer one first
  };

  std::vector<Component> trace() {
    std::vector<Component> components(first_cells_.size());
    for (std::size_t k = 0; k < components.size(); ++k) components[k].first = first_cells_[k];
    for (std::size_t y = 0; y < grid_.height; ++y) {
      for (std::size_t x = 0; x < grid_.width; ++x) {
        if (!grid_.at(x, y)) continue;
        std::vector<Corners>& rings = components[label_[index(x, y)] - 1].rings;
        if (!grid_.at(x, y - 1) && bottom_done_[index(x, y)] == 0) add_walk({x, y}, kEast, rings);
        if (!grid_.at(x, y + 1) && top_done_[index(x, y)] == 0) add_walk({x + 1, y + 1}, kWest, rings);
      }
    }
    return components;
  }

 private:
  std::size_t index(std::size_t x, std::size_t y) const { return y * grid_.width + x; }

  void flood(Lattice start) {
    first_cells_.push_back(start);
    const auto label = static_cast<std::uint32_t>(first_cells_.size());
    std::vector<Lattice> waiting{start};
    label_[index(start.x, start.y)] = label;
    while (!waiting.empty()) {
      const Lattice cell = waiting.back();
      waiting.pop_back();
      for (const Direction d : {kEast, kNorth, kWest, kSouth}) {
        const Lattice next = step(cell, d);  // wraps below 0, which `at` takes for outside
        if (!grid_.at(next.x, next.y) || label_[index(next.x, next.y)] != kNoLabel) continue;
        label_[index(next.x, next.y)] = label;
        waiting.push_back(next);
      }
    }
  }

  /// Whether the boundary runs from p in direction d: occupied on its left, free on its right.
  bool runs(Lattice p, Direction d) const {
    switch (d) {
      case kEast:
        return grid_.at(p.x, p.y) && !grid_.at(p.x, p.y - 1);
      case kNorth:
        return grid_.at(p.x - 1, p.y) && !grid_.at(p.x, p.y);
      case kWest:
        return grid_.at(p.x - 1, p.y - 1) && !grid_.at(p.x - 1, p.y);
      default:
        return grid_.at(p.x, p.y - 1) && !grid_.at(p.x - 1, p.y - 1);
    }
  }

  void mark(Lattice p, Direction d) {
    if (d == kEast) bottom_done_[index(p.x, p.y)] = 1;
    if (d == kWest) top_done_[index(p.x - 1, p.y - 1)] = 1;
  }

  /// Keeps the component on the left; where two of its cells meet at a corner only, stays with the nearer one (left).
  Corners walk_from(Lattice start, Direction direction) {
    Corners walk;
    Lattice at = start;
    Direction d = direction;
    do {
      walk.push_back(at);
      mark(at, d);
      at = step(at, d);
      const Direction left = turned_left(d);
      d = runs(at, left) ? left : runs(at, d) ? d : turned_right(d);
    } while (!(at == start && d == direction));
    return walk;
  }

  void add_walk(Lattice start, Direction direction, std::vector<Corners>& rings) {
    for (const Corners& ring : cut_at_repeats(walk_from(start, direction))) {
      const bool is_outer = signed_area(ring) > 0.0;
      rings.insert(is_outer ? rings.begin() : rings.end(), without_straight_corners(ring));
    }
  }

  const Grid& grid_;
  std::vector<std::uint32_t> label_;  ///< from 1
  std::vector<std::uint8_t> bottom_done_;
  std::vector<std::uint8_t> top_done_;
  std::vector<Lattice> first_cells_;
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
  const std::vector<Tracer::Component> components = Tracer(grid).trace();
  for (std::size_t k = 0; k < components.size(); ++k) {
    RawGeometry raw;
    raw.id = std::to_string(k);
    raw.place = "cells from column " + std::to_string(components[k].first.x) + ", row " +
                std::to_string(components[k].first.y) + " from below";
    for (const Corners& ring : components[k].rings) raw.rings.push_back(placed(ring, placement));
    out.add(raw);
  }
  std::size_t occupied = 0;
  for (const std::uint8_t cell : grid.occupied) occupied += cell != 0 ? 1 : 0;
  out.set_coverage({grid.width * grid.height, occupied, placement.resolution * placement.resolution});
}

}  // namespace exactvo::datasets
