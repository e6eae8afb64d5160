// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/generators.h"

#include <algorithm>
#include <cmath>

#include "exactvo/datasets/random_fields.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/names.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/validity.h"
#include "generators/counter_random.h"
#include "generators/generators.h"

namespace exactvo::datasets {

namespace {

using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::Ring;
using geometry::Vec2;

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

GeneratedShapes field(FieldKind kind, std::uint64_t k, std::uint64_t seed) {
  GeneratedShapes obstacles;
  for (formation::SceneObstacle& o : random_field(kind, k, seed).obstacles) obstacles.push_back(std::move(o.shape));
  return obstacles;
}

struct Kind {
  GeneratorKind facts;
  double side;  ///< m, of the square
  GeneratedShapes (*draw)(CounterRandom& random);
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

/// Bits 0, 2, 4, ... of k side by side.
std::uint64_t every_other_bit(std::uint64_t k) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 32; ++i) bits |= ((k >> (2 * i)) & 1U) << i;
  return bits;
}

// --- Fields of campaigns ---

using formation::Scenario;
using geometry::Disc;

/// How circumcircles lie: drawn until `most` are placed or the tries are used up.
struct Layout {
  std::size_t most;
  double least_radius, greatest_radius;  ///< m
  double apart;                          ///< m
  double clear_of_ends;                  ///< m
  std::vector<Vec2> ends;                ///< where robots start and end
};

bool fits(const Disc& c, const std::vector<Disc>& placed, const Layout& layout) {
  for (const Disc& other : placed)
    if (norm(c.center - other.center) < c.radius + other.radius + layout.apart) return false;
  for (Vec2 end : layout.ends)
    if (norm(c.center - end) < c.radius + layout.clear_of_ends) return false;
  return true;
}

template <typename DrawCentre>
std::vector<Disc> placed_circles(CounterRandom& draws, const Layout& layout, const DrawCentre& draw_centre) {
  constexpr int kTries = 200;
  std::vector<Disc> placed;
  for (int attempt = 0; attempt < kTries && placed.size() < layout.most; ++attempt) {
    const Disc c{draw_centre(), draws.uniform(layout.least_radius, layout.greatest_radius)};
    if (fits(c, placed, layout)) placed.push_back(c);
  }
  return placed;
}

Vec2 on_grid(Vec2 v) {
  constexpr double kPerMetre = 1024.0;
  return {std::nearbyint(v.x * kPerMetre) / kPerMetre, std::nearbyint(v.y * kPerMetre) / kPerMetre};
}

/// The point of the circle at `turn` revolutions.
Vec2 on_circle(const Disc& c, double turn) {
  const double angle = 2.0 * geometry::kPi * turn;
  return on_grid(c.center + c.radius * Vec2{std::cos(angle), std::sin(angle)});
}

geometry::Obstacle regular_polygon(CounterRandom& draws, const Disc& c) {
  const int corners = draws.integer(3, 6);
  const double first = draws.uniform(0.0, 1.0);
  geometry::Polygon polygon;
  for (int i = 0; i < corners; ++i) polygon.outer.push_back(on_circle(c, first + static_cast<double>(i) / corners));
  return polygon;
}

/// A diameter, an L of two sides or a U of three sides of the inscribed square.
geometry::Obstacle open_wall(CounterRandom& draws, const Disc& c) {
  const int sides = draws.integer(1, 3);
  const double first = draws.uniform(0.0, 1.0);
  if (sides == 1) return geometry::Polyline{{on_circle(c, first), on_circle(c, first + 0.5)}};
  geometry::Polyline wall;
  for (int i = 0; i <= sides; ++i) wall.points.push_back(on_circle(c, first + 0.25 * i));
  return wall;
}

using MakeObstacle = geometry::Obstacle (*)(CounterRandom&, const Disc&);

void add_obstacles(CounterRandom& draws, const std::vector<Disc>& circles, MakeObstacle make, Scenario& scenario) {
  for (const Disc& c : circles)
    scenario.obstacles.push_back({"O" + std::to_string(scenario.obstacles.size() + 1), make(draws, c)});
}

Scenario single_robot_field(CounterRandom& draws, MakeObstacle make) {
  Scenario s;
  s.guidance = formation::Guidance::none;  // as in Section V.A
  s.liveness = formation::Liveness::off;
  formation::Robot robot;
  robot.id = "R1";
  robot.goals = {{25.0, 13.0}};
  s.robots = {robot};
  s.time_limit = 60.0;
  const Layout layout{5, 0.8, 3.0, 1.4, 0.8, {robot.position, robot.goals.front()}};
  const auto centre = [&draws] {
    const double x = draws.uniform(3.0, 22.0);
    return Vec2{x, draws.uniform(-1.0, 14.0)};
  };
  add_obstacles(draws, placed_circles(draws, layout, centre), make, s);
  return s;
}

formation::FormationSpec table_two() {
  formation::FormationSpec f;
  f.topology.adjacency = {{0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
  f.topology.pinning = {1, 1, 1};
  f.offsets = {{1, 1}, {-1, 1}, {1, -1}};
  f.leader = {{{{0, 0}, {25, 25}}, 3.0 * std::sqrt(2.0)}};
  return f;
}

Scenario formation_field(CounterRandom& draws) {
  Scenario s;
  const Vec2 starts[] = {{3, 0}, {0, 3}, {-3, 0}};
  s.formation = table_two();
  Layout layout{6, 0.6, 2.0, 1.6, 0.8, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    formation::Robot robot;
    robot.id = "R" + std::to_string(i + 1);
    robot.position = starts[i];
    robot.max_speed = 6.0;
    s.robots.push_back(robot);
    layout.ends.push_back(starts[i]);
    layout.ends.push_back(s.formation->leader.path.back() + s.formation->offsets[i]);
  }
  s.time_step = 0.02;
  s.time_limit = 25.0;
  const auto centre = [&draws] {
    const double along = draws.uniform(6.0, 20.0);
    const double off = draws.uniform(-4.0, 4.0) / std::sqrt(2.0);
    return Vec2{along - off, along + off};
  };
  add_obstacles(draws, placed_circles(draws, layout, centre), regular_polygon, s);
  return s;
}

constexpr geometry::Names<FieldKind, 3> kNames{
    {{FieldKind::convex, "convex"}, {FieldKind::open, "open"}, {FieldKind::formation, "formation"}}};

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
GeneratedShapes random_polygon(CounterRandom& random) {
  constexpr int kMostSwaps = 400;
  for (;;) {
    Ring ring;
    for (int n = random.integer(4, 24); n > 0; --n) ring.push_back(point_in(random, 1.0, 11.0));
    for (int swaps = 0; swaps < kMostSwaps && untangle_once(ring);) ++swaps;
    if (geometry::is_simple(ring)) return {Polygon{counter_clockwise(std::move(ring)), {}}};
  }
}

/// Directions to the corners advance round the boundary of a square.
GeneratedShapes random_star(CounterRandom& random) {
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

GeneratedShapes random_walls(CounterRandom& random) {
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
GeneratedShapes random_needle(CounterRandom& random) {
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
  const auto named = [&](const Kind& k) { return k.facts.name == name; };
  const auto found = std::find_if(kinds().begin(), kinds().end(), named);
  EXACTVO_REQUIRE(found != kinds().end(), name);
  const Kind& kind = *found;
  // Streams of fields are their own; those of kinds begin beyond.
  constexpr std::uint64_t kFirstStream = 16;
  const auto stream = kFirstStream + static_cast<std::uint64_t>(&kind - kinds().data());
  CounterRandom random(random_key(stream, k, seed));
  GeneratedShapes obstacles = kind.draw != nullptr ? kind.draw(random) : field(kind.field, k, seed);
  // Along a Z-order curve (Morton, 1966): any number of items fills a square or half of one.
  const Vec2 cell{static_cast<double>(every_other_bit(k)), static_cast<double>(every_other_bit(k >> 1))};
  const Vec2 corner = kind.side * cell + (kind.draw != nullptr ? Vec2{} : Vec2{8.0, 8.0});
  std::vector<formation::SceneObstacle> item;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    shift(obstacles[i], corner);
    item.push_back({name + "-" + std::to_string(k) + "/" + std::to_string(i), std::move(obstacles[i])});
  }
  return item;
}

const char* name(FieldKind kind) {
  return geometry::name_in(kNames, kind);
}

std::vector<std::string> field_kind_names() {
  return geometry::words_in(kNames);
}

bool parse(const std::string& text, FieldKind& out) {
  return geometry::parse_in(kNames, text, out);
}

Scenario random_field(FieldKind kind, std::uint64_t k, std::uint64_t seed) {
  CounterRandom draws(random_key(static_cast<std::uint64_t>(kind), k, seed));
  Scenario s = kind == FieldKind::formation
                   ? formation_field(draws)
                   : single_robot_field(draws, kind == FieldKind::convex ? regular_polygon : open_wall);
  s.name = std::string(name(kind)) + "-" + std::to_string(seed) + "-" + std::to_string(k);
  return s;
}

}  // namespace exactvo::datasets
