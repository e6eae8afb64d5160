// SPDX-License-Identifier: GPL-3.0-or-later
// What does exact membership cost? Against plain doubles (`ratio` = exact / plain), against rationals without a filter
// (`ratio` = rational / exact: with the filter's short cuts, and `naive`, every sign evaluated), and how often the
// filter fails on random input (`failure_rate`). Last, what it costs to have a cone: the constructor of
// vo::VelocityObstacle, which proves its shape valid.
#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "in_turns.h"
#include "instances.h"
#include "membership/answers.h"

namespace exactvo::bench {
namespace {

constexpr std::size_t kInstances = 16384;
constexpr std::size_t kSlowInstances = 1024;
constexpr int kPasses = 32;  // of the fast side a round

bool exact(const Instance& i) {
  return geometry::segment_meets(i.s, i.velocity, i.time_horizon);
}
bool plain(const Instance& i) {
  return plain_meets(i.s, i.velocity, i.time_horizon);
}
bool rational(const Instance& i) {
  return rational_meets(i.s, i.velocity, i.time_horizon);
}

bool naive(const Instance& i) {
  return naive_meets(i.s, i.velocity, i.time_horizon);
}

void exact_against_plain(benchmark::State& state, Obstacle kind) {
  const std::vector<Instance> instances = random_instances(kind, kInstances, 8);
  std::size_t wrong = 0, inside = 0;
  geometry::reset_stage_counts();
  for (const Instance& i : instances) {
    wrong += exact(i) != plain(i);
    inside += exact(i);
  }
  if (wrong * 1000 > instances.size()) return state.SkipWithError("the answers differ on more than a per mille");
  report_ratio(state, instances, exact, exact, plain);
  const geometry::StageCounts counts = geometry::stage_counts();
  state.counters["failure_rate"] =
      static_cast<double>(counts.exact) / static_cast<double>(counts.exact + counts.filter);
  state.counters["inside_share"] = static_cast<double>(inside) / static_cast<double>(instances.size());
}
BENCHMARK_CAPTURE(exact_against_plain, disc, Obstacle::disc);
BENCHMARK_CAPTURE(exact_against_plain, ellipse, Obstacle::ellipse);
BENCHMARK_CAPTURE(exact_against_plain, polygon_8, Obstacle::polygon8);

void rational_against_exact(benchmark::State& state, Obstacle kind) {
  const std::vector<Instance> instances = random_instances(kind, kSlowInstances, 9);
  for (const Instance& i : instances)
    if (exact(i) != rational(i)) return state.SkipWithError("the exact answers differ");
  report_ratio(state, instances, exact, rational, exact, 9, kPasses);
}
BENCHMARK_CAPTURE(rational_against_exact, disc, Obstacle::disc);
BENCHMARK_CAPTURE(rational_against_exact, ellipse, Obstacle::ellipse);
BENCHMARK_CAPTURE(rational_against_exact, polygon_8, Obstacle::polygon8);

void naive_against_exact(benchmark::State& state, Obstacle kind) {
  const std::vector<Instance> instances = random_instances(kind, kSlowInstances, 9);
  for (const Instance& i : instances)
    if (exact(i) != naive(i)) return state.SkipWithError("the exact answers differ");
  report_ratio(state, instances, exact, naive, exact, 9, kPasses);
}
BENCHMARK_CAPTURE(naive_against_exact, disc, Obstacle::disc);
BENCHMARK_CAPTURE(naive_against_exact, ellipse, Obstacle::ellipse);

// --- Having one ---

void construct(benchmark::State& state, Obstacle kind) {
  const std::vector<Instance> instances = random_instances(kind, kInstances, 8);
  std::size_t next = 0;
  for (auto _ : state) {
    const Instance& i = instances[next];
    benchmark::DoNotOptimize(vo::VelocityObstacle(i.s.shape, i.s.origin, i.s.radius, i.time_horizon));
    if (++next == instances.size()) next = 0;
  }
}
BENCHMARK_CAPTURE(construct, disc, Obstacle::disc);
BENCHMARK_CAPTURE(construct, ellipse, Obstacle::ellipse);
BENCHMARK_CAPTURE(construct, segment, Obstacle::segment);
BENCHMARK_CAPTURE(construct, polygon_8, Obstacle::polygon8);
BENCHMARK_CAPTURE(construct, polygon_16, Obstacle::polygon16);

}  // namespace
}  // namespace exactvo::bench
