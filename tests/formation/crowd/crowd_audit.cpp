// SPDX-License-Identifier: GPL-3.0-or-later
// Audits pairs of neighbours of moving crowds in rationals, whole steps of them: `formation_crowd_audit [PAIRS]
// [ROBOTS]`. Prints what was looked at and what failed; exit status 1 where anything did.
#include "crowd/crowd_audit.h"

#include <cstdint>
#include <cstdio>

#include "crowd_scenes.h"
#include "options/program_options.h"

namespace exactvo::formation {
namespace {

/// Steps that are driven before the first audit, and between two.
constexpr int kStepsBetween = 5;

int run(std::uint64_t wanted, std::uint64_t robots) {
  CrowdAudit audit;
  const char* const kScenes[] = {"crowd", "streams", "mixture", "groups", "jam", "ring", "pillars", "blocks", "bodies"};
  constexpr std::uint64_t kCount = 9;
  for (std::uint64_t round = 0; audit.pairs < wanted; ++round) {
    CrowdScene scene = crowd_scene(kScenes[round % kCount], robots);
    scene.options.precision = round / kCount % 2 ? CrowdPrecision::double_lines : CrowdPrecision::float_lines;
    if (round / (2 * kCount) % 2) scene.options.time_step = 0.1;
    Crowd crowd = crowd_of(scene);
    for (int audits = 0; audits < 10 && audit.pairs < wanted; ++audits) {
      for (int k = 0; k < kStepsBetween + static_cast<int>(round / (4 * kCount)); ++k) crowd.step();
      CrowdAuditor auditor(crowd, scene.obstacles);
      auditor.set_bodies(bodies_of(scene));
      auditor.step(audit);
    }
    std::fprintf(stderr, "%s %s: %zu pairs, %zu failures\n", kScenes[round % kCount], name(scene.options.precision),
                 audit.pairs, audit.failures());
  }
  std::printf(
      "pairs %zu\ntouching %zu\none_sided %zu\nnear %zu\noverlapping %zu\nunsafe %zu\nunequal %zu\nbroken %zu\nmet "
      "%zu\nfast %zu\n"
      "edges %zu\nedges_touching %zu\nedges_open %zu\nedges_met %zu\n"
      "bodies %zu\nbodies_touching %zu\nbodies_open %zu\nbodies_met %zu\n"
      "differing %zu\n",
      audit.pairs, audit.touching, audit.one_sided, audit.near, audit.overlapping, audit.unsafe, audit.unequal,
      audit.broken, audit.met, audit.fast, audit.edges, audit.edges_touching, audit.edges_open, audit.edges_met,
      audit.bodies, audit.bodies_touching, audit.bodies_open, audit.bodies_met, audit.differing);
  if (!audit.first.empty()) std::printf("first: %s\n", audit.first.c_str());
  return audit.failures() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::formation

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("formation_crowd_audit", [&] {
    std::uint64_t pairs = 10000000, robots = 3000;
    tools::ProgramOptions options("formation_crowd_audit",
                                  "Audits pairs of neighbours of moving crowds in rationals: half-planes, velocities, "
                                  "motions.");
    options.whole_number("PAIRS", pairs, 1, "Pairs at least, whole steps");
    options.whole_number("ROBOTS", robots, 1, "Robots a crowd");
    if (!options.parse(argc, argv)) return 0;
    return formation::run(pairs, robots);
  });
}
