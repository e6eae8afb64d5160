// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/generators.h"

#include <algorithm>
#include <cmath>

#include "exactvo/datasets/random_fields.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/validity.h"
#include "generators/generators.h"

namespace exactvo::datasets {
namespace {

using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::Ring;
using geometry::Vec2;
using Obstacles = std::vector<Obstacle>;

Vec2 on_grid(Vec2 p, double grid) {
  const auto snap = [grid](double x) { return std::floor(x / grid + 0.5) * grid; };
  return {snap(p.x), snap(p.y)};
}

Vec2 point_in(CounterRandom& random, double low, double high) {
  const double x = random.uniform(low, high);
  return on_generator_grid({x, random.uniform(low, high)});
}

Ring counter_clockwise(Ring ring) {
  if (geometry::winding(ring) == geometry::Sign::negative) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// One crossing of two edges undone by walking the stretch between them backwards; false where there is none.
bool untangle_once(Ring& ring) {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i + 2 < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;  // neighbours
      if (!geometry::intersect({ring[i], ring[i + 1]}, {ring[j], ring[(j + 1) % n]})) continue;
      std::reverse(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   ring.begin() + static_cast<std::ptrdiff_t>(j) + 1);
      return true;
    }
  }
  return false;
}

Obstacles field(FieldKind kind, std::uint64_t k, std::uint64_t seed) {
  Obstacles obstacles;
  for (formation::SceneObstacle& o : random_field(kind, k, seed).obstacles) obstacles.push_back(std::move(o.shape));
  return obstacles;
}

struct Kind {
  GeneratorKind facts;
  double side;  ///< m, of the square
  Obstacles (*draw)(CounterRandom& random);
  FieldKind field;  ///< where `draw` is null
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds{
      {{"polygon", "a simple polygon of 4 to 24 corners in a square of 10 m"}, 12.0, random_polygon, {}},
      {{"star", "a star of 5 to 40 corners, 1 to 7 m from its middle"}, 12.0, random_star, {}},
      {{"wall", "an open wall, an L or a U, sides of 2 to 8 m, in any direction"}, 24.0, random_walls, {}},
      {{"needle", "a triangle 2 to 10 m long and 2^-28 to 2^-6 m wide"}, 24.0, random_needle, {}},
      {{"maze", "a maze of 12 by 12 cells with one way between any two, walls 0.25 m thick"}, 32.0, random_maze, {}},
      {{"block", "city blocks round a crossing: 4 of them with buildings, Ls and courtyards"},
       128.0,
       random_blocks,
       {}},
      {{"floor", "a floor plan of 24 by 16 m: rooms, doors of 1 m, some furniture"}, 32.0, random_floor, {}},
      {{"field-convex", "a random field of regular polygons"}, 48.0, nullptr, FieldKind::convex},
      {{"field-open", "a random field of walls, Ls and Us"}, 48.0, nullptr, FieldKind::open},
      {{"field-formation", "a random field along a formation's way"}, 48.0, nullptr, FieldKind::formation},
  };
  return kKinds;
}

const Kind& kind_named(const std::string& name) {
  for (const Kind& kind : kinds()) {
    if (kind.facts.name == name) return kind;
  }
  EXACTVO_REQUIRE(false, name);
}

/// Bits 0, 2, 4, ... of k side by side.
std::uint64_t every_other_bit(std::uint64_t k) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 32; ++i) bits |= ((k >> (2 * i)) & 1U) << i;
  return bits;
}

/// Along a Z-order curve (Morton, 1966): any number of items fills a square or half of one.
Vec2 corner_of_item(const Kind& kind, std::uint64_t k) {
  return {kind.side * static_cast<double>(every_other_bit(k)),
          kind.side * static_cast<double>(every_other_bit(k >> 1))};
}

void shift(Ring& ring, Vec2 by) {
  for (Vec2& p : ring) p += by;
}

void shift(Obstacle& obstacle, Vec2 by) {
  if (auto* line = std::get_if<Polyline>(&obstacle)) return shift(line->points, by);
  auto& polygon = std::get<Polygon>(obstacle);
  shift(polygon.outer, by);
  for (Ring& hole : polygon.holes) shift(hole, by);
}

}  // namespace

Vec2 on_generator_grid(Vec2 p) {
  return on_grid(p, kGeneratorGrid);
}

