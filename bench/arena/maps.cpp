// SPDX-License-Identifier: GPL-3.0-or-later
#include "maps.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/geometry/distance.h"
#include "formation/liveness_scenes.h"

namespace exactvo::bench {
namespace {

using formation::Scenario;
using geometry::Vec2;
using test::SeededRandom;
namespace scenes = formation::test_scenes;

constexpr int kCells = 64;
constexpr double kCell = 0.5 / 0.3;
constexpr double kSide = kCells * kCell;
constexpr double kFromWalls = 0.6;  // of a start or goal
constexpr double kApart = 1.2;

/// One cell thick, across the map at that row or column, with gaps of a cell.
void add_wall(Scenario& s, bool upright, int at, const std::vector<int>& gaps) {
  const auto wall = [&](int from, int to) {
    if (from >= to) return;
    const Vec2 low = upright ? Vec2{at * kCell, from * kCell} : Vec2{from * kCell, at * kCell};
    const Vec2 high = upright ? Vec2{(at + 1) * kCell, to * kCell} : Vec2{to * kCell, (at + 1) * kCell};
    s.obstacles.push_back({"wall" + std::to_string(s.obstacles.size() + 1),
                           geometry::Polygon{{low, {high.x, low.y}, high, {low.x, high.y}}, {}}});
  };
  int from = 0;
  for (const int gap : gaps) {
    wall(from, gap);
    from = gap + 1;
  }
  wall(from, kCells);
}

bool is_free(const Scenario& s, Vec2 p) {
  return std::all_of(s.obstacles.begin(), s.obstacles.end(), [&](const formation::SceneObstacle& o) {
    return geometry::signed_distance(o.shape, p) >= kFromWalls;  // negative inside
  });
}

/// In the middle of cells. `sides`: by turns left and right of the middle.
std::vector<Vec2> places(const Scenario& s, int count, bool sides, bool left_first, SeededRandom& random) {
  std::vector<Vec2> found;
  while (static_cast<int>(found.size()) < count) {
    const int column = random.integer(0, kCells - 1), row = random.integer(0, kCells - 1);
    const Vec2 p{(column + 0.5) * kCell, (row + 0.5) * kCell};
    const bool wants_left = (found.size() % 2 == 0) == left_first;
    if ((sides && (p.x < 0.5 * kSide) != wants_left) || !is_free(s, p)) continue;
    if (std::all_of(found.begin(), found.end(), [&](Vec2 q) { return norm(p - q) > kApart; })) found.push_back(p);
  }
  return found;
}

Scenario with_robots(Scenario s, int count, bool change_sides, SeededRandom& random) {
  scenes::add_wall(s, {{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}, {0, 0}});
  const std::vector<Vec2> from = places(s, count, change_sides, true, random);
  const std::vector<Vec2> to = places(s, count, change_sides, false, random);
  for (std::size_t i = 0; i < from.size(); ++i) scenes::add_robot(s, from[i], to[i]);
  return s;
}

}  // namespace

Scenario gap_map(int robots, SeededRandom& random) {
  Scenario s;
  s.name = "gap";
  add_wall(s, true, kCells / 2, {kCells / 2});
  return with_robots(std::move(s), robots, true, random);
}

Scenario room_map(int robots, SeededRandom& random) {
  Scenario s;
  s.name = "rooms";
  for (const bool upright : {true, false})
    for (const int at : {16, 32, 48}) add_wall(s, upright, at, {8, 24, 40, 56});
  return with_robots(std::move(s), robots, false, random);
}

}  // namespace exactvo::bench
