// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two answers to the same instances, timed in turns in one run, so that a busy machine slows both alike.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace exactvo::bench {

/// s of this thread's own computing: what else runs on the machine counts less than by the clock on the wall.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds an instance, over some passes on end: one pass of a fast answer would be as short as the timer.
template <class Instances, class Answer>
double seconds_each(const Instances& instances, const Answer& answer, int passes) {
  const double start = thread_seconds();
  for (int pass = 0; pass < passes; ++pass)
    for (const auto& instance : instances) benchmark::DoNotOptimize(answer(instance));
  return (thread_seconds() - start) / static_cast<double>(instances.size() * static_cast<std::size_t>(passes));
}

/// Runs `ours` as the benchmark's loop and reports `ratio` = time of `numerator` / time of `denominator`: the median of
/// the rounds' ratios, each round timing one straight after the other, and the least time of either in ns. A
/// denominator hundreds of times faster takes several passes a round.
/// REQUIRES: the answers were compared before.
template <class Instances, class Ours, class Numerator, class Denominator>
void report_ratio(benchmark::State& state, const Instances& instances, const Ours& ours, const Numerator& numerator,
                  const Denominator& denominator, int rounds = 41, int denominator_passes = 1) {
  std::vector<double> ratios, top, bottom;
  for (int round = 0; round < rounds; ++round) {
    top.push_back(seconds_each(instances, numerator, 1));
    bottom.push_back(seconds_each(instances, denominator, denominator_passes));
    ratios.push_back(top.back() / bottom.back());
  }
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ours(instances[next]));
    if (++next == instances.size()) next = 0;
  }
  std::nth_element(ratios.begin(), ratios.begin() + rounds / 2, ratios.end());
  state.counters["ratio"] = ratios[static_cast<std::size_t>(rounds / 2)];
  state.counters["numerator_ns"] = 1e9 * *std::min_element(top.begin(), top.end());
  state.counters["denominator_ns"] = 1e9 * *std::min_element(bottom.begin(), bottom.end());
}

}  // namespace exactvo::bench
