// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// simulate --engine crowd: a scenario on the certified crowd (formation/crowd_run.h), recorded as .evr.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "exactvo/formation/ranks.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "verb.h"

namespace exactvo::tools {

struct CrowdFlags {
  std::string engine = "standard";
  std::string record;
  std::uint32_t every = 1;
  std::size_t snapshot_every = 0;
  bool resume = false;
  int threads = 1;
  std::string precision = "float";
  CLI::Option* method = nullptr;                    ///< of the verb
  std::vector<CLI::Option*> of_crowd, of_standard;  ///< options that the other engine does not have
};

/// Whether `--record` means stdout: "-", or another name of it. Results go to stderr then.
bool is_stdout(const std::string& path);

/// After `declare_simulation_flags`.
void declare_crowd_flags(CLI::App& app, CrowdFlags& flags);

/// Throws UsageError where options of one engine are given for the other. `out`: of --out.
bool wants_crowd(const CrowdFlags& flags, const SimulationFlags& simulation, const std::string& out);

/// `ranks`: who runs it together with this process, or null. Only the first prints and writes.
ExitCode simulate_crowd(const CrowdFlags& flags, const SimulationFlags& simulation, const std::string& file,
                        const datasets::LoadedScenario& read, bool json, formation::Ranks* ranks);

}  // namespace exactvo::tools
