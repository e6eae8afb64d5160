// SPDX-License-Identifier: GPL-3.0-or-later
// What does a proof of the whole decision cost, from the obstacles to the velocity? `ratio` = proven / plain doubles
// throughout. Before anything is timed each velocity is held against each velocity obstacle: exactly, and a part of
// them in rationals that share no line with the library. `unsafe` and `plain_unsafe_share` count decisions with a
// velocity that collides, `stopped_share` those that end in standing still because no other velocity was found to be
// free.
#include "decision/decide.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/predicates.h"
#include "in_turns.h"
#include "membership/answers.h"

namespace exactvo::bench {
namespace {

using geometry::GrownShape;
using geometry::Vec2;

constexpr std::size_t kScenes = 32768;
constexpr std::size_t kInRationals = 32;  // of this many scenes one is judged in rationals as well
constexpr int kRounds = 15;
constexpr double kSame = 1e-6;       // m/s: slacks and tilts are of the order of 1e-14, corners magnify them
constexpr double kMostApart = 1e-3;  // of the scenes: corners so sharp that they magnify more

bool collides(const Scene& scene, Vec2 v) {
  return std::any_of(scene.seen.begin(), scene.seen.end(),
                     [&](const GrownShape& s) { return geometry::segment_meets(s, v, scene.time_horizon); });
}

/// Segments are not among what the rational side knows.
bool collides_in_rationals(const Scene& scene, Vec2 v) {
  return std::any_of(scene.seen.begin(), scene.seen.end(), [&](const GrownShape& s) {
    return !std::holds_alternative<geometry::Segment>(s.shape) && rational_meets(s, v, scene.time_horizon);
  });
}

struct Judged {
  std::size_t unsafe = 0, plain_unsafe = 0, stopped = 0, apart = 0;
};

Judged judge(const std::vector<Scene>& scenes) {
  Judged judged;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Vec2 ours = proven_velocity(scenes[i]), theirs = plain_velocity(scenes[i]);
    judged.unsafe += collides(scenes[i], ours) || (i % kInRationals == 0 && collides_in_rationals(scenes[i], ours));
    judged.plain_unsafe += collides(scenes[i], theirs);
    judged.stopped += ours == Vec2{};
    judged.apart += norm(ours - theirs) > kSame;
  }
  return judged;
}

void proven_decision(benchmark::State& state, Surroundings surroundings) {
  const std::vector<Scene> scenes = random_scenes(surroundings, kScenes, 12);
  const Judged judged = judge(scenes);
  if (judged.unsafe > 0) return state.SkipWithError("a proven velocity collides");
  if (static_cast<double>(judged.apart) > kMostApart * kScenes) return state.SkipWithError("the decisions differ");
  report_ratio(state, scenes, proven_velocity, proven_velocity, plain_velocity, kRounds);
  const auto share = [](std::size_t count) { return static_cast<double>(count) / kScenes; };
  state.counters["unsafe"] = static_cast<double>(judged.unsafe);
  state.counters["plain_unsafe_share"] = share(judged.plain_unsafe);
  state.counters["stopped_share"] = share(judged.stopped);
  state.counters["apart_share"] = share(judged.apart);
}
BENCHMARK_CAPTURE(proven_decision, discs, Surroundings::discs);
BENCHMARK_CAPTURE(proven_decision, mixed, Surroundings::mixed);

}  // namespace
}  // namespace exactvo::bench
