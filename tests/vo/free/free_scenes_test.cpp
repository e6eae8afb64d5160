// SPDX-License-Identifier: GPL-3.0-or-later
// FreeArrangement against the oracle of oracle.h: every scene that once went wrong, and a slice of the campaign.
#include <gtest/gtest.h>

#include "vo/free/oracle.h"

namespace exactvo::test {
namespace {

TEST(FreeScenes, TheCorpusAgreesWithTheOracle) {
  SeededRandom random(seed_of_run(725));
  const std::vector<CorpusCase> cases = read_corpus("geometry/free_scenes.txt");
  ASSERT_FALSE(cases.empty());
  for (const CorpusCase& corpus_case : cases) {
    const FreeScene scene = free_scene_of(corpus_case);
    EXPECT_EQ(difference_from_oracle(scene, random), "") << corpus_line(scene);
  }
}

class FreeScenesOfClass : public testing::TestWithParam<int> {};

TEST_P(FreeScenesOfClass, AgreeWithTheOracle) {
  const auto scene_class = static_cast<SceneClass>(GetParam());
  SeededRandom random(seed_of_run(726 + static_cast<std::uint64_t>(GetParam())));
  int compared = 0;
  constexpr int kScenes = 12;
  for (int i = 0; i < kScenes; ++i) {
    const FreeScene scene = random_scene(random, scene_class);
    try {
      EXPECT_EQ(difference_from_oracle(scene, random), "") << corpus_line(scene);
      ++compared;
    } catch (const Ambiguous&) {
      // The oracle's numbers do not decide: counted below.
    }
  }
  EXPECT_GE(compared, kScenes - 2);
}

INSTANTIATE_TEST_SUITE_P(All, FreeScenesOfClass, testing::Range(0, kSceneClasses),
                         [](const auto& scene) { return std::string(name(static_cast<SceneClass>(scene.param))); });

TEST(FreeScenes, ALineOfTheCorpusReadsBack) {
  SeededRandom random(seed_of_run(727));
  for (int k = 0; k < kSceneClasses; ++k) {
    const std::string line = corpus_line(random_scene(random, static_cast<SceneClass>(k)));
    EXPECT_EQ(corpus_line(free_scene_of(parse_corpus(line, "text").front())), line);
  }
}

}  // namespace
}  // namespace exactvo::test
