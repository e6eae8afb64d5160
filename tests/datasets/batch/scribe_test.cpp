// SPDX-License-Identifier: GPL-3.0-or-later
// The thread that waits for the disk: everything in order, nothing lost, nothing after a failure.
#include "batch/scribe.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

namespace exactvo::datasets::test {
namespace {

using batch::Scribe;

TEST(Scribe, RunsEverythingInOrder) {
  std::vector<int> seen;
  std::vector<int> expected;
  Scribe scribe;
  for (int k = 0; k < 1000; ++k) {
    scribe.run([&seen, k] { seen.push_back(k); }, 1);
    expected.push_back(k);
  }
  scribe.finish();
  EXPECT_EQ(seen, expected);
}

TEST(Scribe, EndsOnlyWhenNothingIsLeft) {
  std::atomic<int> done{0};
  {
    Scribe scribe;
    for (int k = 0; k < 100; ++k) scribe.run([&done] { ++done; }, 1);
  }
  EXPECT_EQ(done, 100);
}

TEST(Scribe, WhatIsTooMuchToWaitIsRunAtOnce) {
  std::promise<void> gate;
  std::thread::id runner;
  Scribe scribe;
  scribe.run([&gate] { gate.get_future().wait(); }, Scribe::kMostBytesWaiting);
  scribe.run([&runner] { runner = std::this_thread::get_id(); }, 1);
  EXPECT_EQ(runner, std::this_thread::get_id());
  gate.set_value();
  scribe.finish();
}

TEST(Scribe, AFailureIsThrownAndNothingRunsAfterIt) {
  std::promise<void> gate;
  std::atomic<int> after{0};
  Scribe scribe;
  scribe.run(
      [&gate] {
        gate.get_future().wait();
        throw std::runtime_error("disk full");
      },
      1);
  for (int k = 0; k < 5; ++k) scribe.run([&after] { ++after; }, 1);
  gate.set_value();
  EXPECT_THROW(scribe.finish(), std::runtime_error);
  EXPECT_THROW(scribe.run([&after] { ++after; }, 1), std::runtime_error);
  EXPECT_THROW(scribe.finish(), std::runtime_error);
  EXPECT_EQ(after, 0);
}

}  // namespace
}  // namespace exactvo::datasets::test
