// SPDX-License-Identifier: GPL-3.0-or-later
// Counts random fields: formation_field_campaign KIND METHOD [FIRST [COUNT [SEED]]], KIND of random_fields.h, METHOD of
// simulation.h (formations: a controller, or a set of controller options by its name, "+ saturation" or "no margins").
// A line for each field that is not reached and safe, then the counts.
#include <algorithm>
#include <cstdio>
#include <string>
#include <tuple>

#include "field_verdict.h"
#include "options/program_options.h"
#include "support/usage.h"

namespace {

using namespace exactvo;

/// A set of controller options, by name.
bool parse_controller_options(const std::string& text, formation::SimulationOptions& options) {
  for (const auto& list : {formation::incremental_controller_options(), formation::ablated_controller_options()})
    for (const formation::NamedControllerOptions& n : list)
      if (n.name == text) options.controller_options = n.options;
  return options.controller_options.has_value();
}

struct Fields {
  std::string kind, method;
  std::uint64_t first = 0, count = 1000, seed = datasets::kFieldSeed;
};

int count_fields(const Fields& fields) {
  datasets::FieldKind kind{};
  formation::SimulationOptions options;
  if (!datasets::parse(fields.kind, kind)) throw tools::UsageError("KIND", fields.kind, "a kind of random field");
  if (!parse(fields.method, options.method) && !parse(fields.method, options.controller) &&
      !parse_controller_options(fields.method, options))
    throw tools::UsageError("METHOD", fields.method, "a method, a controller or a set of controller options");
  const auto [first, count, seed] = std::tuple(fields.first, fields.count, fields.seed);
  std::uint64_t good = 0, reached = 0;
  double latest = 0.0, wall = 0.0;
  for (std::uint64_t k = first; k < first + count; ++k) {
    const test::FieldVerdict v = test::judge_field(datasets::random_field(kind, k, seed), options);
    good += v.good();
    reached += v.reached;
    wall += v.wall_time;
    latest = std::max(latest, v.last_arrival);
    if (!v.good()) std::printf("%s\n", v.text().c_str());
  }
  std::printf("%s %s seed %llu fields %llu-%llu: reached and safe %llu, reached %llu of %llu; latest %.2f s; %.1f s\n",
              fields.kind.c_str(), fields.method.c_str(), static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(first), static_cast<unsigned long long>(first + count - 1),
              static_cast<unsigned long long>(good), static_cast<unsigned long long>(reached),
              static_cast<unsigned long long>(count), latest, wall);
  return good == count ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::run_program("formation_field_campaign", [&] {
    Fields fields;
    tools::ProgramOptions options("formation_field_campaign", "Counts random fields that are reached and safe.",
                                  "Prints a line per field that is not. Exit status 1: there was one.");
    options.text("KIND", fields.kind, "Of random_fields.h", true);
    options.text("METHOD", fields.method, "Of simulation.h; of formations a controller, or a set of controller options",
                 true);
    options.whole_number("FIRST", fields.first, 0, "The first field");
    options.whole_number("COUNT", fields.count, 1, "Fields");
    options.whole_number("SEED", fields.seed, 0, "Of the fields");
    return options.parse(argc, argv) ? count_fields(fields) : 0;
  });
}
