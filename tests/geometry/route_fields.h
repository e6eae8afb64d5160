// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Worlds in which routes are hard to decide: gaps at the doubles next to two radii, ties of every kind, corridors that
/// differ by 1e-12.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/shapes.h"
#include "support/seeded_random.h"

namespace exactvo::test {

using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::Ring;
using geometry::Vec2;

struct RouteField {
  std::vector<Obstacle> obstacles;
  Vec2 start, goal;
};

enum class FieldKind {
  scattered,  ///< polygons and walls anywhere, overlapping too
  boxes,      ///< axis-parallel boxes on integers: ties of distance everywhere
  lattice,    ///< short walls between integer points: Pythagorean ties, crossings, T-junctions
  maze,       ///< a turned maze with doors of nearly one width
  bars,       ///< corridors that differ in width by 1e-12 at the most
  rounded     ///< a turned occupancy grid with rounded digits: corners of neighbours that differ by 1e-6 to 1e-12
};
inline constexpr FieldKind kFieldKinds[] = {FieldKind::scattered, FieldKind::boxes, FieldKind::lattice,
                                            FieldKind::maze,      FieldKind::bars,  FieldKind::rounded};
inline constexpr const char* kFieldKindNames[] = {"scattered", "boxes", "lattice", "maze", "bars", "rounded"};

/// A closed wall, so that nothing leaves.
inline Polyline fence(const std::vector<Vec2>& ring) {
  Polyline wall{ring};
  wall.points.push_back(ring.front());
  return wall;
}

inline Polygon box_at(double x, double y, double w, double h) {
  return {{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, {}};
}

inline RouteField scattered_field(SeededRandom& random, FieldKind kind) {
  RouteField f;
  f.obstacles.push_back(fence({{0, 0}, {24, 0}, {24, 24}, {0, 24}}));
  const int count = random.integer(4, kind == FieldKind::lattice ? 50 : 24);
  for (int k = 0; k < count; ++k) {
    if (kind == FieldKind::boxes) {
      f.obstacles.push_back(
          box_at(random.integer(1, 20), random.integer(1, 20), random.integer(1, 3), random.integer(1, 3)));
    } else if (kind == FieldKind::lattice) {
      const Vec2 a{1.0 * random.integer(1, 23), 1.0 * random.integer(1, 23)};
      const Vec2 b{std::clamp(a.x + random.integer(-3, 3), 1.0, 23.0),
                   std::clamp(a.y + random.integer(-3, 3), 1.0, 23.0)};
      if (!(a == b)) f.obstacles.push_back(Polyline{{a, b}});
    } else {
      const Vec2 c{random.uniform(1, 23), random.uniform(1, 23)};
      const double r = random.uniform(0.2, 2.5);
      std::vector<double> angles(static_cast<std::size_t>(random.integer(2, 7)));
      for (double& a : angles) a = random.uniform(0, 2 * geometry::kPi);
      std::sort(angles.begin(), angles.end());
      std::vector<Vec2> points;
      for (const double a : angles) points.push_back(c + r * Vec2{std::cos(a), std::sin(a)});
      if (points.size() == 2)
        f.obstacles.push_back(Polyline{points});
      else
        f.obstacles.push_back(Polygon{points, {}});
    }
  }
  const bool halves = kind != FieldKind::scattered;
  const auto place = [&] {
    if (!halves) return Vec2{random.uniform(0.5, 23.5), random.uniform(0.5, 23.5)};
    return Vec2{0.5 * random.integer(2, 46), 0.5 * random.integer(2, 46)};
  };
  f.start = place();
  f.goal = place();
  return f;
}

/// Turns everything by one angle.
class Turn {
 public:
  explicit Turn(double angle) : c_(std::cos(angle)), s_(std::sin(angle)) {}
  Vec2 operator()(Vec2 p) const { return {c_ * p.x - s_ * p.y, s_ * p.x + c_ * p.y}; }

 private:
  double c_, s_;
};

/// Rooms of side 4 joined as a random spanning tree with some loops; inner walls share their posts.
inline RouteField maze_field(SeededRandom& random) {
  constexpr double kRoom = 4.0;
  const int n = random.integer(3, 5);
  const Turn turn(random.integer(0, 3) ? random.uniform(0, 2 * geometry::kPi) : 0.0);
  RouteField f;
  const double side = n * kRoom;
  f.obstacles.push_back(fence({turn({0, 0}), turn({side, 0}), turn({side, side}), turn({0, side})}));
  struct Wall {
    int x, y;
    bool across;  ///< between (x, y) and (x, y + 1); else (x + 1, y)
  };
  std::vector<Wall> walls;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      if (x + 1 < n) walls.push_back({x, y, false});
      if (y + 1 < n) walls.push_back({x, y, true});
    }
  for (std::size_t k = walls.size(); k-- > 1;)
    std::swap(walls[k], walls[static_cast<std::size_t>(random.integer(0, static_cast<int>(k)))]);
  std::vector<int> up(static_cast<std::size_t>(n * n));
  std::iota(up.begin(), up.end(), 0);
  const std::function<int(int)> root = [&](int i) { return up[i] == i ? i : up[i] = root(up[i]); };
  for (const Wall& w : walls) {
    const int a = root(w.y * n + w.x), b = root(w.across ? (w.y + 1) * n + w.x : w.y * n + w.x + 1);
    const Vec2 from{(w.across ? w.x : w.x + 1) * kRoom, (w.across ? w.y + 1 : w.y) * kRoom};
    const Vec2 along = w.across ? Vec2{1, 0} : Vec2{0, 1};
    const auto at = [&](double k) { return turn(from + k * along); };
    if (a == b && random.integer(0, 5) > 0) {
      f.obstacles.push_back(Polyline{{at(0), at(kRoom)}});
      continue;
    }
    up[a] = b;
    const double door = random.integer(0, 2) ? 1.0 + random.uniform(-1e-3, 1e-3) : random.uniform(0.5, 1.5);
    const double left = random.uniform(0.2, 3.8 - door);
    f.obstacles.push_back(Polyline{{at(0), at(left)}});
    f.obstacles.push_back(Polyline{{at(left + door), at(kRoom)}});
  }
  f.start = turn({random.uniform(1, 3), random.uniform(1, 3)});
  f.goal = turn({side - random.uniform(1, 3), side - random.uniform(1, 3)});
  return f;
}

inline RouteField bars_field(SeededRandom& random) {
  const Turn turn(random.integer(0, 3) ? random.uniform(0, 2 * geometry::kPi) : 0.0);
  const int n = random.integer(2, 6);
  std::vector<double> heights;
  double y = 0.0;
  for (int k = 0; k < n; ++k)
    heights.push_back(y += 1.0 + (random.integer(0, 1) ? random.uniform(-1e-12, 1e-12) : 0.0));
  const double width = random.uniform(4, 12), height = y + 1.0;
  RouteField f;
  f.obstacles.push_back(fence({turn({0, 0}), turn({width, 0}), turn({width, height}), turn({0, height})}));
  for (int k = 0; k < n; ++k) {
    const double gap = 1.0 + (random.integer(0, 1) ? random.uniform(-1e-13, 1e-13) : 0.0);
    const bool right = k % 2 == 1;
    const Vec2 a{right ? gap : 0.001, heights[k]}, b{right ? width - 0.001 : width - gap, heights[k]};
    f.obstacles.push_back(Polyline{{turn(a), turn(b)}});
  }
  f.start = turn({width / 2, 0.5});
  f.goal = turn({width / 2, height - 0.5});
  return f;
}

/// Rows of occupied cells as boxes, each rounded by itself as a file of this many digits has it.
inline RouteField rounded_field(SeededRandom& random) {
  const Turn turn(random.integer(0, 3) ? random.uniform(0, 2 * geometry::kPi) : 0.0);
  const double digits = std::pow(10.0, random.integer(6, 12));
  const double away = random.integer(0, 1) ? 0.0 : 100.0;
  const auto at = [&](double x, double y) {
    const Vec2 p = turn({x, y});
    return Vec2{std::round((p.x + away) * digits) / digits, std::round((p.y + away) * digits) / digits};
  };
  const int n = 2 * random.integer(3, 5);
  RouteField f;
  f.obstacles.push_back(fence({at(-2, -2), at(n + 2, -2), at(n + 2, n + 2), at(-2, n + 2)}));
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      if (random.integer(0, 3)) continue;
      const int length = random.integer(1, 3);
      f.obstacles.push_back(Polygon{{at(x, y), at(x + length, y), at(x + length, y + 1), at(x, y + 1)}, {}});
      x += length;
    }
  }
  f.start = at(random.uniform(-1, n + 1), random.uniform(-1, n + 1));
  f.goal = at(random.uniform(-1, n + 1), random.uniform(-1, n + 1));
  return f;
}

inline RouteField route_field(SeededRandom& random, FieldKind kind) {
  if (kind == FieldKind::rounded) return rounded_field(random);
  if (kind == FieldKind::maze) return maze_field(random);
  if (kind == FieldKind::bars) return bars_field(random);
  return scattered_field(random, kind);
}

}  // namespace exactvo::test
