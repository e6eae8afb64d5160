// SPDX-License-Identifier: GPL-3.0-or-later
// Mazes, city blocks and floor plans: whole numbers of cells, traced to polygons where walls join.
#include <algorithm>

#include "generators/generators.h"

namespace exactvo::datasets {
namespace {

using geometry::Ring;
using geometry::Vec2;

/// Cells that are solid, and the polygons that they make.
class Plan {
 public:
  Plan(std::size_t width, std::size_t height) : grid_{width, height, std::vector<std::uint8_t>(width * height, 0)} {}

  bool solid(int x, int y) const { return grid_.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)); }
  /// Both ends included.
  void fill(int x0, int y0, int x1, int y1, bool solid = true) {
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x)
        grid_.occupied[static_cast<std::size_t>(y) * grid_.width + static_cast<std::size_t>(x)] = solid ? 1 : 0;
    }
  }

  GeneratedShapes polygons(Vec2 origin, double cell) const {
    Collector out("generated", "generated", {});
    add_grid(grid_, {origin, cell, 0.0, 0, 0}, out);
    GeneratedShapes obstacles;
    for (formation::SceneObstacle& o : out.take().obstacles) obstacles.push_back(std::move(o.shape));
    return obstacles;
  }

 private:
  Grid grid_;
};

struct Cell {
  int x, y;
};

// --- Mazes ---

constexpr int kMazeCells = 12;
constexpr int kPassage = 5;  ///< plan cells a maze cell: one of wall, four to walk

/// The wall's corner below and left of a maze cell.
int wall_of(int cell) {
  return cell * kPassage;
}

void open_between(Plan& plan, Cell a, Cell b) {
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  if (a.x != b.x) {
    plan.fill(wall_of(x + 1), wall_of(y) + 1, wall_of(x + 1), wall_of(y + 1) - 1, false);
  } else {
    plan.fill(wall_of(x) + 1, wall_of(y + 1), wall_of(x + 1) - 1, wall_of(y + 1), false);
  }
}

/// Depth first, backtracking: every cell is reached, by one way.
void dig(Plan& plan, CounterRandom& random) {
  const auto number = [](Cell c) { return static_cast<std::size_t>(c.y * kMazeCells + c.x); };
  std::vector<bool> seen(static_cast<std::size_t>(kMazeCells * kMazeCells), false);
  std::vector<Cell> way{{0, 0}};
  while (!way.empty()) {
    const Cell c = way.back();
    seen[number(c)] = true;
    std::vector<Cell> open;
    for (const Cell n : {Cell{c.x + 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x - 1, c.y}, Cell{c.x, c.y - 1}}) {
      const bool is_inside = n.x >= 0 && n.y >= 0 && n.x < kMazeCells && n.y < kMazeCells;
      if (is_inside && !seen[number(n)]) open.push_back(n);
    }
    if (open.empty()) {
      way.pop_back();
      continue;
    }
    way.push_back(open[static_cast<std::size_t>(random.integer(0, static_cast<int>(open.size()) - 1))]);
    open_between(plan, c, way.back());
  }
}

// --- City blocks ---

/// A whole number of metres.
Vec2 corner(int x, int y) {
  return {static_cast<double>(x), static_cast<double>(y)};
}

Ring rectangle(int x0, int y0, int x1, int y1) {
  return {corner(x0, y0), corner(x1, y0), corner(x1, y1), corner(x0, y1)};
}

Ring reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

///  +---+
///  |   |        An L in the rectangle, the notch at its upper right.
///  |   +---+
///  +-------+
Ring ell(int x0, int y0, int x1, int y1) {
  const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
  return {corner(x0, y0), corner(x1, y0), corner(x1, y), corner(x, y), corner(x, y1), corner(x0, y1)};
}

geometry::Polygon building(CounterRandom& random, int x0, int y0, int x1, int y1) {
  const bool has_room = x1 - x0 >= 12 && y1 - y0 >= 12;
  const int what = random.integer(0, 3);
  if (what == 0 && has_room) return {rectangle(x0, y0, x1, y1), {reversed(rectangle(x0 + 4, y0 + 4, x1 - 4, y1 - 4))}};
  if (what == 1 && x1 - x0 >= 6 && y1 - y0 >= 6) return {ell(x0, y0, x1, y1), {}};
  return {rectangle(x0, y0, x1, y1), {}};
}

/// Lots along the longer side, each with a building that keeps to itself.
void build_block(CounterRandom& random, int x0, int y0, int x1, int y1, GeneratedShapes& out) {
  int at = x0;
  while (x1 - at >= 8) {
    int end = at + random.integer(8, 24);
    if (x1 - end < 8) end = x1;
    const int setback = random.integer(1, 3);
    out.emplace_back(building(random, at + 1, y0 + setback, end - 1, y1 - random.integer(1, 3)));
    at = end;
  }
}

