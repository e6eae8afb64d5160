// SPDX-License-Identifier: GPL-3.0-or-later
// Runs crowds and looks at every motion of every pair for overlaps, in whole numbers: `formation_overlaps KIND COUNT
// SEED`. Kinds: `random` (2 to 500 robots, mixed radii and speeds, walls and bodies, up to 70 % of the floor), `circle`
// (2 to 1,000). Prints what was looked at; exit status 1 where two overlap, or a crowd says so.
#include <cstdint>
#include <cstdio>
#include <string>

#include "crowd/overlaps.h"
#include "liveness_scenes.h"
#include "options/program_options.h"

namespace exactvo::formation {
namespace {

using geometry::Vec2;
using test::SeededRandom;

/// m: robots begin at least so far from walls and from each other.
constexpr double kGap = 0.01;

bool is_free(const Scenario& s, Vec2 at, double radius, double half) {
  if (std::max(std::fabs(at.x), std::fabs(at.y)) > half - radius - kGap) return false;
  for (const Robot& r : s.robots)
    if (norm(r.position - at) < r.radius + radius + kGap) return false;
  for (const SceneObstacle& o : s.obstacles) {
    if (const auto* wall = std::get_if<geometry::Polyline>(&o.shape))
      for (std::size_t k = 0; k + 1 < wall->points.size(); ++k) {
        const Vec2 a = wall->points[k], along = wall->points[k + 1] - a;
        const double share = std::clamp(dot(at - a, along) / std::max(1e-12, squared_norm(along)), 0.0, 1.0);
        if (norm(at - a - share * along) < radius + kGap) return false;
      }
  }
  return true;
}

/// Robots of several sizes and speeds that start apart in a box and head for any place.
Scenario random_scene(SeededRandom& random) {
  Scenario s;
  s.name = "random";
  s.guidance = Guidance::none;
  const int count = 2 + static_cast<int>(std::exp(random.uniform(0.0, std::log(499.0))));
  const double covered = random.uniform(0.02, 0.7), spread = random.uniform(0.0, 0.6);
  const double steps[] = {0.05, 0.1, 0.25, 0.5, 1.0};
  s.time_step = steps[random.integer(0, 4)];
  s.time_limit = 60.0 * s.time_step;
  double area = 0.0;
  std::vector<double> radii;
  for (int k = 0; k < count; ++k) {
    radii.push_back(0.5 * random.uniform(1.0 - spread, 1.0));
    area += 3.14159 * radii.back() * radii.back();
  }
  const double half = 0.5 * std::sqrt(area / covered) + 1.0;
  if (random.integer(0, 1) == 1) test_scenes::add_box(s, half, half);
  for (int k = random.integer(0, 4); k > 0; --k) {
    const Vec2 a = random.in_box(half);
    test_scenes::add_wall(s, {a, a + random.uniform(0.2, half) * random.direction()});
  }
  for (const double radius : radii) {
    Vec2 at;
    int tries = 0;
    do at = random.in_box(half);
    while (!is_free(s, at, radius, half) && ++tries < 3000);
    if (tries == 3000) continue;
    test_scenes::add_robot(s, at, random.in_box(half));
    s.robots.back().radius = radius;
    s.robots.back().max_speed = random.uniform(0.3, 3.0);
  }
  return s;
}

Scenario circle_scene(SeededRandom& random) {
  const int count = static_cast<int>(std::exp(random.uniform(std::log(2.0), std::log(1000.0))));
  Scenario s = test_scenes::circle(count, random.uniform(1.1, 3.0));
  s.guidance = Guidance::none;
  s.time_limit = 120.0;
  return s;
}

int run(const std::string& kind, std::uint64_t count, std::uint64_t seed) {
  SeededRandom random(seed);
  std::size_t robots = 0, steps = 0, motions = 0, overlaps = 0, reported = 0, cut_short = 0, arrived = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const Scenario scenario = kind == "circle" ? circle_scene(random) : random_scene(random);
    SimulationOptions options;
    options.precision = k % 2 == 0 ? CrowdPrecision::float_lines : CrowdPrecision::double_lines;
    OverlapCheck check(scenario);
    const RunReport report = run_crowd(scenario, options, &check);
    robots += report.robots;
    steps += report.steps * report.robots;
    arrived += report.arrived;
    motions += check.found.motions;
    overlaps += check.found.overlaps;
    reported += report.overlapping;
    cut_short += report.cut_short;
    if (check.found.overlaps > 0)
      std::printf("scene %llu: %s\n", static_cast<unsigned long long>(k), check.found.first.c_str());
    if (count >= 20 && k % (count / 20) == 0)
      std::fprintf(stderr, "%llu of %llu, %zu motions, %zu overlaps\n", static_cast<unsigned long long>(k),
                   static_cast<unsigned long long>(count), motions, overlaps);
  }
  std::printf(
      "scenes %llu\nrobots %zu\narrived %zu\nrobot_steps %zu\ncut_short %zu\npair_motions %zu\noverlaps %zu\n"
      "overlaps_reported %zu\n",
      static_cast<unsigned long long>(count), robots, arrived, steps, cut_short, motions, overlaps, reported);
  return overlaps + reported == 0 && motions > 0 ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::formation

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("formation_overlaps", [&] {
    std::string kind = "random";
    std::uint64_t count = 1000, seed = 1;
    tools::ProgramOptions options(
        "formation_overlaps", "Runs crowds and looks at every motion of every pair for overlaps, in whole numbers.");
    options.word("KIND", kind, {"random", "circle"}, "Scenes");
    options.whole_number("COUNT", count, 1, "How many");
    options.whole_number("SEED", seed, 0, "Of the random numbers");
    if (!options.parse(argc, argv)) return 0;
    return formation::run(kind, count, seed);
  });
}
