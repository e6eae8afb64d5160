// SPDX-License-Identifier: GPL-3.0-or-later
// Theorem 1 does not hold: math of docs/guide/formation.md.
#include "control/consensus.h"
#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/patterns.h"

namespace exactvo::formation {
namespace {

using detail::RelativeState;

constexpr std::size_t kRobots = 3;
constexpr double kStep = 0.01;  // s

Scenario three_robots() {
  Scenario s;
  s.name = "theorem-one";
  s.time_step = kStep;
  s.robots.resize(kRobots);
  s.formation.emplace();
  s.formation->topology = complete_topology(kRobots);
  s.formation->offsets.assign(kRobots, {});
  s.formation->leader = {{{{0.0, 0.0}}, 0.0}};
  return s;
}

Vec2 asked(std::size_t i, double push) {
  return {i == 0 ? push : 0.0, 0.0};
}

Step row_of(double time, const RelativeState& s, double push) {
  Step row;
  row.time = time;
  for (std::size_t i = 0; i < kRobots; ++i) {
    RobotStep& robot = row.robots.emplace_back();
    robot.position = s.position[i];
    robot.velocity = s.velocity[i];
    robot.chosen = asked(i, push);
  }
  return row;
}

void advance(const FormationSpec& f, double push, RelativeState& s) {
  std::vector<Vec2> u;  // of (15), signs corrected
  for (std::size_t i = 0; i < kRobots; ++i)
    u.push_back(detail::consensus_input(f, s, i, -1.0) - f.gains.k3 * (s.velocity[i] - asked(i, push)));
  for (std::size_t i = 0; i < kRobots; ++i) {
    s.velocity[i] += kStep * u[i];
    s.position[i] += kStep * s.velocity[i];
  }
}

}  // namespace

Counterexample theorem_one_counterexample(double push, double duration) {
  Counterexample c{three_robots(), {}};
  c.recording.time_step = kStep;
  c.recording.offsets = c.scenario.formation->offsets;
  RelativeState state{std::vector<Vec2>(kRobots), std::vector<Vec2>(kRobots)};
  for (int k = 0; k * kStep <= duration; ++k) {
    c.recording.steps.push_back(row_of(k * kStep, state, push));
    advance(*c.scenario.formation, push, state);
  }
  return c;
}

}  // namespace exactvo::formation
