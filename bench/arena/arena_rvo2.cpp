// SPDX-License-Identifier: GPL-3.0-or-later
// A peer of the arena (peer.h) that drives through the interface of RVO2 (van den Berg, Guy, Snape, Lin, Manocha).
// The build makes it on our own certified crowd, which has that interface. With RVO2 itself:
//
//   c++ -O2 -I RVO2/src bench/arena/arena_rvo2.cpp -o arena_rvo2_original -L RVO2/build/src -lRVO
//
// As in RVO2's examples: neighbours 15 m away at most, ten of them, a time horizon of 5 s (10 s in Circle), and
// preferred velocities perturbed by up to 1e-4 m/s against perfect symmetry. Robots are larger by half the margin, and
// head for the farthest point of their way that they see.
#include <RVO.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using RVO::Vector2;

struct Point {
  double x = 0.0, y = 0.0;
};

struct Traveller {
  float radius = 0.0F, max_speed = 0.0F;
  Point start;
  std::vector<Point> goals;
  std::vector<std::vector<Point>> ways;  ///< to each goal, the goal last
  std::size_t goal = 0, point = 0;       ///< where it heads: a point of the way to that goal
};

struct Scene {
  float time_step = 0.0F;
  double time_limit = 0.0, arrival_tolerance = 0.0;
  float neighbour_distance = 0.0F, margin = 0.0F;
  std::vector<Traveller> travellers;
  std::vector<std::pair<Point, Point>> walls;
};

Vector2 vector_of(const Point& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y)};
}

std::vector<Point> read_points(std::istream& in) {
  std::size_t count = 0;
  in >> count;
  std::vector<Point> points(count);
  for (Point& p : points) in >> p.x >> p.y;
  return points;
}

void read_item(const std::string& word, std::istream& in, Scene& scene) {
  if (word == "time_step") {
    in >> scene.time_step;
  } else if (word == "time_limit") {
    in >> scene.time_limit;
  } else if (word == "arrival_tolerance") {
    in >> scene.arrival_tolerance;
  } else if (word == "neighbour_distance") {
    in >> scene.neighbour_distance;
  } else if (word == "margin") {
    in >> scene.margin;
  } else if (word == "robot") {
    Traveller t;
    in >> t.radius >> t.max_speed >> t.start.x >> t.start.y;
    t.goals = read_points(in);
    for (const Point& goal : t.goals) t.ways.push_back({goal});
    scene.travellers.push_back(t);
  } else if (word == "way") {
    std::size_t robot = 0, goal = 0;
    in >> robot >> goal;
    scene.travellers.at(robot).ways.at(goal) = read_points(in);
  } else if (word == "wall") {
    Point a, b;
    in >> a.x >> a.y >> b.x >> b.y;
    scene.walls.emplace_back(a, b);
  } else {
    throw std::runtime_error("found the word '" + word + "'");
  }
}

Scene read_scene() {
  Scene scene;
  std::string line;
  if (!std::getline(std::cin, line) || line != "arena 1") throw std::runtime_error("expected a scene, 'arena 1' first");
  while (std::getline(std::cin, line) && line != "end") {
    std::istringstream in(line);
    std::string word;
    in >> word;
    read_item(word, in, scene);
    if (in.fail()) throw std::runtime_error("found the line '" + line + "'");
  }
  return scene;
}

double distance(const Vector2& a, const Point& b) {
  return std::hypot(static_cast<double>(a.x()) - b.x, static_cast<double>(a.y()) - b.y);
}

/// Whether it is at its last goal; else where it heads for is up to date.
bool has_arrived(Traveller& t, const Vector2& here, const RVO::RVOSimulator& simulator, double tolerance) {
  const bool is_last = t.goal + 1 == t.goals.size();
  const double near = is_last ? tolerance : std::max(tolerance, static_cast<double>(t.radius));
  if (distance(here, t.goals[t.goal]) <= near) {
    if (is_last) return true;
    ++t.goal;
    t.point = 0;
  }
  const std::vector<Point>& way = t.ways[t.goal];
  const float slim = 0.999F * t.radius;  // ways touch the corners that they go round
  for (std::size_t k = way.size() - 1; k > t.point; --k)
    if (simulator.queryVisibility(here, vector_of(way[k]), slim)) t.point = k;
  return false;
}

/// The same numbers everywhere (SplitMix64).
double next_fraction(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

void print(const RVO::RVOSimulator& simulator, const Scene& scene, bool at_start) {
  for (std::size_t i = 0; i < scene.travellers.size(); ++i) {
    const Vector2 p = simulator.getAgentPosition(i);
    const Point& start = scene.travellers[i].start;
    std::printf("%s%.17g %.17g", i == 0 ? "" : " ", at_start ? start.x : static_cast<double>(p.x()),
                at_start ? start.y : static_cast<double>(p.y()));
  }
  std::printf("\n");
}

void run(Scene scene) {
  constexpr std::size_t kNeighbours = 10;
  constexpr float kHorizon = 5.0F, kPerturbed = 1e-4F;
  RVO::RVOSimulator simulator;
  simulator.setTimeStep(scene.time_step);
  for (const Traveller& t : scene.travellers)
    simulator.addAgent(vector_of(t.start), scene.neighbour_distance, kNeighbours, kHorizon, kHorizon,
                       t.radius + 0.5F * scene.margin, t.max_speed);
  for (const auto& [a, b] : scene.walls) simulator.addObstacle({vector_of(a), vector_of(b)});
  simulator.processObstacles();
  std::uint64_t random = 1;
  const double step = static_cast<double>(scene.time_step);
  const auto steps = static_cast<std::size_t>(std::ceil(scene.time_limit / step - 1e-6));
  print(simulator, scene, true);
  for (std::size_t k = 0; k < steps; ++k) {
    bool all_arrived = true;
    for (std::size_t i = 0; i < scene.travellers.size(); ++i) {
      Traveller& t = scene.travellers[i];
      const Vector2 here = simulator.getAgentPosition(i);
      if (has_arrived(t, here, simulator, scene.arrival_tolerance)) {
        simulator.setAgentPrefVelocity(i, Vector2(0.0F, 0.0F));
        continue;
      }
      all_arrived = false;
      Vector2 way = vector_of(t.ways[t.goal][t.point]) - here;
      const float length = RVO::abs(way), fastest = t.max_speed * scene.time_step;
      way = length > fastest ? way * (t.max_speed / length) : way / scene.time_step;
      const auto angle = static_cast<float>(6.283185307179586 * next_fraction(random));
      const float size = kPerturbed * static_cast<float>(next_fraction(random));
      simulator.setAgentPrefVelocity(i, way + Vector2(std::cos(angle), std::sin(angle)) * size);
    }
    if (all_arrived) break;
    simulator.doStep();
    print(simulator, scene, false);
  }
}

}  // namespace

int main() {
  try {
    run(read_scene());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "arena_rvo2: error: %s\n", error.what());
    return 2;
  }
  return 0;
}
