// SPDX-License-Identifier: GPL-3.0-or-later
#include "circle.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/reciprocal.h"

namespace exactvo::bench {
namespace {

using lp::Vec2;

constexpr int kRobots = 250;
constexpr double kCircle = 200.0;  // m
constexpr double kRadius = 1.5;    // m
constexpr double kSpeed = 2.0;     // m/s
constexpr double kHorizon = 10.0;  // s
constexpr double kStep = 0.25;     // s
constexpr int kMostSteps = 3000;   // the usual implementation arrives after some 1000
constexpr double kArrived = kRadius;

double neighbour_distance(int m) {
  for (const auto& [lines, distance] : {std::pair{5, 15.0}, {10, 15.0}, {20, 22.0}, {50, 34.0}, {100, 48.0}})
    if (lines == m) return distance;
  EXACTVO_REQUIRE(false, "C" + std::to_string(m));
  return 0.0;
}

struct Robot {
  Vec2 position, velocity, goal;
};

std::vector<Robot> on_a_circle() {
  std::vector<Robot> robots(kRobots);
  for (int k = 0; k < kRobots; ++k) {
    const double angle = 6.283185307179586 * k / kRobots;
    robots[k].position = {kCircle * std::cos(angle), kCircle * std::sin(angle)};
    robots[k].goal = -robots[k].position;
  }
  return robots;
}

Vec2 preferred(const Robot& robot) {
  const Vec2 way = robot.goal - robot.position;
  const double distance = norm(way);
  return distance > kSpeed ? (kSpeed / distance) * way : way;
}

std::vector<int> neighbours(const std::vector<Robot>& robots, int self, int most, double within) {
  std::vector<std::pair<double, int>> near;
  for (int k = 0; k < kRobots; ++k) {
    const double squared = squared_norm(robots[k].position - robots[self].position);
    if (k != self && squared < within * within) near.emplace_back(squared, k);
  }
  std::sort(near.begin(), near.end());
  std::vector<int> indices;
  for (std::size_t k = 0; k < near.size() && indices.size() < static_cast<std::size_t>(most); ++k)
    indices.push_back(near[k].second);
  return indices;
}

lp::Problem decision(const std::vector<Robot>& robots, int self, int most, double within) {
  lp::Problem problem;
  problem.bound.disc = kSpeed;
  problem.preferred = preferred(robots[self]);
  vo::ReciprocalOptions options;
  options.time_horizon = kHorizon;
  options.contact_time = kStep;
  const auto disc = [&](int k) { return vo::MovingDisc{robots[k].position, robots[k].velocity, kRadius}; };
  for (const int other : neighbours(robots, self, most, within)) {
    const auto pair = vo::reciprocal_half_planes(disc(self), disc(other), options);
    problem.constraints.push_back({pair.a, lp::Priority::soft, other});
  }
  return problem;
}

bool all_arrived(const std::vector<Robot>& robots) {
  return std::all_of(robots.begin(), robots.end(), [](const Robot& r) { return norm(r.goal - r.position) < kArrived; });
}

std::vector<lp::Problem> thinned(std::vector<lp::Problem> all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<lp::Problem> kept;
  for (std::size_t k = 0; k < most; ++k) kept.push_back(std::move(all[k * all.size() / most]));
  return kept;
}

}  // namespace

std::vector<lp::Problem> record_circle(int m, std::size_t most) {
  const double within = neighbour_distance(m);
  std::vector<Robot> robots = on_a_circle();
  std::vector<lp::Problem> recorded;
  for (int step = 0; step < kMostSteps && !all_arrived(robots); ++step) {
    std::vector<Vec2> next(kRobots);
    for (int k = 0; k < kRobots; ++k) {
      lp::Problem problem = decision(robots, k, m, within);
      next[k] = lp::solve(problem).velocity;
      if (static_cast<int>(problem.constraints.size()) == m) recorded.push_back(std::move(problem));
    }
    for (int k = 0; k < kRobots; ++k) {
      robots[k].velocity = next[k];
      robots[k].position += kStep * next[k];
    }
  }
  return thinned(std::move(recorded), most);
}

}  // namespace exactvo::bench