Vec2 random_direction(CounterRandom& random) {
  const double t = random.uniform(-1.0, 1.0);
  const double denominator = 1.0 + t * t;
  const Vec2 right = {(1.0 - t * t) / denominator, 2.0 * t / denominator};  // within 90 degrees of the x axis
  return random.coin() ? right : -right;
}

/// Corners anywhere, untangled (as CGAL's random_polygon_2 does); a draw with corners in line is drawn again.
Obstacles random_polygon(CounterRandom& random) {
  constexpr int kMostSwaps = 400;
  for (;;) {
    Ring ring;
    for (int n = random.integer(4, 24); n > 0; --n) ring.push_back(point_in(random, 1.0, 11.0));
    for (int swaps = 0; swaps < kMostSwaps && untangle_once(ring);) ++swaps;
    if (geometry::is_simple(ring)) return {Polygon{counter_clockwise(std::move(ring)), {}}};
  }
}

/// Directions to the corners advance round the boundary of a square.
Obstacles random_star(CounterRandom& random) {
  const Vec2 middle{6.0, 6.0};
  for (;;) {
    const int n = random.integer(5, 40);
    Ring ring;
    for (int i = 0; i < n; ++i) {
      const double t = 8.0 * (i + random.uniform(0.1, 0.9)) / n;  // 8 is once round
      const int side = static_cast<int>(t / 2.0);
      const double along = t - 2.0 * side - 1.0;
      const Vec2 sides[] = {{1.0, along}, {-along, 1.0}, {-1.0, -along}, {along, -1.0}};
      ring.push_back(on_generator_grid(middle + random.uniform(1.0, 5.0) * sides[std::min(side, 3)]));
    }
    if (geometry::is_simple(ring)) return {Polygon{counter_clockwise(std::move(ring)), {}}};
  }
}

Obstacles random_walls(CounterRandom& random) {
  const int sides = random.integer(1, 3);
  const Vec2 along = random_direction(random);
  Vec2 at{12.0, 12.0};
  Polyline wall;
  wall.points.push_back(at);
  Vec2 heading = along;
  for (int k = 0; k < sides; ++k) {
    at = on_generator_grid(at + random.uniform(2.0, 8.0) * heading);
    wall.points.push_back(at);
    heading = perp(heading);
  }
  return {wall};
}

/// Its width is below the grid of the other corners: 2^-30 m, which doubles hold up to 2^22 m from the origin.
Obstacles random_needle(CounterRandom& random) {
  const Vec2 start{12.0, 12.0};
  for (;;) {
    const Vec2 along = random_direction(random);
    const double length = random.uniform(2.0, 10.0);
    const Vec2 tip = on_generator_grid(start + length * along);
    double width = 1.0;
    for (int halvings = random.integer(6, 28); halvings > 0; --halvings) width *= 0.5;
    const Vec2 side = start + random.uniform(0.1, 0.9) * (tip - start) + width * perp(along);
    const Ring ring{start, tip, on_grid(side, 0x1p-30)};
    if (geometry::is_simple(ring)) return {Polygon{counter_clockwise(ring), {}}};
  }
}

const std::vector<GeneratorKind>& generator_kinds() {
  static const std::vector<GeneratorKind> kFacts = [] {
    std::vector<GeneratorKind> facts;
    for (const Kind& kind : kinds()) facts.push_back(kind.facts);
    return facts;
  }();
  return kFacts;
}

std::vector<std::string> generator_kind_names() {
  std::vector<std::string> names;
  for (const GeneratorKind& kind : generator_kinds()) names.push_back(kind.name);
  return names;
}

std::vector<formation::SceneObstacle> generated_item(const std::string& name, std::uint64_t k, std::uint64_t seed) {
  const Kind& kind = kind_named(name);
  // Streams of fields are their own; those of kinds begin beyond.
  constexpr std::uint64_t kFirstStream = 16;
  const auto stream = kFirstStream + static_cast<std::uint64_t>(&kind - kinds().data());
  CounterRandom random(random_key(stream, k, seed));
  Obstacles obstacles = kind.draw != nullptr ? kind.draw(random) : field(kind.field, k, seed);
  const Vec2 corner = corner_of_item(kind, k) + (kind.draw != nullptr ? Vec2{} : Vec2{8.0, 8.0});
  std::vector<formation::SceneObstacle> item;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    shift(obstacles[i], corner);
    item.push_back({name + "-" + std::to_string(k) + "/" + std::to_string(i), std::move(obstacles[i])});
  }
  return item;
}

}  // namespace exactvo::datasets