// --- Floor plans ---

constexpr int kFloorWidth = 96;    ///< cells of 0.25 m
constexpr int kFloorHeight = 64;   ///< cells
constexpr int kDoor = 4;           ///< cells
constexpr int kSmallestRoom = 14;  ///< cells between walls

/// A room inside its walls: cells x0..x1, y0..y1.
struct Room {
  int x0, y0, x1, y1;
  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
};

/// Where a wall across may stand without closing a door: it leaves one side's corner free.
bool wall_meets_door(const Plan& plan, const Room& room, bool upright, int at) {
  return upright ? !plan.solid(at, room.y0 - 1) || !plan.solid(at, room.y1 + 1)
                 : !plan.solid(room.x0 - 1, at) || !plan.solid(room.x1 + 1, at);
}

void put_wall(Plan& plan, CounterRandom& random, const Room& room, bool upright, int at) {
  if (upright) {
    plan.fill(at, room.y0, at, room.y1);
    const int door = random.integer(room.y0 + 1, room.y1 - kDoor);
    plan.fill(at, door, at, door + kDoor - 1, false);
  } else {
    plan.fill(room.x0, at, room.x1, at);
    const int door = random.integer(room.x0 + 1, room.x1 - kDoor);
    plan.fill(door, at, door + kDoor - 1, at, false);
  }
}

void furnish(Plan& plan, CounterRandom& random, const Room& room) {
  if (!random.coin()) return;
  const int w = random.integer(2, 5), h = random.integer(2, 4);
  const int x = random.integer(room.x0 + kDoor + 1, std::max(room.x0 + kDoor + 1, room.x1 - kDoor - w));
  const int y = random.integer(room.y0 + kDoor + 1, std::max(room.y0 + kDoor + 1, room.y1 - kDoor - h));
  plan.fill(x, y, std::min(x + w - 1, room.x1 - 1), std::min(y + h - 1, room.y1 - 1));
}

void divide(Plan& plan, CounterRandom& random, const Room& whole) {
  std::vector<Room> open{whole};
  while (!open.empty()) {
    const Room room = open.back();
    open.pop_back();
    const bool upright = room.width() >= room.height();
    const int length = upright ? room.width() : room.height();
    if (length < 2 * kSmallestRoom + 1) {
      furnish(plan, random, room);
      continue;
    }
    const int start = upright ? room.x0 : room.y0;
    const int at = start + random.integer(kSmallestRoom, length - kSmallestRoom - 1);
    if (wall_meets_door(plan, room, upright, at)) {
      furnish(plan, random, room);
      continue;
    }
    put_wall(plan, random, room, upright, at);
    open.push_back(upright ? Room{room.x0, room.y0, at - 1, room.y1} : Room{room.x0, room.y0, room.x1, at - 1});
    open.push_back(upright ? Room{at + 1, room.y0, room.x1, room.y1} : Room{room.x0, at + 1, room.x1, room.y1});
  }
}

}  // namespace

GeneratedShapes random_maze(CounterRandom& random) {
  constexpr int kSide = kMazeCells * kPassage + 1;
  Plan plan(kSide, kSide);
  for (int k = 0; k <= kMazeCells; ++k) {
    plan.fill(wall_of(k), 0, wall_of(k), kSide - 1);
    plan.fill(0, wall_of(k), kSide - 1, wall_of(k));
  }
  dig(plan, random);
  plan.fill(1, 0, kPassage - 1, 0, false);                              // in, lower left
  plan.fill(kSide - kPassage, kSide - 1, kSide - 2, kSide - 1, false);  // out, upper right
  return plan.polygons({8.0, 8.0}, 0.25);
}

GeneratedShapes random_blocks(CounterRandom& random) {
  constexpr int kSide = 120;
  const int street = random.integer(8, 16);
  const int x = random.integer(40, 70), y = random.integer(40, 70);
  GeneratedShapes buildings;
  build_block(random, 4, 4, x, y, buildings);
  build_block(random, x + street, 4, kSide, y, buildings);
  build_block(random, 4, y + street, x, kSide, buildings);
  build_block(random, x + street, y + street, kSide, kSide, buildings);
  return buildings;
}

GeneratedShapes random_floor(CounterRandom& random) {
  Plan plan(kFloorWidth + 2, kFloorHeight + 2);
  plan.fill(0, 0, kFloorWidth + 1, kFloorHeight + 1);
  plan.fill(1, 1, kFloorWidth, kFloorHeight, false);
  divide(plan, random, {1, 1, kFloorWidth, kFloorHeight});
  const int entrance = random.integer(2, kFloorWidth - kDoor);
  plan.fill(entrance, 0, entrance + kDoor - 1, 0, false);
  return plan.polygons({4.0, 8.0}, 0.25);
}

}  // namespace exactvo::datasets
