// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Crowds for tests, audits and benches: where robots stand and where they want to go. The same on every machine.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/formation/crowd.h"

namespace exactvo::formation {

struct CrowdScene {
  CrowdOptions options;
  std::vector<CrowdKind> kinds;
  struct Robot {
    Vec2 at, goal;
    KindId kind = 0;
  };
  std::vector<Robot> robots;
  std::vector<geometry::Obstacle> obstacles;
  struct Body {
    geometry::ConvexShape shape;
    bool moves = false;
    Vec2 velocity;
  };
  std::vector<Body> bodies;
  double preferred_speed = 1.2;  ///< m/s

  /// Straight for the goal, slower in the last metre.
  Vec2 preferred(std::size_t robot, Vec2 from) const {
    const Vec2 way = robots[robot].goal - from;
    const double squared = geometry::squared_norm(way);
    return way * (preferred_speed / (squared > 1.0 ? std::sqrt(squared) : 1.0));
  }
};

/// SplitMix64.
class SceneRandom {
 public:
  double operator()() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 1;
};

namespace scenes {

/// A robot of 1 m a place of 4 m^2, which covers 20 % of the floor, each to a random place: dense, and ever denser.
inline void crowd(CrowdScene& s, std::size_t count) {
  SceneRandom random;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const double width = 2.0 * static_cast<double>(side);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 at = {2.0 * static_cast<double>(i % side) + 0.5 * random(),
                     2.0 * static_cast<double>(i / side) + 0.5 * random()};
    s.robots.push_back({at - Vec2{width / 2, width / 2}, {width * (random() - 0.5), width * (random() - 0.5)}});
  }
}

/// Robots that cover 40 % of the floor, each to a random place.
inline void dense(CrowdScene& s, std::size_t count) {
  SceneRandom random;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const double width = 1.4 * static_cast<double>(side);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 at = {1.4 * static_cast<double>(i % side) + 0.38 * random(),
                     1.4 * static_cast<double>(i / side) + 0.38 * random()};
    s.robots.push_back({at, {width * random(), width * random()}});
  }
}

/// On a ring, each to the other side.
inline void ring(CrowdScene& s, std::size_t count) {
  s.kinds[0] = {1.5, 2.0, 10.0, 15.0, 10};
  s.preferred_speed = 1.0;
  const double radius = 0.8 * static_cast<double>(count);
  while (radius * 1.01 > 0x1p30 * s.options.position_step) s.options.position_step *= 2.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
    const Vec2 at = {radius * std::cos(angle), radius * std::sin(angle)};
    s.robots.push_back({at, -at});
  }
}

/// Two streams through each other, 2.5 m from robot to robot in each.
inline void streams(CrowdScene& s, std::size_t count) {
  SceneRandom random;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count) / 2.0)));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i / 2;
    const double shift = i % 2 ? 1.25 : 0.0;
    const Vec2 at = {2.5 * static_cast<double>(k % side) + 0.5 * random() + shift,
                     2.5 * static_cast<double>(k / side) + 0.5 * random() + shift};
    s.robots.push_back({at, {at.x + (i % 2 ? -1000.0 : 1000.0), at.y}});
  }
}

/// Four groups that cross in the middle.
inline void groups(CrowdScene& s, std::size_t count) {
  SceneRandom random;
  s.kinds[0] = {2.0, 2.0, 5.0, 15.0, 10};
  s.preferred_speed = 1.0;
  s.options.position_step = 0x1p-17;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count) / 4.0)));
  const double scale = static_cast<double>(side) / 5.0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i / 4;
    const double x = 55.0 * scale + 10.0 * static_cast<double>(k % side) + 0.1 * random();
    const double y = 55.0 * scale + 10.0 * static_cast<double>(k / side) + 0.1 * random();
    const double left = i & 1U ? -1.0 : 1.0, down = i & 2U ? -1.0 : 1.0;
    s.robots.push_back({{left * x, down * y}, {-left * 75.0 * scale, -down * 75.0 * scale}});
  }
}

inline geometry::Obstacle square(Vec2 low, double side) {
  return geometry::Polygon{{low, {low.x + side, low.y}, {low.x + side, low.y + side}, {low.x, low.y + side}}, {}};
}

/// The four groups, round four blocks.
inline void blocks(CrowdScene& s, std::size_t count) {
  groups(s, count);
  const double scale = std::ceil(std::sqrt(static_cast<double>(count) / 4.0)) / 5.0;
  for (const double x : {-40.0, 10.0})
    for (const double y : {-40.0, 10.0}) s.obstacles.push_back(square(Vec2{x, y} * scale, 30.0 * scale));
}

/// A loose crowd among square pillars, one for every four robots, inside a wall.
inline void pillars(CrowdScene& s, std::size_t count) {
  SceneRandom random;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const double width = 3.0 * static_cast<double>(side);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 at = {3.0 * static_cast<double>(i % side) + 0.3 * random(),
                     3.0 * static_cast<double>(i / side) + 0.3 * random()};
    s.robots.push_back({at, {width * random(), width * random()}});
    if (i % side % 2 == 1 && i / side % 2 == 1) s.obstacles.push_back(square(at + Vec2{1.2, 1.2}, 0.5));
  }
  const double low = -1.5, high = width + 1.5;
  s.obstacles.push_back(geometry::Polyline{{{low, low}, {high, low}, {high, high}, {low, high}, {low, low}}});
}

