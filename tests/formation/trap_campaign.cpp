// SPDX-License-Identifier: GPL-3.0-or-later
// The trap test against simulation: formation_trap_campaign [COUNT [SEED [PAIRS]]]. A line for each disagreement,
// then the counts. With PAIRS 1, random pairs of facades whose enclosures overlap.
#include <cstdio>

#include "options/program_options.h"
#include "trap_cases.h"

namespace {

int pairs(unsigned long long count, unsigned long long seed) {
  using namespace exactvo;
  test::SeededRandom random(seed);
  unsigned long long runs = 0, stalls = 0, between = 0, wrong = 0, vertices = 0, left = 0;
  while (runs < count) {
    const auto pair = test::random_pair(random);
    if (!pair) continue;
    const test::PairOutcome o = test::outcome_of(*pair);
    ++runs;
    stalls += !o.arrived;
    between += !o.arrived && o.between;
    wrong += !o.agrees();
    if (!o.agrees())
      std::printf("run %llu stalls where nothing was said: %s; %s\n", runs, o.words.c_str(),
                  test::words_of(*pair).c_str());
    for (const test::VertexOutcome& v : test::vertex_outcomes(*pair)) {
      ++vertices;
      if (v.distance < 0.05) continue;
      ++left;
      std::printf("run %llu leaves a vertex said to stop it: %s; %s\n", runs, v.words.c_str(),
                  test::words_of(*pair).c_str());
    }
  }
  std::printf(
      "seed %llu: %llu of %llu runs stall, %llu between two enclosures, %llu where nothing was said; "
      "%llu of %llu vertices said to stop a robot do not\n",
      seed, stalls, runs, between, wrong, left, vertices);
  return wrong + left == 0 ? 0 : 1;
}

int compare(unsigned long long count, unsigned long long seed) {
  using namespace exactvo;
  test::SeededRandom random(seed);
  unsigned long long agreed = 0, traps = 0;
  for (unsigned long long k = 0; k < count; ++k) {
    const test::TrapCase c = test::random_trap_case(random);
    const bool right = test::agrees(c);
    agreed += right;
    traps += formation::stall_possible(c.ellipse, c.goal);
    if (right) continue;
    std::printf("%s\n", test::report_of(c.scenario, formation::simulate(c.scenario, c.options)).c_str());
    std::printf("case %llu: margin %.4f, predicted %s; start (%a, %a) goal (%a, %a) %s\n", k, c.margin,
                formation::stall_possible(c.ellipse, c.goal) ? "a stall" : "none", c.scenario.robots[0].position.x,
                c.scenario.robots[0].position.y, c.goal.x, c.goal.y, geometry::to_string(c.ellipse).c_str());
  }
  std::printf("seed %llu: %llu of %llu agree, %llu of them traps\n", seed, agreed, count, traps);
  return agreed == count ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("formation_trap_campaign", [&] {
    unsigned long long count = 3000, seed = 1;
    tools::ProgramOptions options("formation_trap_campaign", "Compares the trap test with simulation.",
                                  "Prints a line per disagreement. Exit status 1: there was one.");
    options.whole_number("COUNT", count, 1, "Cases");
    options.whole_number("SEED", seed, 0, "Of the cases");
    unsigned long long pairs_asked = 0;
    options.whole_number("PAIRS", pairs_asked, 0, "1: pairs of facades whose enclosures overlap");
    if (!options.parse(argc, argv)) return 0;
    return pairs_asked > 0 ? pairs(count, seed) : compare(count, seed);
  });
}
