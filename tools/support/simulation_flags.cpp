// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/simulation_flags.h"

#include <fmt/format.h>

#include <vector>

#include "support/usage.h"

namespace exactvo::tools {

namespace {

std::string help(const char* what, const std::vector<std::string>& names) {
  return fmt::format("{}: {}", what, fmt::join(names, ", "));
}

}  // namespace

void declare_simulation_flags(CLI::App& app, SimulationFlags& flags) {
  app.add_option("--method,-m", flags.method, help("How robots avoid", formation::method_names()))
      ->capture_default_str();
  app.add_option("--controller,-c", flags.controller, help("Of a formation", formation::controller_names()))
      ->capture_default_str();
  app.add_option("--integrator", flags.integrator, help("Of a formation", formation::integrator_names()))
      ->capture_default_str();
  app.add_option("--seed", flags.seed, "Noted in the provenance; a run draws no random numbers")->capture_default_str();
}

formation::SimulationOptions simulation_options(const SimulationFlags& flags) {
  formation::SimulationOptions options;
  options.method = parse_choice<formation::Method>("--method", flags.method, formation::method_names());
  options.controller =
      parse_choice<formation::Controller>("--controller", flags.controller, formation::controller_names());
  options.integrator =
      parse_choice<formation::Integrator>("--integrator", flags.integrator, formation::integrator_names());
  return options;
}

}  // namespace exactvo::tools
