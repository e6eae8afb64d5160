// SPDX-License-Identifier: GPL-3.0-or-later
// The counterexample to Theorem 1 (docs/guide/formation.md): equations (14) and (15) with their signs mended, three
// robots on their slots, and an avoidance that asks robot 1 for a constant 0.1 m/s relative to the leader. The paper's
// function (18) only falls, as (20) says, and below zero, where no Lyapunov function goes; meanwhile the formation
// settles 7.5 m from where it belongs.
#include <cstdio>

#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/patterns.h"

using namespace exactvo;

namespace {

constexpr double kPush = 0.1;   // m/s
constexpr double kStep = 0.01;  // s
constexpr int kSteps = 120000;  // eight times the slowest mode's 150 s

formation::Scenario three_robots() {
  formation::Scenario s;
  s.robots.resize(3);
  s.formation.emplace();
  s.formation->topology = formation::complete_topology(3);
  s.formation->offsets.assign(3, {});
  s.formation->leader = {{{0.0, 0.0}}, 0.0};
  return s;
}

formation::Step row_of(double time, const double (&x)[3], const double (&v)[3]) {
  formation::Step row;
  row.time = time;
  for (int i = 0; i < 3; ++i) {
    formation::RobotStep robot;
    robot.position = {x[i], 0.0};
    robot.velocity = {v[i], 0.0};
    robot.chosen = {i == 0 ? kPush : 0.0, 0.0};
    row.robots.push_back(robot);
  }
  return row;
}

void advance(const formation::Gains& g, double (&x)[3], double (&v)[3]) {
  double u[3];
  for (int i = 0; i < 3; ++i) {
    double position = x[i], velocity = v[i];
    for (int j = 0; j < 3; ++j) {
      position += x[i] - x[j];
      velocity += v[i] - v[j];
    }
    u[i] = -g.k1 * position - g.k2 * velocity - g.k3 * (v[i] - (i == 0 ? kPush : 0.0));
  }
  for (int i = 0; i < 3; ++i) {
    v[i] += kStep * u[i];
    x[i] += kStep * v[i];
  }
}

}  // namespace

int main() {
  const formation::Scenario s = three_robots();
  formation::Recording recording;
  recording.time_step = kStep;
  recording.offsets = s.formation->offsets;
  double x[3] = {}, v[3] = {};
  for (int k = 0; k <= kSteps; ++k) {
    recording.steps.push_back(row_of(k * kStep, x, v));
    advance(s.formation->gains, x, v);
  }
  const auto rows = formation::lyapunov_along(s, recording);
  std::printf("%8s %10s %10s\n", "t [s]", "V of (18)", "x of R1 [m]");
  for (std::size_t k = 0; k < rows.size(); k += 20000)
    std::printf("%8.0f %10.4f %10.3f\n", rows[k].time, rows[k].paper.value(), recording.steps[k].robots[0].position.x);
  const bool falls = rows.back().paper.value() < -0.2;
  const bool lost = recording.steps.back().robots[0].position.x > 7.0;
  return falls && lost ? 0 : 1;
}
