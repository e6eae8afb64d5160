// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A decision of a run whose decisions are not recorded: computed again, by running it until then.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/crowd_run.h"
#include "explain/decision.h"

namespace exactvo::tools {

struct CrowdDecision {
  std::optional<Decision> decision;  ///< none where the run ends before
  double end = 0.0;                  ///< s, of the run, then
  std::vector<std::string> remarks;  ///< what half-planes do not say
};

/// The decision of a robot in the step at `time` (s, >= 0), with all half-planes; of the others it has places and
/// velocities. Multipliers are not known. `method`: how the run is made, in words. `options.progress` is replaced.
/// Throws what run_crowd throws, and Interrupted.
CrowdDecision crowd_decision(const formation::Scenario& scenario, formation::SimulationOptions options,
                             const std::string& method, std::size_t robot, double time);

}  // namespace exactvo::tools
