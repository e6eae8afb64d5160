// SPDX-License-Identifier: GPL-3.0-or-later
// The trap test against simulation: formation_trap_campaign [COUNT [SEED]]. A line for each disagreement, then the
// counts.
#include <cstdio>

#include "exactvo/formation/stuck.h"
#include "options/program_options.h"
#include "trap_cases.h"

namespace {

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
    for (const formation::StuckReport& r :
         formation::explain_stuck(c.scenario, formation::simulate(c.scenario, c.options)))
      std::printf("%s\n", r.text.c_str());
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
    return options.parse(argc, argv) ? compare(count, seed) : 0;
  });
}
