// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenes.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "exactvo/datasets/generators.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "generators/counter_random.h"

namespace exactvo::bench {
namespace {

namespace fs = std::filesystem;
using formation::Scenario;
using formation::SceneObstacle;
using geometry::Vec2;

constexpr double kRadius = 0.2;     // m
constexpr double kSpeed = 1.2;      // m/s
constexpr double kRoom = 0.15;      // m, round a start or goal
constexpr double kFarthest = 12.0;  // m, from a start to its goal
constexpr double kDuration = 15.0;  // s

geometry::Box extent_of(const std::vector<SceneObstacle>& obstacles) {
  geometry::Box extent;
  for (const SceneObstacle& o : obstacles)
    for (const Vec2 p : vertices_of(o.shape)) extent.add(p);
  return extent;
}

/// Draws places until they serve.
class Places {
 public:
  explicit Places(const std::vector<SceneObstacle>& obstacles) : obstacles_(obstacles), extent_(extent_of(obstacles)) {}

  Vec2 start() {
    return drawn([&] {
      const double x = random_.uniform(0.0, 1.0), y = random_.uniform(0.0, 1.0);
      return Vec2{extent_.low.x + x * (extent_.high.x - extent_.low.x),
                  extent_.low.y + y * (extent_.high.y - extent_.low.y)};
    });
  }
  Vec2 goal(Vec2 start) {
    return drawn([&] {
      const double x = random_.uniform(0.0, 1.0), y = random_.uniform(0.0, 1.0);
      return start + kFarthest * Vec2{2.0 * x - 1.0, 2.0 * y - 1.0};
    });
  }

 private:
  template <class Draw>
  Vec2 drawn(const Draw& draw) {
    constexpr int kMostDraws = 100000;
    for (int i = 0; i < kMostDraws; ++i) {
      const Vec2 p = draw();
      if (!is_clear(p)) continue;
      taken_.push_back(p);
      return p;
    }
    throw std::runtime_error("no room for a robot");
  }
  bool is_clear(Vec2 p) const {
    return std::all_of(taken_.begin(), taken_.end(), [&](Vec2 q) { return norm(p - q) > 2.0 * (kRadius + kRoom); }) &&
           std::all_of(obstacles_.begin(), obstacles_.end(),
                       [&](const SceneObstacle& o) { return signed_distance(o.shape, p) > kRadius + kRoom; });
  }

  const std::vector<SceneObstacle>& obstacles_;
  geometry::Box extent_;
  std::vector<Vec2> taken_;
  datasets::CounterRandom random_{0};
};

std::vector<SceneObstacle> generated(const std::string& kind, std::uint64_t count) {
  std::vector<SceneObstacle> all;
  for (std::uint64_t k = 0; k < count; ++k)
    for (SceneObstacle& o : datasets::generated_item(kind, k, 7)) all.push_back(std::move(o));
  return all;
}

fs::path data(const char* name) {
  return fs::path(EXACTVO_SOURCE_DIR) / name;
}

}  // namespace

Scenario crossing(std::string name, std::vector<SceneObstacle> obstacles, std::size_t count) {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.name = std::move(name);
  Places places(obstacles);
  for (std::size_t i = 0; i < count; ++i) {
    formation::Robot r;
    r.id = "R" + std::to_string(i + 1);
    r.position = places.start();
    r.radius = kRadius;
    r.max_speed = kSpeed;
    r.goals = {places.goal(r.position)};
    s.robots.push_back(r);
  }
  s.obstacles = std::move(obstacles);
  s.time_limit = kDuration;
  return s;
}

std::vector<Scenario> generated_scenes() {
  return {crossing("floors", generated("floor", 6), 10), crossing("maze", generated("maze", 4), 10),
          crossing("blocks", generated("block", 4), 10), crossing("polygons", generated("polygon", 100), 20),
          crossing("walls", generated("field-open", 16), 10)};
}

std::vector<Scenario> public_scenes() {
  struct Map {
    const char* name;
    const char* file;
    std::size_t robots;
  };
  constexpr Map kMaps[] = {{"small-house", "ros-map/aws_small_house/map.yaml", 5},
                           {"willow", "ros-map/willow_0.10/willow-2010-02-18-0.10.yaml", 8},
                           {"neukolln", "wkt-osm/neukolln_buildings_m.wkt", 20},
                           {"berlin", "movingai/Berlin_1_256.map", 20},
                           {"barn", "barn-world/world_150.world", 10}};
  std::vector<Scenario> scenes;
  for (const Map& map : kMaps) {
    const fs::path file = data("../shared/data") / map.file;
    if (!fs::exists(file)) continue;
    datasets::ReadOptions options;
    options.repair = true;
    scenes.push_back(crossing(map.name, datasets::read_obstacles(file, options).obstacles, map.robots));
  }
  return scenes;
}

std::vector<Scenario> project_scenes() {
  std::vector<Scenario> scenes;
  for (int k = 1; k <= 15; ++k)
    scenes.push_back(datasets::load_scenario(data("datasets/data/paper") / ("A" + std::to_string(k) + ".json")));
  for (int k = 0; k <= 3; ++k)
    scenes.push_back(datasets::load_scenario(data("datasets/data/paper") / ("B" + std::to_string(k) + ".json")));
  scenes.push_back(datasets::load_scenario(data("datasets/data/office/office.json")));
  scenes.push_back(datasets::load_scenario(data("datasets/data/formation/hundred.json")));
  return scenes;
}

}  // namespace exactvo::bench
