// SPDX-License-Identifier: GPL-3.0-or-later
// The workers: they wait for room alone, hold no more than allowed, and say a failure when nothing moves any more.
#include "batch/work/thread_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>

namespace exactvo::datasets::test {
namespace {

using batch::ThreadPool;
using std::chrono::milliseconds;

/// What a job waits for in vain where the pool waits for the job: long beside any other wait here.
constexpr std::chrono::seconds kLong{10};
/// What a job takes that others could overtake.
constexpr milliseconds kWhile{50};

void throw_full() {
  throw std::runtime_error("disk full");
}

class CrewOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(ThreadPool, CrewOf, testing::Values(1, 2, 4));

TEST_P(CrewOf, DoesEverything) {
  std::atomic<int> done{0};
  std::atomic<int> written{0};
  ThreadPool pool(GetParam(), 0);
  for (int k = 0; k < 1000; ++k) {
    pool.run(
        [&] {
          ++done;
          pool.put_away([&written] { ++written; }, 1);
        },
        1);
  }
  pool.finish();
  EXPECT_EQ(done, 1000);
  EXPECT_EQ(written, 1000);
}

TEST_P(CrewOf, HoldsNoMoreThanAllowedButForAJobThatTakesMoreAlone) {
  std::atomic<int> held{0};
  std::atomic<int> most{0};
  ThreadPool pool(GetParam(), 100);
  const auto give = [&](int bytes) {
    pool.run(
        [&held, &most, bytes] {
          const int now = held += bytes;
          int seen = most;
          while (seen < now && !most.compare_exchange_weak(seen, now)) continue;
          std::this_thread::sleep_for(milliseconds(1));
          held -= bytes;
        },
        static_cast<std::uint64_t>(bytes));
  };
  for (int k = 0; k < 100; ++k) give(20 + k % 30);
  pool.finish();
  EXPECT_LE(most, 100);
  give(50);
  give(1000);
  give(50);
  pool.finish();
  EXPECT_EQ(most, 1000);
}

TEST_P(CrewOf, AFailureIsThrownEachTimeAndNothingRunsAfterIt) {
  int after = 0;
  ThreadPool pool(GetParam(), 0);
  EXPECT_THROW(
      {
        pool.run(throw_full, 1);
        pool.finish();
      },
      std::runtime_error);
  for (int k = 0; k < 3; ++k) EXPECT_THROW(pool.run([&after] { ++after; }, 1), std::runtime_error);
  EXPECT_THROW(pool.finish(), std::runtime_error);
  EXPECT_THROW(pool.finish(), std::runtime_error);
  EXPECT_EQ(after, 0);
}

TEST_P(CrewOf, AFailureIsThrownOnceEverythingIsPutAway) {
  std::atomic<bool> written{false};
  ThreadPool pool(GetParam(), 0);
  pool.put_away(
      [&written] {
        std::this_thread::sleep_for(kWhile);
        written = true;
      },
      1);
  EXPECT_THROW(
      {
        pool.run(throw_full, 1);
        pool.finish();
      },
      std::runtime_error);
  EXPECT_TRUE(written);
}

TEST_P(CrewOf, AFailureOfTheDiskIsThrownEachTime) {
  ThreadPool pool(GetParam(), 0);
  pool.put_away(throw_full, 1);
  EXPECT_THROW(pool.finish(), std::runtime_error);
  EXPECT_THROW(pool.finish(), std::runtime_error);
  pool.rest();
}

TEST(ThreadPool, WaitsForRoomAndNotForTheDisk) {
  std::promise<void> gate;
  std::atomic<bool> written{false};
  ThreadPool pool(2, 100);
  pool.put_away(
      [&] {
        gate.get_future().wait_for(kLong);
        written = true;
      },
      1);
  for (int k = 0; k < 3; ++k) pool.run([] {}, 60);
  EXPECT_FALSE(written);
  gate.set_value();
  pool.finish();
  EXPECT_TRUE(written);
}

TEST(ThreadPool, WaitsForRoomAndNotForEveryJob) {
  std::promise<void> gate;
  std::promise<void> started;
  std::atomic<bool> done{false};
  ThreadPool pool(2, 100);
  pool.run(
      [&] {
        started.set_value();
        gate.get_future().wait_for(kLong);
        done = true;
      },
      10);
  ASSERT_EQ(started.get_future().wait_for(kLong), std::future_status::ready);
  for (int k = 0; k < 3; ++k) pool.run([] {}, 60);
  EXPECT_FALSE(done);
  gate.set_value();
  pool.finish();
  EXPECT_TRUE(done);
}

TEST(ThreadPool, NeedsNoneOfTheOthers) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  int done = 0;
  ThreadPool pool(4, 100);
  for (int k = 0; k < 100; ++k) pool.run([&done] { ++done; }, 60);
  pool.finish();
  EXPECT_EQ(done, 100);
}

}  // namespace
}  // namespace exactvo::datasets::test
