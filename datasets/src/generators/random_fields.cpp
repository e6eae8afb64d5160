// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/random_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/names.h"
#include "exactvo/geometry/pi.h"
#include "generators/counter_random.h"

namespace exactvo::datasets {
namespace {

using formation::Scenario;
using geometry::Disc;
using geometry::Vec2;

using geometry::kPi;

using Draws = CounterRandom;

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
std::vector<Disc> placed_circles(Draws& draws, const Layout& layout, const DrawCentre& draw_centre) {
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
  const double angle = 2.0 * kPi * turn;
  return on_grid(c.center + c.radius * Vec2{std::cos(angle), std::sin(angle)});
}

geometry::Obstacle regular_polygon(Draws& draws, const Disc& c) {
  const int corners = draws.integer(3, 6);
  const double first = draws.uniform(0.0, 1.0);
  geometry::Polygon polygon;
  for (int i = 0; i < corners; ++i) polygon.outer.push_back(on_circle(c, first + static_cast<double>(i) / corners));
  return polygon;
}

/// A diameter, an L of two sides or a U of three sides of the inscribed square.
geometry::Obstacle open_wall(Draws& draws, const Disc& c) {
  const int sides = draws.integer(1, 3);
  const double first = draws.uniform(0.0, 1.0);
  if (sides == 1) return geometry::Polyline{{on_circle(c, first), on_circle(c, first + 0.5)}};
  geometry::Polyline wall;
  for (int i = 0; i <= sides; ++i) wall.points.push_back(on_circle(c, first + 0.25 * i));
  return wall;
}

using MakeObstacle = geometry::Obstacle (*)(Draws&, const Disc&);

void add_obstacles(Draws& draws, const std::vector<Disc>& circles, MakeObstacle make, Scenario& scenario) {
  for (const Disc& c : circles)
    scenario.obstacles.push_back({"O" + std::to_string(scenario.obstacles.size() + 1), make(draws, c)});
}

Scenario single_robot_field(Draws& draws, MakeObstacle make) {
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
  f.leader = {{{0, 0}, {25, 25}}, 3.0 * std::sqrt(2.0)};
  return f;
}

Scenario formation_field(Draws& draws) {
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
  Draws draws(random_key(static_cast<std::uint64_t>(kind), k, seed));
  Scenario s = kind == FieldKind::formation
                   ? formation_field(draws)
                   : single_robot_field(draws, kind == FieldKind::convex ? regular_polygon : open_wall);
  s.name = std::string(name(kind)) + "-" + std::to_string(seed) + "-" + std::to_string(k);
  return s;
}

}  // namespace exactvo::datasets
