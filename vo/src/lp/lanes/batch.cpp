// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/batch.h"

#include <algorithm>
#include <type_traits>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/seen_by_tsan.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/exact/inward.h"
#include "lp/lanes/layout.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lp/lanes/batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "lp/lanes/lockstep.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

template <class T>
BatchCounts run_range(const BatchProblems<T>& in, const BatchAnswers<T>& out, std::size_t first, std::size_t last,
                      Leftover<T> leftover) {
  using D = hn::ScalableTag<T>;
  const auto run = [&](auto hard, auto index) {
    using Here = Lockstep<D, decltype(hard)::value, decltype(index)::value>;
    return Here(in, out, leftover, conveyor_memory<T>(Here::memory(in.lines))).run(first, last);
  };
#if HWY_TARGET != HWY_SSE2  // where nothing better was built in twenty years, the one general variant is enough
  if (!in.hard && out.active) return run(std::false_type(), std::true_type());
  if (!in.hard) return run(std::false_type(), std::false_type());
#endif
  return run(std::true_type(), std::false_type());
}

BatchCounts run_double(const BatchProblems<double>& in, const BatchAnswers<double>& out, std::size_t first,
                       std::size_t last, Leftover<double> leftover) {
  return run_range<double>(in, out, first, last, leftover);
}

BatchCounts run_float(const BatchProblems<float>& in, const BatchAnswers<float>& out, std::size_t first,
                      std::size_t last, Leftover<float> leftover) {
  return run_range<float>(in, out, first, last, leftover);
}

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace exactvo::lp {

HWY_EXPORT(run_double);
HWY_EXPORT(run_float);

namespace {

/// Problems a task: some microseconds of work, a multiple of every lane count.
constexpr std::size_t kGrain = 1024;

template <class T>
Problem problem_at(const BatchProblems<T>& in, std::size_t i) {
  Problem problem;
  problem.bound.disc = static_cast<double>(in.disc[i]);
  problem.preferred = {static_cast<double>(in.preferred_x[i]), static_cast<double>(in.preferred_y[i])};
  const std::size_t hard = in.hard ? static_cast<std::size_t>(in.hard[i]) : 0;
  problem.constraints.reserve(in.lines);
  for (std::size_t k = 0; k < in.lines; ++k) {
    const std::size_t at = first_line_of(in, i) + k * in.block;
    const HalfPlane h = {{static_cast<double>(in.normal_x[at]), static_cast<double>(in.normal_y[at])},
                         static_cast<double>(in.offset[at])};
    problem.constraints.push_back({h, k < hard ? Priority::hard : Priority::soft, -1});
  }
  return problem;
}

template <class T>
void put(const Solution& s, const BatchAnswers<T>& out, std::size_t i) {
  out.velocity_x[i] = static_cast<T>(s.velocity.x);
  out.velocity_y[i] = static_cast<T>(s.velocity.y);
  out.violation[i] = static_cast<T>(s.violation);
  out.status[i] = static_cast<std::uint8_t>(s.status);
  for (std::size_t slot = 0; out.active && slot < 3; ++slot) {
    const bool line = slot < s.active_count && !is_speed_bound(s.active[slot].binding);
    out.active[slot * out.stride + i] = line ? static_cast<std::int32_t>(s.active[slot].binding.index) : kNoLine;
  }
}

template <class T>
bool solve_alone(const BatchProblems<T>& in, const BatchAnswers<T>& out, std::size_t i) {
  const Problem problem = problem_at(in, i);
  if (!out.proven) {
    const Solution s = solve(problem);
    put(sizeof(T) == 8 ? s : in_float(problem, s), out, i);
    return false;
  }
  const Proven answer = solve_certified(problem);
  put(answer.solution, out, i);
  out.proven[i] = answer.certificate && is_tight(problem, *answer.certificate);
  return answer.exact_stage;
}

template <class T>
void require_arrays(const BatchProblems<T>& in, const BatchAnswers<T>& out, std::size_t first, std::size_t last) {
  EXACTVO_REQUIRE(
      first <= last && last <= in.count && (in.block >= in.count || in.block % kMostLanes == 0) && in.block > 0 &&
          in.count <= out.stride,
      "problems " + std::to_string(first) + " to " + std::to_string(last) + " of " + std::to_string(in.count));
  EXACTVO_REQUIRE(in.disc && in.preferred_x && in.preferred_y && out.velocity_x && out.velocity_y && out.violation &&
                      out.status && (in.lines == 0 || (in.normal_x && in.normal_y && in.offset)),
                  "an array that is null or too short");
}

}  // namespace

template <class T>
BatchCounts solve_batch(const BatchProblems<T>& in, const BatchAnswers<T>& out, std::size_t first, std::size_t last) {
  require_arrays(in, out, first, last);
  if constexpr (std::is_same_v<T, double>) {
    return HWY_DYNAMIC_DISPATCH(run_double)(in, out, first, last, &solve_alone<double>);
  } else {
    EXACTVO_REQUIRE(!out.proven, "a proof asked of float");
    return HWY_DYNAMIC_DISPATCH(run_float)(in, out, first, last, &solve_alone<float>);
  }
}

template <class T>
BatchCounts solve_batch_parallel(const BatchProblems<T>& in, const BatchAnswers<T>& out) {
  const auto plus = [](BatchCounts a, BatchCounts b) { return BatchCounts{a.scalar + b.scalar, a.exact + b.exact}; };
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, BatchCounts counts) {
    const geometry::TaskAtWork seen;
    return plus(counts, solve_batch(in, out, range.begin() * kGrain, std::min(in.count, range.end() * kGrain)));
  };
  const std::size_t tasks = (in.count + kGrain - 1) / kGrain;
  geometry::gives_tasks();
  const BatchCounts counts = tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, tasks), BatchCounts{}, add, plus);
  geometry::has_waited();
  return counts;
}

template BatchCounts solve_batch(const BatchProblems<double>&, const BatchAnswers<double>&, std::size_t, std::size_t);
template BatchCounts solve_batch(const BatchProblems<float>&, const BatchAnswers<float>&, std::size_t, std::size_t);
template BatchCounts solve_batch_parallel(const BatchProblems<double>&, const BatchAnswers<double>&);
template BatchCounts solve_batch_parallel(const BatchProblems<float>&, const BatchAnswers<float>&);

const char* batch_target() {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);  // the lowest bit is the best target
}

}  // namespace exactvo::lp
#endif  // HWY_ONCE
