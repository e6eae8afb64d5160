// SPDX-License-Identifier: GPL-3.0-or-later
// Theorem 1 does not hold: math of docs/guide/formation.md.
#include <array>

#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/patterns.h"

namespace exactvo::formation {
namespace {

constexpr std::size_t kRobots = 3;
constexpr double kStep = 0.01;  // s

using Line = std::array<double, kRobots>;  // along the push

Scenario three_robots() {
  Scenario s;
  s.name = "theorem-one";
  s.time_step = kStep;
  s.robots.resize(kRobots);
  s.formation.emplace();
  s.formation->topology = complete_topology(kRobots);
  s.formation->offsets.assign(kRobots, {});
  s.formation->leader = {{{0.0, 0.0}}, 0.0};
  return s;
}

double asked(std::size_t i, double push) {
  return i == 0 ? push : 0.0;
}

Step row_of(double time, const Line& x, const Line& v, double push) {
  Step row;
  row.time = time;
  for (std::size_t i = 0; i < kRobots; ++i) {
    RobotStep robot;
    robot.position = {x[i], 0.0};
    robot.velocity = {v[i], 0.0};
    robot.chosen = {asked(i, push), 0.0};
    row.robots.push_back(robot);
  }
  return row;
}

/// u of (15), signs corrected.
double input(const Gains& g, std::size_t i, const Line& x, const Line& v, double push) {
  double position = x[i], velocity = v[i];
  for (std::size_t j = 0; j < kRobots; ++j) {
    position += x[i] - x[j];
    velocity += v[i] - v[j];
  }
  return -g.k1 * position - g.k2 * velocity - g.k3 * (v[i] - asked(i, push));
}

void advance(const Gains& g, double push, Line& x, Line& v) {
  Line u{};
  for (std::size_t i = 0; i < kRobots; ++i) u[i] = input(g, i, x, v, push);
  for (std::size_t i = 0; i < kRobots; ++i) {
    v[i] += kStep * u[i];
    x[i] += kStep * v[i];
  }
}

}  // namespace

Counterexample theorem_one_counterexample(double push, double duration) {
  Counterexample c{three_robots(), {}};
  c.recording.time_step = kStep;
  c.recording.offsets = c.scenario.formation->offsets;
  Line x{}, v{};
  for (int k = 0; k * kStep <= duration; ++k) {
    c.recording.steps.push_back(row_of(k * kStep, x, v, push));
    advance(c.scenario.formation->gains, push, x, v);
  }
  return c;
}

}  // namespace exactvo::formation
