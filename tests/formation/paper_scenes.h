// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The scenes of datasets/data/paper and one run of each, for the tests of this room.

#include <string>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::test {

inline formation::Scenario paper_scene(const std::string& name) {
  return datasets::load_scenario(std::string(EXACTVO_SOURCE_DIR) + "/datasets/data/paper/" + name + ".json");
}

struct FinishedRun {
  formation::Recording recording;
  formation::Metrics metrics;
};

inline FinishedRun run(const formation::Scenario& scenario, const formation::SimulationOptions& options) {
  FinishedRun r;
  r.recording = formation::simulate(scenario, options);
  r.metrics = formation::measure(scenario, r.recording);
  return r;
}

inline formation::SimulationOptions with_method(formation::Method method) {
  formation::SimulationOptions options;
  options.method = method;
  return options;
}

inline formation::SimulationOptions with_controller(formation::Controller controller) {
  formation::SimulationOptions options;
  options.controller = controller;
  return options;
}

}  // namespace exactvo::test
