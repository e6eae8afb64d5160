// SPDX-License-Identifier: GPL-3.0-or-later
// The same scenario gives the same bits: twice here, and as recorded.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "exactvo/datasets/provenance.h"
#include "paper_scenes.h"
#include "support/c_library.h"

namespace exactvo::formation {
namespace {

using test::append_bits;

/// SHA-256 over the bits of every state and chosen velocity.
std::string fingerprint(const Recording& recording) {
  std::string bytes;
  for (const Step& row : recording.steps) {
    for (const RobotStep& r : row.robots)
      for (const Vec2 v : {r.position, r.velocity, r.chosen}) {
        append_bits(bytes, v.x);
        append_bits(bytes, v.y);
      }
  }
  return datasets::sha256_of(bytes);
}

std::string fingerprint_of(const char* scene) {
  return fingerprint(simulate(test::paper_scene(scene)));
}

TEST(Determinism, TheSameScenarioGivesTheSameBits) {
  for (const char* scene : {"A2", "A7", "A15", "B1", "B3"}) EXPECT_EQ(fingerprint_of(scene), fingerprint_of(scene));
}

TEST(Determinism, ThreadsChangeNothing) {
  const std::vector<const char*> scenes{"A2", "A7", "A14", "B1", "B2", "B3"};
  std::vector<std::string> alone;
  for (const char* scene : scenes) alone.push_back(fingerprint_of(scene));
  for (const std::size_t count : {2u, 4u}) {
    std::vector<std::string> together(scenes.size());
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < count; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < scenes.size(); i += count) together[i] = fingerprint_of(scenes[i]);
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(together, alone) << count << " threads";
  }
}

TEST(Determinism, RecordingEverythingChangesNothing) {
  SimulationOptions all;
  all.record_all = true;
  EXPECT_EQ(fingerprint(simulate(test::paper_scene("B1"), all)), fingerprint_of("B1"));
}

/// Holds the bits where the C library is the one they were recorded with; elsewhere, where its functions round
/// otherwise, the end of the run to within what that can do to it.
void expect_golden(const char* scene, const char* golden, const std::vector<Vec2>& ends) {
  const Recording recording = simulate(test::paper_scene(scene));
  if (test::c_library_is_the_recorded_one()) {
    EXPECT_EQ(fingerprint(recording), golden);
  }
  constexpr double kOtherLibrary = 1e-6;  // m: ulps of the elementary functions, grown along a run
  ASSERT_EQ(recording.steps.back().robots.size(), ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i)
    EXPECT_LT(norm(recording.steps.back().robots[i].position - ends[i]), kOtherLibrary) << scene << " " << i;
}

// They move with every change of rounding in geometry, vo or lp too. Record anew only for a change that is meant to
// move robots, or that is known to move them by rounding alone: the commit says which.
TEST(Determinism, GoldenA2) {
  expect_golden("A2", "a0f45b1c5a86104ce9e140cdfa4d2ded045e469c6d5b8378b872233d88892028",
                {{24.960589205, 12.944525286}, {10.0, 0.0}});
}
TEST(Determinism, GoldenB1) {
  expect_golden("B1", "802b025959aab3ce0dd47ec24fe2c5c052c14af2f534b0f5c23db409cbf92efb",
                {{25.666666667, 25.666666667}, {23.666666667, 25.666666667}, {25.666666667, 23.666666667}});
}

}  // namespace
}  // namespace exactvo::formation
