// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The options that choose how a scenario is run, the same for every verb that runs one.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "exactvo/formation/simulation.h"

namespace exactvo::tools {

struct SimulationFlags {
  std::string method = "ivo";
  std::string guidance;  ///< empty: as the scenario says
  std::string liveness;  ///< the same
  std::string controller = "default";
  std::string integrator = "exact";
  std::string ablation;               ///< a set by its name, instead of the controller's
  std::vector<std::string> switches;  ///< "smoothing=on"
  std::uint64_t seed = 0;
  const CLI::Option* method_option = nullptr;
  std::vector<const CLI::Option*> of_runs;        ///< all
  std::vector<const CLI::Option*> of_goals;       ///< --guidance, --liveness
  std::vector<const CLI::Option*> of_formations;  ///< --controller, --integrator, --ablation, --controller-option
};

/// Declares --out: neither empty nor with control characters.
CLI::Option* declare_out(CLI::App& app, std::string& out, const std::string& help);

/// Declares --seed: a whole number below 2^64.
CLI::Option* declare_seed(CLI::App& app, std::uint64_t& seed,
                          const std::string& help = "Noted in the provenance; a run draws no random numbers");

/// A message for each option given that the scenario does not use.
void note_unused(const SimulationFlags& flags, const formation::Scenario& scenario);
/// A message where joint plans are meant, by an option or the scenario, and not made (formation::liveness_of).
void note_liveness(const SimulationFlags& flags, const formation::Scenario& scenario,
                   const formation::SimulationOptions& options);
/// A message for each option given where the run is a recorded one.
void note_recorded(const SimulationFlags& flags);

/// Declares --method, --controller, --integrator, --ablation, --controller-option and --seed. `flags` must outlive the
/// parsing.
void declare_simulation_flags(CLI::App& app, SimulationFlags& flags);

/// Throws UsageError for a word that names nothing.
formation::SimulationOptions simulation_options(const SimulationFlags& flags);

// --- How a run is made. Either each decision is recorded with its half-planes, with any method and joint plans, for
// some hundred robots (formation/simulation.h); or places alone are recorded, with method orca and reserved places, for
// any number of robots (formation/crowd_run.h). The user asks for one with --decisions; else the scenario decides ---

/// From this many robots on places alone are recorded: a dense scene of 200 takes 75 times as long with decisions, and
/// below that either takes seconds.
inline constexpr std::size_t kManyRobots = 200;

struct DecisionFlags {
  std::string recorded;  ///< "none", "binding", "all"; empty: as the scenario says
};

/// Declares --decisions. `flags` must outlive the parsing.
void declare_decisions(CLI::App& app, DecisionFlags& flags);

/// One of the two ways.
struct Way {
  bool is_crowd = false;     ///< places alone are recorded
  bool records_all = false;  ///< every half-plane is
  std::string words;         ///< a line for the user, who may want the other way; empty where there is nothing to say
};

/// The way of a scenario. `needed`: an option that was given and needs recorded decisions, "--record -" for instance;
/// else empty. `has_ranks`: several processes share the run, which is only done without decisions. Throws UsageError
/// where options exclude each other, and DataError (E_SCENARIO) where --decisions none, or ranks, ask for what the
/// scenario does not allow.
Way way_of(const DecisionFlags& flags, const SimulationFlags& simulation, const std::string& file,
           const formation::Scenario& scenario, const std::string& needed, bool has_ranks);

}  // namespace exactvo::tools