/// A loose crowd among discs, ellipses, hexagons, segments and points, two in three at rest, the others under way.
inline void bodies(CrowdScene& s, std::size_t count) {
  pillars(s, count);
  s.obstacles.erase(s.obstacles.begin(), s.obstacles.end() - 1);
  SceneRandom random;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::size_t i = 0, k = 0; i < count; ++i) {
    if (i % side % 2 == 0 || i / side % 2 == 0) continue;
    const Vec2 at = s.robots[i].at + Vec2{1.5, 1.5};
    geometry::ConvexShape shape = geometry::Disc{at, 0.1 + 0.4 * random()};
    if (k % 5 == 1) shape = geometry::Ellipse{at, 0.2 + 0.3 * random(), 0.3 * random() - 0.15, 0.05 + 0.2 * random()};
    if (k % 5 == 2) {
      geometry::ConvexPolygon hexagon;
      for (const Vec2 c :
           {Vec2{0.4, 0.0}, Vec2{0.2, 0.3}, Vec2{-0.2, 0.3}, Vec2{-0.4, 0.0}, Vec2{-0.2, -0.3}, Vec2{0.2, -0.3}})
        hexagon.vertices.push_back(at + 0.7 * c);
      shape = hexagon;
    }
    if (k % 5 == 3) shape = geometry::Segment{at, at + Vec2{0.4 * random(), 0.4 * random() - 0.2}};
    if (k % 5 == 4) shape = geometry::Disc{at, 0.0};
    const bool moves = k % 3 == 2;
    s.bodies.push_back({shape, moves, moves ? Vec2{2.0 * random() - 1.0, 2.0 * random() - 1.0} : Vec2{}});
    ++k;
  }
}

/// A crowd of large and slow, small and fast, far-sighted and near-sighted robots.
inline void mixture(CrowdScene& s, std::size_t count) {
  crowd(s, count);
  s.kinds = {{0.5, 1.5, 5.0, 15.0, 10}, {0.7, 0.8, 3.0, 8.0, 5}, {0.25, 2.5, 8.0, 20.0, 15}};
  for (std::size_t i = 0; i < count; ++i) s.robots[i].kind = static_cast<KindId>(i % 7 % 3);
}

/// The dense crowd on wheels: at full speed a wheel stops within a step.
inline void wheels(CrowdScene& s, std::size_t count) {
  crowd(s, count);
  s.kinds[0].wheels = CrowdWheels{0.4, 0.6, 8.0};
}

/// All to one point: a jam.
inline void jam(CrowdScene& s, std::size_t count) {
  crowd(s, count);
  for (CrowdScene::Robot& robot : s.robots) robot.goal = {};
}

/// Tight clumps far apart, all in a long row: windows of one robot hold hundreds, strips hold few.
inline void clumps(CrowdScene& s, std::size_t count) {
  SceneRandom random;
  s.kinds[0].neighbour_distance = 40.0;
  const std::size_t each = 600;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i % each;
    const Vec2 centre = {500.0 * static_cast<double>(i / each), 3.0 * static_cast<double>(i / each)};
    const Vec2 at = centre + Vec2{1.05 * static_cast<double>(k % 25) + 0.04 * random(),
                                  1.05 * static_cast<double>(k / 25) + 0.04 * random()};
    s.robots.push_back({at, {at.x + 400.0 * (random() - 0.5), 0.0}});
  }
}

}  // namespace scenes

/// "crowd", "dense", "ring", "streams", "groups", "blocks", "pillars", "bodies", "mixture", "jam", "clumps", "wheels".
inline CrowdScene crowd_scene(const std::string& kind, std::size_t count) {
  using Make = void (*)(CrowdScene&, std::size_t);
  static const std::vector<std::pair<std::string, Make>> kScenes = {
      {"crowd", scenes::crowd},     {"dense", scenes::dense},     {"ring", scenes::ring},
      {"streams", scenes::streams}, {"groups", scenes::groups},   {"blocks", scenes::blocks},
      {"pillars", scenes::pillars}, {"mixture", scenes::mixture}, {"jam", scenes::jam},
      {"clumps", scenes::clumps},   {"bodies", scenes::bodies},   {"wheels", scenes::wheels}};
  CrowdScene s;
  s.kinds.emplace_back();
  for (const auto& [name, make] : kScenes) {
    if (name != kind) continue;
    make(s, count);
    return s;
  }
  throw std::invalid_argument("no such scene: " + kind);
}

/// A crowd of the scene, which must live as long: its steering asks it.
inline Crowd crowd_of(const CrowdScene& scene) {
  Crowd crowd(scene.options);
  for (const CrowdKind& kind : scene.kinds) crowd.add_kind(kind);
  for (const geometry::Obstacle& obstacle : scene.obstacles) crowd.add_obstacle(obstacle);
  for (const CrowdScene::Body& body : scene.bodies)
    body.moves ? crowd.add_moving_body(body.shape, body.velocity) : crowd.add_body(body.shape);
  crowd.reserve(scene.robots.size());
  for (const CrowdScene::Robot& robot : scene.robots) crowd.add_robot(robot.at, robot.kind);
  crowd.set_steering([&scene](CrowdSlice& slice) {
    for (std::size_t k = 0; k < slice.size(); ++k) slice.prefer(k, scene.preferred(slice.id(k), slice.position(k)));
  });
  return crowd;
}

}  // namespace exactvo::formation
