// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/simulation_flags.h"

#include <fmt/format.h>

#include <vector>

#include "support/escape.h"
#include "support/terminal.h"
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
  flags.of_formations = {
      app.add_option("--controller,-c", flags.controller, help("Of a formation", formation::controller_names()))
          ->capture_default_str(),
      app.add_option("--integrator", flags.integrator, help("Of a formation", formation::integrator_names()))
          ->capture_default_str()};
  declare_seed(app, flags.seed);
}

void declare_seed(CLI::App& app, std::uint64_t& seed) {
  // The parser would let -1 pass as 2^64 - 1.
  const auto not_negative = [](const std::string& text) {
    return text.rfind('-', 0) == 0 ? "found '" + text + "', expected a whole number from 0 on" : std::string();
  };
  app.add_option("--seed", seed, "Noted in the provenance; a run draws no random numbers")
      ->capture_default_str()
      ->check(CLI::Validator(not_negative, "", ""));
}

CLI::Option* declare_out(CLI::App& app, std::string& out, const std::string& help) {
  const auto is_name = [](const std::string& text) {
    if (text.empty()) return std::string("found '', expected a name");
    return has_control_characters(text) ? "found '" + shown(text) + "', expected a name without control characters"
                                        : std::string();
  };
  return app.add_option("--out,-o", out, help)->check(CLI::Validator(is_name, "", ""));
}

void note_unused(const SimulationFlags& flags, const formation::Scenario& scenario) {
  if (scenario.formation) return;
  for (const CLI::Option* option : flags.of_formations) {
    if (option->count() > 0) {
      message("note: --" + option->get_lnames().front() + " does nothing here: the scenario has no formation");
    }
  }
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
