// SPDX-License-Identifier: GPL-3.0-or-later
// Verdicts on bodies in motion against an oracle in rationals, by the hundred thousand, run by hand:
//
//     motions_campaign 100000 1 [KIND]     KIND: discs, disc-and-edges, curved-discs, curved-edges, bodies, twists,
//     drives, turning-polygons, full-turns; all in turn
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "geometry/motion_judge.h"
#include "geometry/turning_judge.h"
#include "options/program_options.h"

namespace {

using namespace exactvo::test;

/// The bounds of one case in this many are judged too; they take the oracle five times as long.
constexpr std::size_t kBoundsOfEach = 16;

struct Flags {
  std::size_t count = 20000;
  std::uint64_t seed = 1;
  std::string kind = "all";
};

/// The kinds of an enumeration, as far as they are asked for.
template <class Kinds, class Judge>
void run_kinds(const Flags& flags, const Kinds& kinds, const Judge& judge, MotionCampaign& campaign) {
  for (const auto kind : kinds) {
    if (flags.kind != "all" && flags.kind != name_of(kind)) continue;
    const MotionCampaign of_kind = judge(kind, flags.count, flags.seed, kBoundsOfEach);
    for (const std::string& failure : of_kind.failures) std::printf("%s\n", failure.c_str());
    std::printf("%s: %s\n", name_of(kind), of_kind.summary().c_str());
    std::fflush(stdout);
    campaign += of_kind;
  }
}

int run(const Flags& flags) {
  MotionCampaign campaign;
  const auto begin = std::chrono::steady_clock::now();
  run_kinds(flags, kMotionKinds, &judge_motions, campaign);
  run_kinds(flags, kTurningKinds, &judge_turnings, campaign);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("seed %llu: %s in %.0f s\n", static_cast<unsigned long long>(flags.seed), campaign.summary().c_str(),
              seconds);
  return campaign.failures.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return exactvo::tools::run_program("motions_campaign", [&] {
    Flags flags;
    exactvo::tools::ProgramOptions options("motions_campaign", "Verdicts on bodies in motion against an oracle");
    options.whole_number("COUNT", flags.count, 1, "Cases of each kind");
    options.whole_number("SEED", flags.seed, 0, "Seed of the random cases");
    std::vector<std::string> kinds{"all"};
    for (const MotionKind kind : kMotionKinds) kinds.emplace_back(name_of(kind));
    for (const TurningKind kind : kTurningKinds) kinds.emplace_back(name_of(kind));
    options.word("KIND", flags.kind, kinds, "One kind, or all");
    return options.parse(argc, argv) ? run(flags) : 0;
  });
}
