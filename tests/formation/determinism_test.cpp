// SPDX-License-Identifier: GPL-3.0-or-later
// The same scenario gives the same bits: twice here, and as recorded.
#include <gtest/gtest.h>

#include <cstring>

#include "exactvo/datasets/provenance.h"
#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

void append(std::string& bytes, double x) {
  char raw[sizeof x];
  std::memcpy(raw, &x, sizeof x);
  bytes.append(raw, sizeof x);
}

/// SHA-256 over the bits of every state and chosen velocity.
std::string fingerprint(const Recording& recording) {
  std::string bytes;
  for (const Step& row : recording.steps) {
    for (const RobotStep& r : row.robots)
      for (const Vec2 v : {r.position, r.velocity, r.chosen}) {
        append(bytes, v.x);
        append(bytes, v.y);
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

TEST(Determinism, RecordingEverythingChangesNothing) {
  SimulationOptions all;
  all.record_all = true;
  EXPECT_EQ(fingerprint(simulate(test::paper_scene("B1"), all)), fingerprint_of("B1"));
}

// They move with every change of rounding in geometry, vo or lp too. Record anew only for a change that is meant to move
// robots, or that is known to move them by rounding alone: the commit says which.
TEST(Determinism, GoldenA2) {
  EXPECT_EQ(fingerprint_of("A2"), "178245ab1165e6e36de2bbfba549f03fc64ee11a7425b3316af8b91cb5dd49e2");
}
TEST(Determinism, GoldenB1) {
  EXPECT_EQ(fingerprint_of("B1"), "1aa47f5ecddcf746592cd976bc752a670902d7fec057ae42c90f44f8208ae417");
}

}  // namespace
}  // namespace exactvo::formation
