// SPDX-License-Identifier: GPL-3.0-or-later
// free_campaign [SCENES] [SEED] [CLASS]: compares FreeArrangement with the oracle on SCENES scenes of each class, and
// prints those that differ as lines of the corpus (geometry/free_scenes.txt). Exit status 1 if one does.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>

#include "vo/free/oracle.h"

namespace exactvo::test {
namespace {

struct Tally {
  int compared = 0, differ = 0, ambiguous = 0;
};

Tally compare(SceneClass scene_class, int scenes, std::uint64_t seed) {
  Tally tally;
  for (int i = 0; i < scenes; ++i) {
    SeededRandom random(seed * 1000003 + static_cast<std::uint64_t>(scene_class) * 100000007 +
                        static_cast<std::uint64_t>(i));
    const FreeScene scene = random_scene(random, scene_class);
    try {
      std::string wrong;
      try {
        wrong = difference_from_oracle(scene, random);
      } catch (const Ambiguous& e) {
        ++tally.ambiguous;
        if (tally.ambiguous <= 2)
          std::printf("# %s %d: ambiguous, %s\n%s\n", name(scene_class), i, e.what(), corpus_line(scene).c_str());
        continue;
      } catch (const std::exception& e) {
        wrong = e.what();
      }
      ++tally.compared;
      if (wrong.empty()) continue;
      ++tally.differ;
      std::printf("# %s %d: %s\n%s\n", name(scene_class), i, wrong.c_str(), corpus_line(scene).c_str());
    } catch (const std::exception& e) {
      std::printf("# %s\n", e.what());
    }
  }
  return tally;
}

int run(int scenes, std::uint64_t seed, const char* wanted) {
  int differ = 0;
  for (int k = 0; k < kSceneClasses; ++k) {
    const auto scene_class = static_cast<SceneClass>(k);
    if (wanted && std::strcmp(wanted, name(scene_class)) != 0) continue;
    const std::clock_t start = std::clock();
    const Tally tally = compare(scene_class, scenes, seed);
    std::printf("%-17s compared %d, differ %d, ambiguous %d (%.1f s)\n", name(scene_class), tally.compared,
                tally.differ, tally.ambiguous, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    std::fflush(stdout);
    differ += tally.differ;
  }
  return differ == 0 ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::test

int main(int argc, char** argv) {
  return exactvo::test::run(argc > 1 ? std::atoi(argv[1]) : 1000, argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1,
                            argc > 3 ? argv[3] : nullptr);
}
