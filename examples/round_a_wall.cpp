// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's point in one run: before a wall the usual method stops, the improved one goes round.
#include <cstdio>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"

using namespace exactvo;

namespace {

bool run(const formation::Scenario& scenario, formation::Method method) {
  formation::SimulationOptions options;
  options.method = method;
  const formation::Recording recording = formation::simulate(scenario, options);
  const formation::Metrics metrics = formation::measure(scenario, recording);
  std::printf("%-12s %s; nearest to the wall %.3f m\n", formation::name(method), recording.outcome.c_str(),
              metrics.min_obstacle_clearance.value_or(0.0));
  return metrics.all_arrived;
}

}  // namespace

int main() {
  formation::Scenario scenario;
  scenario.name = "round a wall";
  scenario.robots = {{"R1", {0.0, 0.0}, {0.0, 0.0}, 0.5, 3.0, {{20.0, 0.0}}}};
  scenario.obstacles = {{"wall", geometry::Polyline{{{9.0, -3.0}, {9.0, 3.0}}}}};
  scenario.time_limit = 30.0;
  scenario.guidance = formation::Guidance::none;  // by default a route leads round the wall

  const bool usual_arrives = run(scenario, formation::Method::orca);
  const bool improved_arrives = run(scenario, formation::Method::ivo);
  return !usual_arrives && improved_arrives ? 0 : 1;
}
