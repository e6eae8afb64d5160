// SPDX-License-Identifier: GPL-3.0-or-later
// How long do the map, a plan and a question of routes.h take for n vertices, and how much longer than the shortest are
// routes? Beside them the visibility graph of the textbooks (visibility_graph.h) on the same field, as far as O(n^3)
// lets it. Lengths are compared before anything is timed: those of points are equal to 1e-9, those of discs lie between
// their lower bound and the shortest on one side, and are not shorter than it on the other.
//
// The field: hexagons on a jittered lattice, 1 m and more apart. Questions lead from one place between hexagons to
// another, all over the field; a call answers one of 64 in turns. The disc has a radius of 0.3 m.
//
// Counters: `over_bound` length over lower bound, the mean of the 64; `over_shortest` over the shortest path's;
// `median_us` the median of the 64, of which long ones take many times as long as short ones.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "clouds.h"
#include "exactvo/geometry/routes.h"
#include "visibility_graph.h"

namespace exactvo::bench {
namespace {

using geometry::Obstacle;
using geometry::Polygon;
using geometry::Route;
using geometry::RouteMap;
using geometry::RoutePlan;
using geometry::Vec2;

constexpr double kRadius = 0.3, kCell = 4.0;  // m
constexpr std::size_t kQuestions = 64;

struct Field {
  ConvexRings rings;
  std::vector<Obstacle> obstacles;
  std::vector<std::pair<Vec2, Vec2>> questions;

  explicit Field(int vertices) {
    constexpr int kCorners = 6;
    Stream stream(11);
    const int side = std::max(2, static_cast<int>(std::lround(std::sqrt(static_cast<double>(vertices) / kCorners))));
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto jitter = [&] { return 0.6 * stream.uniform() - 0.3; };
        const double dx = jitter(), dy = jitter(), radius = 0.8 + 0.4 * stream.uniform();
        std::vector<Vec2> ring;
        for (int k = 0; k < kCorners; ++k) {
          const double angle = 2.0 * geometry::kPi * (k + 0.7 * stream.uniform()) / kCorners;
          ring.push_back({kCell * x + dx + radius * std::cos(angle), kCell * y + dy + radius * std::sin(angle)});
        }
        rings.push_back(ring);
        obstacles.emplace_back(Polygon{ring, {}});
      }
    }
    const auto place = [&] {
      const double x = std::floor(stream.uniform() * side), y = std::floor(stream.uniform() * side);
      return Vec2{kCell * (x - 0.5), kCell * (y - 0.5)};
    };
    while (questions.size() < kQuestions) {
      const Vec2 start = place(), goal = place();
      if (!(start == goal)) questions.emplace_back(start, goal);
    }
  }
};

/// The route of a question, which has one in these fields.
Route route_of(const RoutePlan& plan, const std::pair<Vec2, Vec2>& question) {
  return std::get<Route>(plan.query(question.first, question.second));
}

void make_map(benchmark::State& state) {
  const Field field(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(RouteMap(field.obstacles));
}

void make_plan(benchmark::State& state) {
  const RouteMap map(Field(static_cast<int>(state.range(0))).obstacles);
  for (auto _ : state) benchmark::DoNotOptimize(RoutePlan(map, kRadius));
}

/// us, of the questions: of each the least of a few.
double median_time(const RoutePlan& plan, const Field& field) {
  constexpr int kTimes = 5;
  std::vector<double> times;
  for (const auto& question : field.questions) {
    double least = 1e300;
    for (int k = 0; k < kTimes; ++k) {
      const auto start = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(route_of(plan, question));
      least =
          std::min(least, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    }
    times.push_back(least);
  }
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  return times[times.size() / 2];
}

void ask(benchmark::State& state, double radius) {
  const Field field(static_cast<int>(state.range(0)));
  const RoutePlan plan(RouteMap(field.obstacles), radius);
  double over_bound = 0.0;
  for (const auto& question : field.questions) {
    const Route route = route_of(plan, question);
    over_bound += route.length / route.lower_bound / kQuestions;
  }
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(route_of(plan, field.questions[k++ % kQuestions]));
  state.counters["over_bound"] = over_bound;
  state.counters["median_us"] = median_time(plan, field);
}
void ask_disc(benchmark::State& state) {
  ask(state, kRadius);
}
void ask_point(benchmark::State& state) {
  ask(state, 0.0);
}

/// The tree of gates is made before.
void ask_widest(benchmark::State& state) {
  const Field field(static_cast<int>(state.range(0)));
  const RouteMap map(field.obstacles);
  double sum = map.widest_radius(field.questions[0].first, field.questions[0].second);
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& [start, goal] = field.questions[k++ % kQuestions];
    sum += map.widest_radius(start, goal);
  }
  benchmark::DoNotOptimize(sum);
}

/// Mean of our lengths over the shortest; nothing where one contradicts it.
std::optional<double> compared(const Field& field, const VisibilityGraph& graph, double radius) {
  constexpr double kSame = 1e-9;
  const RoutePlan plan(RouteMap(field.obstacles), radius);
  double ratio = 0.0;
  for (const auto& question : field.questions) {
    const Route route = route_of(plan, question);
    const double shortest = graph.shortest(question.first, question.second);
    const bool fits = route.length >= (1.0 - kSame) * shortest && route.lower_bound <= (1.0 + kSame) * shortest;
    if (!fits || (radius == 0.0 && route.length > (1.0 + kSame) * shortest)) return std::nullopt;
    ratio += route.length / shortest / kQuestions;
  }
  return ratio;
}

void make_visibility_graph(benchmark::State& state, double radius) {
  const Field field(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(VisibilityGraph(field.rings, radius));
}
void ask_visibility_graph(benchmark::State& state, double radius) {
  const Field field(static_cast<int>(state.range(0)));
  const VisibilityGraph graph(field.rings, radius);
  const std::optional<double> ratio = compared(field, graph, radius);
  if (!ratio) {
    state.SkipWithError("the lengths differ");
    return;
  }
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& [start, goal] = field.questions[k++ % kQuestions];
    benchmark::DoNotOptimize(graph.shortest(start, goal));
  }
  state.counters["over_shortest"] = *ratio;
}

BENCHMARK(make_map)->Name("routes/map")->RangeMultiplier(10)->Range(100, 100000)->Unit(benchmark::kMillisecond);
BENCHMARK(make_plan)->Name("routes/plan")->RangeMultiplier(10)->Range(100, 100000)->Unit(benchmark::kMillisecond);
BENCHMARK(ask_disc)->Name("routes/query")->RangeMultiplier(10)->Range(100, 100000)->Unit(benchmark::kMillisecond);
BENCHMARK(ask_point)
    ->Name("routes/query_of_point")
    ->RangeMultiplier(10)
    ->Range(100, 100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ask_widest)->Name("routes/widest")->RangeMultiplier(10)->Range(100, 100000)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(make_visibility_graph, disc, kRadius)
    ->Name("visibility_graph/map")
    ->Arg(100)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ask_visibility_graph, disc, kRadius)
    ->Name("visibility_graph/query")
    ->Arg(100)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(make_visibility_graph, point, 0.0)
    ->Name("visibility_graph/map_of_point")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ask_visibility_graph, point, 0.0)
    ->Name("visibility_graph/query_of_point")
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace exactvo::bench
