// SPDX-License-Identifier: GPL-3.0-or-later
// The counterexample to Theorem 1 (docs/guide/formation.md): equations (14) and (15) with their signs corrected, three
// robots on their slots, and an avoidance that asks robot 1 for a constant 0.1 m/s relative to the leader. The paper's
// function (18) only falls, as (20) says, and below zero, where no Lyapunov function goes; meanwhile the formation
// settles 7.5 m from where it belongs.
#include <cstdio>

#include "exactvo/formation/lyapunov.h"

using namespace exactvo;

int main() {
  const formation::Counterexample c = formation::theorem_one_counterexample();
  const auto rows = formation::lyapunov_along(c.scenario, c.recording);
  std::printf("%8s %10s %10s\n", "t [s]", "V of (18)", "x of R1 [m]");
  for (std::size_t k = 0; k < rows.size(); k += 20000)
    std::printf("%8.0f %10.4f %10.3f\n", rows[k].time, rows[k].paper.value(),
                c.recording.steps[k].robots[0].position.x);
  const bool falls = rows.back().paper.value() < -0.2;
  const bool lost = c.recording.steps.back().robots[0].position.x > 7.0;
  return falls && lost ? 0 : 1;
}
