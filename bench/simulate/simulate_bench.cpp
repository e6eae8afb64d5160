// SPDX-License-Identifier: GPL-3.0-or-later
// How many robot steps a second does `simulate` take, and how many with the metrics of the run? The label is the
// beginning of a digest over every position and chosen velocity: two builds with the same labels drive the same runs.
// Before anything is timed each scene is run twice, and the digests compared.
//
//   bench_simulate --benchmark_filter=ivo/willow
//   bench_simulate --table --against OTHER/bench_simulate --rounds 11   # two builds side by side, as ratios (table.h)
//   bench_simulate --duration=0.5 --benchmark_filter=ivo/barn   # s: shorter runs; what comes before a first step
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "exactvo/datasets/provenance.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "options/program_options.h"
#include "scenes.h"
#include "table.h"

namespace exactvo::bench {
namespace {

using formation::Method;
using formation::Recording;
using formation::Scenario;
using formation::SimulationOptions;

std::string digest_of(const Recording& recording) {
  std::string bytes;
  for (const formation::Step& row : recording.steps)
    for (const formation::RobotStep& r : row.robots)
      for (const geometry::Vec2 v : {r.position, r.chosen}) {
        char raw[sizeof v];
        std::memcpy(raw, &v, sizeof v);
        bytes.append(raw, sizeof raw);
      }
  return datasets::sha256_of(bytes).substr(0, 12);
}

double robot_steps(const Recording& recording) {
  return static_cast<double>((recording.steps.size() - 1) * recording.steps.front().robots.size());
}

struct Case {
  Scenario scenario;
  SimulationOptions options;
  bool measured = false;  ///< with the metrics
};

void run_case(benchmark::State& state, const Case& c) {
  const std::string digest = digest_of(simulate(c.scenario, c.options));
  if (digest_of(simulate(c.scenario, c.options)) != digest) return state.SkipWithError("two runs of one scene differ");
  double steps = 0.0;
  for (auto _ : state) {
    const Recording recording = simulate(c.scenario, c.options);
    if (c.measured) benchmark::DoNotOptimize(measure(c.scenario, recording));
    steps += robot_steps(recording);
  }
  state.SetLabel(digest);
  state.counters["robot_steps"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
}

double seconds_of(const std::string& text) {
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(seconds > 0.0) || !std::isfinite(seconds))
    throw std::runtime_error("--duration is a number of seconds above 0, not '" + text + "'");
  return seconds;
}

/// Takes "--duration=S" out of the arguments. 0: there is none.
double duration_among(int& argc, char** argv) {
  const std::string key = "--duration=";
  double duration = 0.0;
  char** const end = std::remove_if(argv + 1, argv + argc, [&](const char* argument) {
    if (std::string(argument).rfind(key, 0) != 0) return false;
    duration = seconds_of(argument + key.size());
    return true;
  });
  argc = static_cast<int>(end - argv);
  return duration;
}

/// As in the paper; `along_routes` as programs do by default.
void add(Scenario scenario, Method method, bool along_routes, double duration) {
  if (duration > 0.0) scenario.time_limit = std::min(scenario.time_limit, duration);
  for (const bool measured : {false, true}) {
    Case c{scenario, {}, measured};
    c.options.method = method;
    c.options.guidance = along_routes ? formation::Guidance::route : formation::Guidance::none;
    c.options.liveness = along_routes ? formation::Liveness::plan : formation::Liveness::off;
    const std::string title =
        std::string(name(method)) + (along_routes ? "+route/" : "/") + scenario.name + (measured ? "/measured" : "");
    benchmark::RegisterBenchmark(title.c_str(), run_case, c)->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace exactvo::bench

namespace exactvo::bench {
namespace {

int print_table_as_asked(int argc, char** argv) {
  TableOptions asked;
  asked.self = argv[0];
  bool table = false;
  tools::ProgramOptions options("bench_simulate", "How many robot steps a second does simulate take?");
  options.flag("--table", table, "Print a table of all scenes instead");
  options.text("--against", asked.against, "Another build's bench_simulate, to be compared with");
  options.text("--scenes", asked.scenes, "Regular expression of the scenes' names");
  std::string duration;
  options.text("--duration", duration, "No run is longer than this, s; OTHER must know the option too");
  options.word("--method", asked.method, {"ivo", "orca", "ivo+route", "orca+route"}, "Method; +route: as by default");
  options.whole_number("--rounds", asked.rounds, 1, "Rounds in which the builds take turns");
  if (!options.parse(argc, argv)) return EXIT_SUCCESS;
  if (!duration.empty()) asked.duration = seconds_of(duration);
  print_table(asked);
  return EXIT_SUCCESS;
}

int run_benchmarks(int argc, char** argv) {
  const double duration = duration_among(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  for (const auto& scenes : {generated_scenes(), public_scenes(), project_scenes()})
    for (const Scenario& scene : scenes)
      for (const Method method : {Method::ivo, Method::orca})
        for (const bool along_routes : {false, true})
          if (!along_routes || !scene.formation) add(scene, method, along_routes, duration);
  benchmark::RunSpecifiedBenchmarks();
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("bench_simulate", [&] {
    const bool table = argc > 1 && std::string(argv[1]) == "--table";
    return table ? bench::print_table_as_asked(argc, argv) : bench::run_benchmarks(argc, argv);
  });
}
