// SPDX-License-Identifier: GPL-3.0-or-later
// What does it cost to know the free velocities exactly? FreeArrangement against the bounds of FreeVelocities
// (`ratio` = exact / bounds), for scenes of 4, 16 and 64 cones. Before the timing the bounds must hold what is exact.
#include <algorithm>

#include "exactvo/vo/free_arrangement.h"
#include "exactvo/vo/free_velocities.h"
#include "in_turns.h"
#include "instances.h"

namespace exactvo::bench {
namespace {

using vo::FreeArrangement;
using vo::FreeVelocities;
using vo::ShiftedCone;

constexpr double kMaxSpeed = 2.0;  // m/s
constexpr int kRounds = 3;

using Cones = std::vector<ShiftedCone>;

/// Discs, walls and polygons up to 8 m from the robot's rim and all round it.
Cones random_cones(Stream& random, std::size_t count) {
  constexpr Obstacle kKinds[] = {Obstacle::disc, Obstacle::segment, Obstacle::polygon8};
  const double tau = random.uniform(0.5, 4.0);
  Cones cones;
  for (std::size_t k = 0; k < count; ++k) {
    const double gap = random.uniform(0.05, 8.0);
    const geometry::ConvexShape shape = random_shape(random, kKinds[k % 3], (1.3 + gap) * random.direction());
    cones.push_back({vo::VelocityObstacle(shape, {}, 0.3, tau), {}, {}});
  }
  return cones;
}

std::vector<Cones> random_scenes_of(std::size_t cones, std::size_t count) {
  Stream random(13);
  std::vector<Cones> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(random_cones(random, cones));
  return out;
}

std::size_t exact(const Cones& cones) {
  return FreeArrangement(cones, kMaxSpeed).pieces().size();
}
std::size_t bounded(const Cones& cones) {
  return FreeVelocities(cones, {kMaxSpeed}).least_components();
}

bool bounds_hold(const Cones& cones) {
  const FreeArrangement free(cones, kMaxSpeed);
  const FreeVelocities bounds(cones, {kMaxSpeed});
  return bounds.area().low <= free.area().low && free.area().high <= bounds.area().high &&
         bounds.least_components() <= free.pieces().size();
}

void free_exactly(benchmark::State& state) {
  const auto cones = static_cast<std::size_t>(state.range(0));
  const std::vector<Cones> scenes = random_scenes_of(cones, std::max<std::size_t>(1, 64 / cones));
  if (!std::all_of(scenes.begin(), scenes.end(), bounds_hold)) return state.SkipWithError("the bounds do not hold it");
  report_ratio(state, scenes, exact, exact, bounded, kRounds);
}
BENCHMARK(free_exactly)->Arg(4)->Arg(16)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace exactvo::bench
