// SPDX-License-Identifier: GPL-3.0-or-later
// The ordered pipeline and what stands at its ends: everything is worked on, finished in order, and a failure is thrown
// when nothing runs any more; memory is held as allowed; a reader is pulled from, one step at a time.
#include "exactvo/datasets/ordered_work.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "batch/work/allowance.h"
#include "batch/work/coroutine.h"

namespace exactvo::datasets::test {
namespace {

using batch::Allowance;
using batch::Coroutine;
using batch::Stopped;
using std::chrono::milliseconds;

std::vector<int> first_numbers(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Gives `count` tasks, numbered from 0.
template <class Work, class Finish>
std::function<std::optional<OrderedTask>()> tasks(int count, Work work, Finish finish) {
  return [k = 0, count, work, finish]() mutable -> std::optional<OrderedTask> {
    if (k == count) return std::nullopt;
    const int number = k++;
    return OrderedTask{[work, number] { work(number); }, [finish, number] { finish(number); }};
  };
}

class OrderedWork : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Workers, OrderedWork, testing::Values(1, 2, 4));

TEST_P(OrderedWork, EverythingIsWorkedOnAndFinishedInOrderWheneverItsWorkEnds) {
  std::atomic<int> worked{0};
  std::vector<int> finished;
  const auto work = [&](int k) {
    if (k % 7 == 0) std::this_thread::sleep_for(milliseconds(1));
    ++worked;
  };
  run_in_order(GetParam(), tasks(3000, work, [&](int k) { finished.push_back(k); }));
  EXPECT_EQ(worked, 3000);
  EXPECT_EQ(finished, first_numbers(3000));
}

TEST_P(OrderedWork, TheFirstFailureInOrderIsThrownAndWhatIsBeforeItIsFinished) {
  for (const char* where : {"next", "work", "finish"}) {
    SCOPED_TRACE(where);
    std::vector<int> finished;
    std::atomic<int> running{0};
    const auto fail_in = [&](const std::string& stage, int k) {
      if (stage == where && k >= 20) throw std::runtime_error(stage + " " + std::to_string(k));
    };
    auto inner = tasks(
        1000000,
        [&](int k) {
          ++running;
          if (k == 20) std::this_thread::sleep_for(milliseconds(5));  // others fail before it
          --running;
          fail_in("work", k);
        },
        [&](int k) {
          fail_in("finish", k);
          finished.push_back(k);
        });
    int given = 0;
    const auto next = [&] {
      fail_in("next", given++);
      return inner();
    };
    try {
      run_in_order(GetParam(), next);
      ADD_FAILURE() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::string(where) + " 20");
    }
    EXPECT_EQ(running, 0);
    EXPECT_EQ(finished, first_numbers(20));
    EXPECT_LE(given, 2000) << "no more tasks are asked for";
  }
}

TEST_P(OrderedWork, NeedsNoneOfTheOtherThreads) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  Allowance memory(100);
  std::vector<int> finished;
  int given = 0;
  run_in_order(GetParam(), [&]() -> std::optional<OrderedTask> {
    if (given == 100) return std::nullopt;
    auto taken = std::make_shared<Allowance::Taken>(memory.take(60));
    return OrderedTask{[taken] { taken->reset(); }, [&finished, k = given++] { finished.push_back(k); }};
  });
  EXPECT_EQ(finished, first_numbers(100));
}

TEST_P(OrderedWork, NoMoreMemoryIsTakenThanAllowedButByATaskThatTakesMoreAlone) {
  for (const int large : {0, 1000}) {
    Allowance memory(100);
    std::atomic<int> held{0};
    std::atomic<int> most{0};
    int given = 0;
    run_in_order(GetParam(), [&]() -> std::optional<OrderedTask> {
      if (given == 100) return std::nullopt;
      const int k = given++;
      const int bytes = k == 50 && large > 0 ? large : 20 + k % 30;
      auto taken = std::make_shared<Allowance::Taken>(memory.take(static_cast<std::uint64_t>(bytes)));
      return OrderedTask{[&held, &most, bytes, taken] {
                           const int now = held += bytes;
                           int seen = most;
                           while (seen < now && !most.compare_exchange_weak(seen, now)) continue;
                           std::this_thread::sleep_for(milliseconds(1));
                           held -= bytes;
                           taken->reset();
                         },
                         [] {}};
    });
    EXPECT_LE(most, std::max(100, large));
    EXPECT_GE(most, large);
  }
}

TEST(BatchAllowance, WaitsOnlyUntilThereIsRoom) {
  Allowance memory(100);
  Allowance::Taken small = memory.take(10);
  Allowance::Taken large = memory.take(90);
  std::future<Allowance::Taken> next = std::async(std::launch::async, [&] { return memory.take(60); });
  EXPECT_EQ(next.wait_for(milliseconds(20)), std::future_status::timeout);
  large.reset();
  Allowance::Taken taken = next.get();
  EXPECT_NE(taken, nullptr);
  std::future<Allowance::Taken> more = std::async(std::launch::async, [&] { return memory.take(31); });
  EXPECT_EQ(more.wait_for(milliseconds(20)), std::future_status::timeout) << "10 and 60 are held";
  EXPECT_NE(memory.take(30), nullptr);
  small.reset();
  taken.reset();
  more.get().reset();
  EXPECT_NE(memory.take(1000), nullptr) << "alone";
}

TEST(BatchAllowance, WithoutALimitEverythingIsThere) {
  Allowance memory(0);
  const Allowance::Taken much = memory.take(std::uint64_t{1} << 60);
  EXPECT_NE(memory.take(std::uint64_t{1} << 60), nullptr);
}

TEST(BatchCoroutine, GivesEverythingOneStepAtATime) {
  std::atomic<int> made{0};
  Coroutine<int> numbers([&](const Coroutine<int>::Give& give) {
    for (int k = 0; k < 1000; ++k) {
      ++made;
      give(k);
    }
  });
  EXPECT_EQ(made, 0);
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(numbers.next(), k);
    EXPECT_EQ(made, k + 1) << "it runs only while it is waited for";
  }
  EXPECT_EQ(numbers.next(), std::nullopt);
  EXPECT_EQ(numbers.next(), std::nullopt);
}

TEST(BatchCoroutine, ExceptionsOfItsBodyAreThrownInItsPlace) {
  Coroutine<int> numbers([](const Coroutine<int>::Give& give) {
    give(1);
    throw std::runtime_error("broken");
  });
  EXPECT_EQ(numbers.next(), 1);
  EXPECT_THROW(numbers.next(), std::runtime_error);
  EXPECT_EQ(numbers.next(), std::nullopt);
}

TEST(BatchCoroutine, ABodyThatIsNotThroughIsLeft) {
  bool was_left = false;
  bool went_on = false;
  {
    Coroutine<int> numbers([&](const Coroutine<int>::Give& give) {
      try {
        give(1);
        went_on = true;
      } catch (const Stopped&) {
        was_left = true;
        throw;
      }
    });
    EXPECT_EQ(numbers.next(), 1);
  }
  EXPECT_TRUE(was_left);
  EXPECT_FALSE(went_on);
  const Coroutine<int> never_asked([&](const Coroutine<int>::Give&) { went_on = true; });
  EXPECT_FALSE(went_on);
}

}  // namespace
}  // namespace exactvo::datasets::test
