// SPDX-License-Identifier: GPL-3.0-or-later
#include "warm.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <vector>

#include "cpu_time.h"
#include "recorded.h"
#include "sets.h"

namespace exactvo::bench {
namespace {

constexpr std::size_t kMost = 32768;

/// Decisions that have one before them, with the labels of the lines that bound there.
struct Sequence {
  std::vector<lp::Problem> problems;
  std::vector<std::vector<int>> bound_before;
};

std::vector<std::int32_t> active_lines(const std::vector<lp::Problem>& problems) {
  Arrays<double> arrays(problems);
  std::vector<std::int32_t> active(3 * arrays.stride, lp::kNoLine);
  lp::BatchAnswers<double> answers = arrays.answers();
  answers.active = active.data();
  lp::solve_batch(arrays.problems(), answers, 0, arrays.count);
  return active;
}

Sequence sequence_of(const std::string& name) {
  const std::vector<Decision> decisions = record(name);
  std::vector<lp::Problem> all;
  std::map<std::pair<int, int>, std::size_t> at;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    all.push_back(decisions[i].problem);
    at[{decisions[i].robot, decisions[i].step}] = i;
  }
  const std::vector<std::int32_t> active = active_lines(all);
  const std::size_t stride = active.size() / 3;
  Sequence sequence;
  for (std::size_t i = 0; i < decisions.size() && sequence.problems.size() < kMost; ++i) {
    const auto before = at.find({decisions[i].robot, decisions[i].step - 1});
    if (before == at.end()) continue;
    std::vector<int> labels;
    for (std::size_t slot = 0; slot < 3; ++slot) {
      const std::int32_t line = active[slot * stride + before->second];
      if (line != lp::kNoLine) labels.push_back(all[before->second].constraints[line].label);
    }
    sequence.problems.push_back(all[i]);
    sequence.bound_before.push_back(labels);
  }
  return sequence;
}

std::int32_t line_labelled(const lp::Problem& problem, int label) {
  for (std::size_t k = 0; k < problem.constraints.size(); ++k)
    if (problem.constraints[k].label == label) return static_cast<std::int32_t>(k);
  return lp::kNoLine;
}

std::vector<std::int32_t> hints_of(const Sequence& sequence, std::size_t stride) {
  std::vector<std::int32_t> hints(3 * stride, lp::kNoLine);
  for (std::size_t i = 0; i < sequence.problems.size(); ++i)
    for (std::size_t slot = 0; slot < sequence.bound_before[i].size(); ++slot)
      hints[slot * stride + i] = line_labelled(sequence.problems[i], sequence.bound_before[i][slot]);
  return hints;
}

double share_unchanged(const Sequence& sequence) {
  const std::vector<std::int32_t> active = active_lines(sequence.problems);
  const std::size_t stride = active.size() / 3;
  std::size_t same = 0;
  for (std::size_t i = 0; i < sequence.problems.size(); ++i) {
    std::vector<int> labels, before = sequence.bound_before[i];
    for (std::size_t slot = 0; slot < 3; ++slot) {
      const std::int32_t line = active[slot * stride + i];
      if (line != lp::kNoLine) labels.push_back(sequence.problems[i].constraints[line].label);
    }
    std::sort(labels.begin(), labels.end());
    std::sort(before.begin(), before.end());
    same += labels == before;
  }
  return static_cast<double>(same) / static_cast<double>(sequence.problems.size());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class T>
void compare(const Sequence& sequence, const char* what, int rounds) {
  Arrays<T> arrays(sequence.problems);
  const std::vector<std::int32_t> hints = hints_of(sequence, arrays.stride);
  lp::BatchProblems<T> cold = arrays.problems(), warm = cold;
  warm.hint = hints.data();
  warm.hint_stride = arrays.stride;
  const auto nanoseconds = [&](const lp::BatchProblems<T>& problems) {
    lp::solve_batch(problems, arrays.answers(), 0, arrays.count);
    const double before = thread_nanoseconds();
    lp::solve_batch(problems, arrays.answers(), 0, arrays.count);
    return (thread_nanoseconds() - before) / static_cast<double>(arrays.count);
  };
  const auto verdicts = [&](const lp::BatchProblems<T>& problems) {
    const lp::BatchAnswers<T> out = arrays.answers();
    lp::solve_batch(problems, out, 0, arrays.count);
    return std::vector<std::uint8_t>(out.status, out.status + arrays.count);
  };
  const std::vector<std::uint8_t> expected = verdicts(cold), found = verdicts(warm);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < arrays.count; ++i) differ += expected[i] != found[i];
  std::vector<double> cold_times, warm_times;
  for (int round = 0; round < rounds; ++round) {
    cold_times.push_back(nanoseconds(cold));
    warm_times.push_back(nanoseconds(warm));
  }
  std::printf("  %-8s cold %7.1f ns   warm %7.1f ns   %5.2f times as fast   %zu verdicts differ\n", what,
              median(cold_times), median(warm_times), median(cold_times) / median(warm_times), differ);
}

}  // namespace

void run_warm(const std::string& name, int rounds) {
  const Sequence sequence = sequence_of(name);
  std::printf("%s: %zu decisions with one before them, the same lines bind in %.1f %%\n", name.c_str(),
              sequence.problems.size(), 100.0 * share_unchanged(sequence));
  compare<double>(sequence, "double", rounds);
  compare<float>(sequence, "float", rounds);
}

}  // namespace exactvo::bench
