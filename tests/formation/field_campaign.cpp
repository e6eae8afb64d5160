// SPDX-License-Identifier: GPL-3.0-or-later
// Counts random fields: formation_field_campaign KIND METHOD [FIRST [COUNT [SEED]]], KIND of random_fields.h, METHOD of
// simulation.h (formations: a controller, or a set of remedies by its name, "+ saturation" or "no margins"). A line for
// each field that is not reached and safe, then the counts.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "field_verdict.h"

namespace {

using namespace exactvo;

/// A rung of the ladder or an ablation, by name.
bool parse_remedies(const std::string& text, formation::SimulationOptions& options) {
  for (const auto& list : {formation::remedy_ladder(), formation::remedy_ablations()})
    for (const formation::NamedRemedies& n : list)
      if (n.name == text) options.remedies = n.remedies;
  return options.remedies.has_value();
}

int usage() {
  std::fputs("usage: formation_field_campaign KIND METHOD|CONTROLLER|REMEDIES [FIRST [COUNT [SEED]]]\n", stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  datasets::FieldKind kind{};
  formation::SimulationOptions options;
  if (argc < 3 || !datasets::parse(argv[1], kind)) return usage();
  if (!parse(argv[2], options.method) && !parse(argv[2], options.controller) && !parse_remedies(argv[2], options))
    return usage();
  const auto number = [&](int at, std::uint64_t fallback) {
    return argc > at ? std::strtoull(argv[at], nullptr, 10) : fallback;
  };
  const std::uint64_t first = number(3, 0), count = number(4, 1000), seed = number(5, datasets::kFieldSeed);
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
              argv[1], argv[2], static_cast<unsigned long long>(seed), static_cast<unsigned long long>(first),
              static_cast<unsigned long long>(first + count - 1), static_cast<unsigned long long>(good),
              static_cast<unsigned long long>(reached), static_cast<unsigned long long>(count), latest, wall);
  return good == count ? 0 : 1;
}
