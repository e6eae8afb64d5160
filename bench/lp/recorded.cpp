// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/orca_obstacle.h"
#include "exactvo/vo/reciprocal.h"

namespace exactvo::bench {
namespace {

using lp::Vec2;

constexpr double kRadius = 1.5;    // m
constexpr double kSpeed = 2.0;     // m/s
constexpr double kHorizon = 10.0;  // s
constexpr double kStep = 0.25;     // s
constexpr double kArrived = kRadius;
constexpr int kMostSteps = 3000;  // the textbook implementation arrives after some 1000
/// Robots that block each other before a wall for good would only repeat one decision.
constexpr int kMostStepsBetweenBlocks = 2000;

constexpr double kWallHorizon = 5.0;                               // s
constexpr double kWallDistance = kWallHorizon * kSpeed + kRadius;  // m: farther walls cannot bind
/// Robots in the middle between two blocks would meet head on for ever: each wish turns by up to this much.
constexpr double kUnrest = 0.05;  // rad

struct Robot {
  Vec2 position, velocity, goal;
};

struct Scenario {
  std::vector<Robot> robots;
  std::vector<vo::OrcaChain> walls;
  int most_steps = 0;
};

Scenario circle() {
  constexpr int kRobots = 250;
  constexpr double kCircle = 200.0;  // m
  Scenario scenario{std::vector<Robot>(kRobots), {}, kMostSteps};
  for (int k = 0; k < kRobots; ++k) {
    const double angle = 6.283185307179586 * k / kRobots;
    scenario.robots[k].position = {kCircle * std::cos(angle), kCircle * std::sin(angle)};
    scenario.robots[k].goal = -scenario.robots[k].position;
  }
  return scenario;
}

vo::OrcaChain block(double x, double y) {
  constexpr double kSide = 30.0;  // m
  return vo::orca_chains(geometry::Polygon{{{x, y}, {x + kSide, y}, {x + kSide, y + kSide}, {x, y + kSide}}, {}})
      .front();
}

Scenario blocks() {
  Scenario scenario;
  scenario.most_steps = kMostStepsBetweenBlocks;
  for (const double x : {-40.0, 10.0})
    for (const double y : {-40.0, 10.0}) scenario.walls.push_back(block(x, y));
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0})
      for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
          scenario.robots.push_back({{sx * (55.0 + 10.0 * i), sy * (55.0 + 10.0 * j)}, {}, {-sx * 75.0, -sy * 75.0}});
  return scenario;
}

double neighbour_distance(int m) {
  for (const auto& [lines, distance] : {std::pair{5, 15.0}, {10, 15.0}, {20, 22.0}, {50, 34.0}, {100, 48.0}})
    if (lines == m) return distance;
  return 0.0;
}

/// In [-1, 1], from robot and step alone (the finaliser of SplitMix64).
double noise_of(std::uint64_t robot, std::uint64_t step) {
  std::uint64_t z = (robot << 32 | step) + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

Vec2 preferred(const Scenario& scenario, int self, int step) {
  const Robot& robot = scenario.robots[self];
  const Vec2 way = robot.goal - robot.position;
  const double distance = norm(way);
  const Vec2 wish = distance > kSpeed ? (kSpeed / distance) * way : way;
  if (scenario.walls.empty()) return wish;
  const double turn = kUnrest * noise_of(static_cast<std::uint64_t>(self), static_cast<std::uint64_t>(step));
  return wish + turn * perp(wish);
}

std::vector<int> neighbours(const std::vector<Robot>& robots, int self, double within) {
  std::vector<std::pair<double, int>> near;
  for (int k = 0; k < static_cast<int>(robots.size()); ++k) {
    const double squared = squared_norm(robots[k].position - robots[self].position);
    if (k != self && squared < within * within) near.emplace_back(squared, k);
  }
  std::sort(near.begin(), near.end());
  std::vector<int> indices;
  for (const auto& [squared, k] : near) indices.push_back(k);
  return indices;
}

double distance_to_box_of(const vo::OrcaChain& chain, Vec2 p) {
  const Vec2 low = chain.vertices[0], high = chain.vertices[2];
  const double x = std::max({low.x - p.x, p.x - high.x, 0.0}), y = std::max({low.y - p.y, p.y - high.y, 0.0});
  return std::hypot(x, y);
}

void add_walls(const Scenario& scenario, int self, lp::Problem& problem) {
  const Robot& robot = scenario.robots[self];
  for (const vo::OrcaChain& wall : scenario.walls) {
    if (distance_to_box_of(wall, robot.position) > kWallDistance) continue;
    std::vector<std::size_t> edges(wall.vertices.size());
    std::iota(edges.begin(), edges.end(), std::size_t{0});
    for (const auto& h : vo::orca_half_planes(wall, edges, robot.position, robot.velocity, kRadius, kWallHorizon))
      problem.constraints.push_back({h.half_plane, lp::Priority::hard, -1});
  }
}

lp::Problem decision(const Scenario& scenario, int self, int step, int m) {
  const std::vector<Robot>& robots = scenario.robots;
  lp::Problem problem;
  problem.bound.disc = kSpeed;
  problem.preferred = preferred(scenario, self, step);
  add_walls(scenario, self, problem);
  vo::ReciprocalOptions options;
  options.time_horizon = kHorizon;
  options.contact_time = kStep;
  const auto disc = [&](int k) { return vo::MovingDisc{robots[k].position, robots[k].velocity, kRadius}; };
  for (const int other : neighbours(robots, self, neighbour_distance(m))) {
    if (problem.constraints.size() >= static_cast<std::size_t>(m)) break;
    const auto pair = vo::reciprocal_half_planes(disc(self), disc(other), options);
    problem.constraints.push_back({pair.a, lp::Priority::soft, other});
  }
  return problem;
}

bool all_arrived(const std::vector<Robot>& robots) {
  return std::all_of(robots.begin(), robots.end(), [](const Robot& r) { return norm(r.goal - r.position) < kArrived; });
}

int lines_of(const std::string& name) {
  if (name.size() < 2 || (name[0] != 'C' && name[0] != 'B')) return 0;
  int m = 0;
  for (const char digit : name.substr(1)) {
    if (digit < '0' || digit > '9' || m > 100) return 0;
    m = 10 * m + (digit - '0');
  }
  return neighbour_distance(m) > 0.0 ? m : 0;
}

}  // namespace

bool is_recorded_set(const std::string& name) {
  return lines_of(name) > 0;
}

std::vector<lp::Problem> record(const std::string& name, std::size_t most) {
  EXACTVO_REQUIRE(is_recorded_set(name), name);
  const int m = lines_of(name);
  Scenario scenario = name[0] == 'C' ? circle() : blocks();
  std::vector<lp::Problem> all;
  const int robots = static_cast<int>(scenario.robots.size());
  for (int step = 0; step < scenario.most_steps && !all_arrived(scenario.robots); ++step) {
    std::vector<Vec2> next(scenario.robots.size());
    for (int k = 0; k < robots; ++k) {
      lp::Problem problem = decision(scenario, k, step, m);
      next[k] = lp::solve(problem).velocity;
      if (static_cast<int>(problem.constraints.size()) == m) all.push_back(std::move(problem));
    }
    for (int k = 0; k < robots; ++k) {
      scenario.robots[k].velocity = next[k];
      scenario.robots[k].position += kStep * next[k];
    }
  }
  const std::size_t count = std::min(most, all.size());
  std::vector<lp::Problem> kept;
  for (std::size_t k = 0; k < count; ++k) kept.push_back(std::move(all[k * all.size() / count]));
  return kept;
}

}  // namespace exactvo::bench
