// SPDX-License-Identifier: GPL-3.0-or-later
// The thread that waits for the disk: everything in order, nothing lost, nothing after a failure.
#include "batch/work/async_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

namespace exactvo::datasets::test {
namespace {

using batch::AsyncWriter;

TEST(AsyncWriter, RunsEverythingInOrder) {
  std::vector<int> seen;
  std::vector<int> expected;
  AsyncWriter writer;
  for (int k = 0; k < 1000; ++k) {
    writer.run([&seen, k] { seen.push_back(k); }, 1);
    expected.push_back(k);
  }
  writer.finish();
  EXPECT_EQ(seen, expected);
}

TEST(AsyncWriter, EndsOnlyWhenNothingIsLeft) {
  std::atomic<int> done{0};
  {
    AsyncWriter writer;
    for (int k = 0; k < 100; ++k) writer.run([&done] { ++done; }, 1);
  }
  EXPECT_EQ(done, 100);
}

TEST(AsyncWriter, WhatIsTooMuchToWaitIsRunAtOnce) {
  std::promise<void> gate;
  std::thread::id runner;
  AsyncWriter writer;
  writer.run([&gate] { gate.get_future().wait(); }, AsyncWriter::kMostBytesWaiting);
  writer.run([&runner] { runner = std::this_thread::get_id(); }, 1);
  EXPECT_EQ(runner, std::this_thread::get_id());
  gate.set_value();
  writer.finish();
}

TEST(AsyncWriter, AFailureIsThrownAndNothingRunsAfterIt) {
  std::promise<void> gate;
  std::atomic<int> after{0};
  AsyncWriter writer;
  writer.run(
      [&gate] {
        gate.get_future().wait();
        throw std::runtime_error("disk full");
      },
      1);
  for (int k = 0; k < 5; ++k) writer.run([&after] { ++after; }, 1);
  gate.set_value();
  EXPECT_THROW(writer.finish(), std::runtime_error);
  EXPECT_THROW(writer.run([&after] { ++after; }, 1), std::runtime_error);
  EXPECT_THROW(writer.finish(), std::runtime_error);
  EXPECT_EQ(after, 0);
}

}  // namespace
}  // namespace exactvo::datasets::test
