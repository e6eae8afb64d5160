// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The options that choose how a scenario is run, the same for every verb that runs one.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "exactvo/formation/simulation.h"

namespace exactvo::tools {

struct SimulationFlags {
  std::string method = "ivo";
  std::string controller = "default";
  std::string integrator = "exact";
  std::uint64_t seed = 0;
};

/// Declares --method, --controller, --integrator and --seed. `flags` must outlive the parsing.
void declare_simulation_flags(CLI::App& app, SimulationFlags& flags);

/// Throws UsageError for a word that names nothing.
formation::SimulationOptions simulation_options(const SimulationFlags& flags);

}  // namespace exactvo::tools
