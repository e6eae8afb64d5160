// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two ways to the same answer, timed in turns in one run, so that a busy machine slows both alike.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace exactvo::bench {

/// The time that this thread was computing, s: what else runs on the machine counts less than by the clock on the wall.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds a call of `work`, over at least `least_seconds`. Calls come in doubling batches, so the timer is not timed.
template <class Work>
double seconds_a_call(const Work& work, double least_seconds) {
  for (long calls = 1;; calls *= 2) {
    const double start = thread_seconds();
    for (long i = 0; i < calls; ++i) benchmark::DoNotOptimize(work());
    const double elapsed = thread_seconds() - start;
    if (elapsed >= least_seconds) return elapsed / static_cast<double>(calls);
  }
}

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Runs `ours` as the benchmark's loop and reports `ratio`: how many times as long `theirs` takes (median of nine
/// rounds in turns), with both times in microseconds. REQUIRES: the answers were compared before.
template <class Ours, class Theirs>
void compare(benchmark::State& state, const Ours& ours, const Theirs& theirs) {
  constexpr int kRounds = 9;
  std::vector<double> our_seconds, their_seconds;
  for (int round = 0; round < kRounds; ++round) {
    our_seconds.push_back(seconds_a_call(ours, 0.01));
    their_seconds.push_back(seconds_a_call(theirs, 0.01));
  }
  for (auto _ : state) benchmark::DoNotOptimize(ours());
  state.counters["ratio"] = median(their_seconds) / median(our_seconds);
  state.counters["ours_us"] = 1e6 * median(our_seconds);
  state.counters["theirs_us"] = 1e6 * median(their_seconds);
}

}  // namespace exactvo::bench
