// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How a run is made. Either each decision is recorded with its half-planes, with any method and joint plans, for some
/// hundred robots (formation/simulation.h); or places alone are recorded, with method orca and reserved places, for any
/// number of robots (formation/crowd_run.h). The user asks for one with --decisions; else the scenario decides.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

#include "exactvo/formation/scenario.h"
#include "support/simulation_flags.h"

namespace exactvo::tools {

/// From so many robots on places alone are recorded: a dense scene of 200 takes 75 times as long with decisions, and
/// below that either takes seconds.
inline constexpr std::size_t kManyRobots = 200;

/// What --decisions says.
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
