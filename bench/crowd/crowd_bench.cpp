// SPDX-License-Identifier: GPL-3.0-or-later
// How fast is a step of a crowd, where does its time go, what does certification cost, and what does the textbook need
// for the same step? Each round sets the textbook's crowd to the state of ours, compares what both choose, and times
// both one after the other by the CPU time of the thread, so that a busy machine slows both alike. Preferences are set
// before, untimed. One thread.
//
//   bench_crowd --benchmark_filter='crowd/10000/' [--target=AVX2]
//
// Counters: `ns` a robot step; `textbook` how many times as long the textbook takes; `of_plain` time over that of the
// same without certification (medians of the rounds); `of_wishes` time of a whole step over that of its first level, in
// the same step (median, tenth and ninetieth percentile); `sort` ... `finish` shares of the time; `relaxed`,
// `cut_short` % of robots; `bytes` a robot, and the textbook's; `edges`, `neighbours`: half-planes a robot; `apart_99`
// m/s, 99 % of velocities are nearer to the textbook's. In wheels/...: `of_free` time over that of the same robots
// without wheels (median, tenth and ninetieth percentile of the rounds).
#include <benchmark/benchmark.h>

#include <ctime>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "crowd_scenes.h"
#include "lp/sets/target.h"
#include "textbook_crowd.h"

namespace exactvo::bench {
namespace {

using formation::Crowd;
using formation::CrowdKind;
using formation::CrowdPrecision;
using formation::CrowdScene;
using geometry::Vec2;

/// Rounds, and steps before the first.
constexpr int kRounds = 11, kWarmUp = 30;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Do>
double seconds_of(const Do& what) {
  const double start = thread_seconds();
  what();
  return thread_seconds() - start;
}

double quantile(std::vector<double> values, double share) {
  const auto nth = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(nth), values.end());
  return values[nth];
}

double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

/// A crowd that is told its preferences before each step.
struct Told {
  explicit Told(const CrowdScene& of) : scene(of), crowd(formation::crowd_of(of)) { crowd.set_steering(nullptr); }

  void tell() {
    crowd.positions(positions);
    preferred.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) preferred[i] = scene.preferred(i, positions[i]);
    crowd.set_preferred(preferred);
  }

  const CrowdScene& scene;
  Crowd crowd;
  std::vector<Vec2> positions, preferred, velocities;
};

TextbookCrowd textbook_of(const CrowdScene& scene) {
  TextbookCrowd crowd(static_cast<float>(scene.options.time_step));
  crowd.reserve(scene.robots.size());
  for (const auto& robot : scene.robots) {
    const CrowdKind& kind = scene.kinds[robot.kind];
    TextbookAgent agent;
    agent.radius = static_cast<float>(kind.radius);
    agent.max_speed = static_cast<float>(kind.max_speed);
    agent.time_horizon = static_cast<float>(kind.time_horizon);
    agent.neighbour_distance = static_cast<float>(kind.neighbour_distance);
    agent.neighbours = kind.neighbours;
    crowd.add(agent);
  }
  return crowd;
}

void copy_state(Told& from, TextbookCrowd& to) {
  from.crowd.velocities(from.velocities);
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i].x = static_cast<float>(from.positions[i].x);
    to[i].y = static_cast<float>(from.positions[i].y);
    to[i].vx = static_cast<float>(from.velocities[i].x);
    to[i].vy = static_cast<float>(from.velocities[i].y);
    to[i].preferred_x = static_cast<float>(from.preferred[i].x);
    to[i].preferred_y = static_cast<float>(from.preferred[i].y);
  }
  to.read();
}

/// m/s, by how much the velocities of both differ, ascending.
std::vector<double> differences(Told& ours, TextbookCrowd& theirs) {
  ours.crowd.velocities(ours.velocities);
  theirs.write();
  std::vector<double> apart;
  for (std::size_t i = 0; i < theirs.size(); ++i)
    apart.push_back(geometry::norm(ours.velocities[i] -
                                   Vec2{static_cast<double>(theirs[i].vx), static_cast<double>(theirs[i].vy)}));
  std::sort(apart.begin(), apart.end());
  return apart;
}

