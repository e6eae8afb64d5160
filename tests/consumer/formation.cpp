// SPDX-License-Identifier: GPL-3.0-or-later
#include <exactvo/formation/metrics.h>
#include <exactvo/formation/simulation.h>

#include <iostream>
int main() {
  exactvo::formation::Scenario scenario;
  scenario.name = "one robot, nothing in its way";
  scenario.robots = {{"R1", {0.0, 0.0}, {0.0, 0.0}, 0.5, 3.0, {{2.0, 0.0}}}};
  scenario.time_limit = 30.0;
  const auto recording = exactvo::formation::simulate(scenario, {});
  std::cout << exactvo::formation::measure(scenario, recording).all_arrived << "\n";  // 1
}
