// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What was run, in words: the head of every result file.

#include <optional>
#include <string>

#include "exactvo/datasets/provenance.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::datasets {

/// What was run, in words.
struct RunInfo {
  std::string scenario;                                ///< its name
  std::string method;                                  ///< "ivo" and so on
  std::optional<std::string> controller;               ///< none without a formation
  std::optional<std::string> integrator;               ///< none without a formation
  Provenance provenance;                               ///< program, libraries, inputs
  std::optional<std::string> guidance = std::nullopt;  ///< "route"; none where robots go without
  std::optional<std::string> liveness = std::nullopt;  ///< "bias"; none where nothing is done against waiting
  std::string decisions = "binding";  ///< what is recorded of half-planes: "none", "binding" ones, or "all"
};

/// The info of a run of `scenario`: the parts of `options` that it depends on. A run without recorded decisions is one
/// on a crowd, whatever the method of `options`.
RunInfo run_info(const formation::Scenario& scenario, formation::SimulationOptions options, Provenance provenance,
                 bool has_decisions = true);

}  // namespace exactvo::datasets