void step(benchmark::State& state, const std::string& kind, std::size_t count, CrowdPrecision precision) {
  CrowdScene scene = formation::crowd_scene(kind, count);
  scene.options.precision = precision;
  CrowdScene unproven = scene;
  unproven.options.certified = false;
  Told ours(scene), plain(unproven);
  const bool compares = scene.obstacles.empty();  // the textbook's has none
  TextbookCrowd theirs = textbook_of(scene);
  for (int k = 0; k < kWarmUp; ++k)
    for (Told* crowd : {&ours, &plain}) crowd->tell(), crowd->crowd.step();
  std::vector<double> ns, ratios, of_plain, apart;
  formation::StepReport report;
  for (auto _ : state) {
    ours.tell();
    plain.tell();
    copy_state(ours, theirs);
    const double textbook = compares ? seconds_of([&] { theirs.step(); }) : 0.0;
    const double certified = seconds_of([&] { report = ours.crowd.step(); });
    const double rounded = seconds_of([&] { plain.crowd.step(); });
    state.SetIterationTime(certified);
    ns.push_back(1e9 * certified / static_cast<double>(count));
    ratios.push_back(textbook / certified);
    of_plain.push_back(certified / rounded);
    if (!compares) continue;
    const auto round = differences(ours, theirs);
    apart.insert(apart.end(), round.begin(), round.end());
  }
  const double robots = static_cast<double>(count);
  if (compares) {
    std::sort(apart.begin(), apart.end());
    const double middling = apart[apart.size() / 2];
    if (middling > 1e-3) return state.SkipWithError("the textbook chooses other velocities");
    state.counters["textbook"] = median(ratios);
    state.counters["apart_50"] = middling;
    state.counters["apart_99"] = apart[apart.size() * 99 / 100];
    state.counters["bytes_textbook"] = static_cast<double>(theirs.bytes()) / robots;
  }
  state.counters["ns"] = median(ns);
  state.counters["of_plain"] = median(of_plain);
  state.counters["relaxed"] = 100.0 * static_cast<double>(report.relaxed) / robots;
  state.counters["cut_short"] = 100.0 * static_cast<double>(report.cut_short) / robots;
  state.counters["neighbours"] = static_cast<double>(report.neighbours) / robots;
  state.counters["bytes"] = static_cast<double>(ours.crowd.bytes()) / robots;
  state.counters["edges"] = static_cast<double>(report.edges) / robots;

  // By the clock on the wall: of the step that took least, in which nothing else ran.
  scene.options.time_phases = true;
  Told timed(scene);
  formation::CrowdPhases before{}, best{};
  double least = 1e300;
  std::vector<double> of_wishes;
  for (int k = 0; k < 3 * kRounds; ++k, before = timed.crowd.phases()) {
    timed.tell();
    timed.crowd.step();
    const formation::CrowdPhases& p = timed.crowd.phases();
    const formation::CrowdPhases now{p.sort - before.sort,    p.search - before.search, p.lines - before.lines,
                                     p.edges - before.edges,  p.solve - before.solve,   p.hard - before.hard,
                                     p.finish - before.finish};
    const double wishes = now.sort + now.search + now.lines + now.edges + now.solve + now.finish;
    const double whole = wishes + now.hard;
    if (k >= kRounds) of_wishes.push_back(whole / wishes);
    if (k == 0 || whole >= least) continue;
    least = whole;
    best = now;
  }
  state.counters["sort"] = best.sort / least;
  state.counters["search"] = best.search / least;
  state.counters["lines"] = best.lines / least;
  state.counters["at_edges"] = best.edges / least;
  state.counters["solve"] = best.solve / least;
  state.counters["hard"] = best.hard / least;
  state.counters["finish"] = best.finish / least;
  state.counters["of_wishes"] = median(of_wishes);
  state.counters["of_wishes_10"] = quantile(of_wishes, 0.1);
  state.counters["of_wishes_90"] = quantile(of_wishes, 0.9);
}

/// What wheels cost: the same robots with and without them, one step of each after the other.
void wheels(benchmark::State& state, std::size_t count, CrowdPrecision precision) {
  CrowdScene scene = formation::crowd_scene("wheels", count), free = scene;
  for (CrowdKind& kind : free.kinds) kind.wheels.reset();
  scene.options.precision = free.options.precision = precision;
  Told driven(scene), others(free);
  for (int k = 0; k < kWarmUp; ++k)
    for (Told* crowd : {&driven, &others}) crowd->tell(), crowd->crowd.step();
  std::vector<double> ns, of_free;
  formation::StepReport report;
  for (auto _ : state) {
    driven.tell();
    others.tell();
    const double on_wheels = seconds_of([&] { report = driven.crowd.step(); });
    const double without = seconds_of([&] { others.crowd.step(); });
    state.SetIterationTime(on_wheels);
    ns.push_back(1e9 * on_wheels / static_cast<double>(count));
    of_free.push_back(on_wheels / without);
  }
  state.counters["ns"] = median(ns);
  state.counters["of_free"] = median(of_free);
  state.counters["of_free_10"] = quantile(of_free, 0.1);
  state.counters["of_free_90"] = quantile(of_free, 0.9);
  state.counters["cut_short"] = 100.0 * static_cast<double>(report.cut_short) / static_cast<double>(count);
  state.counters["relaxed"] = 100.0 * static_cast<double>(report.relaxed) / static_cast<double>(count);
}

template <class Run>
void add(const std::string& label, const Run& run) {
  benchmark::RegisterBenchmark(label.c_str(), run)->Iterations(kRounds)->UseManualTime()->Unit(benchmark::kMillisecond);
}

void register_all() {
  for (const std::size_t count : {1000, 10000, 100000})
    for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines})
      add("wheels/" + std::to_string(count) + "/" + name(precision),
          [=](benchmark::State& s) { wheels(s, count, precision); });
  for (const char* kind : {"crowd", "dense", "ring", "streams", "groups", "mixture", "jam", "blocks", "pillars"})
    for (const std::size_t count : {250, 1000, 10000, 50000, 200000, 1000000})
      for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
        if (kind == std::string("ring") && count > 200000) continue;  // wider than a lattice of fine steps
        add(std::string(kind) + "/" + std::to_string(count) + "/" + name(precision),
            [=](benchmark::State& s) { step(s, kind, count, precision); });
      }
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  const std::string target_flag = "--target=";
  for (int k = 1; k < argc; ++k) {
    if (std::string(argv[k]).rfind(target_flag, 0) != 0) continue;
    if (!exactvo::lp::limit_batch_target(argv[k] + target_flag.size())) {
      std::fprintf(stderr, "bench_crowd: error: %s is no SIMD target of this machine and build\n", argv[k]);
      return 2;
    }
    std::copy(argv + k + 1, argv + argc, argv + k);
    --argc, --k;
  }
  exactvo::bench::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::fprintf(stderr, "SIMD target %s\n", exactvo::formation::crowd_target());
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
