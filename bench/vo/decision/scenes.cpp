// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/scenes.h"

namespace exactvo::bench {
namespace {

using geometry::Vec2;

constexpr double kMaxSpeed = 2.0;  // m/s

Obstacle kind_of(Surroundings surroundings, std::size_t k) {
  constexpr std::array<Obstacle, kSeen> kMixed = {
      Obstacle::disc,    Obstacle::ellipse, Obstacle::polygon8, Obstacle::disc,      Obstacle::segment,
      Obstacle::ellipse, Obstacle::disc,    Obstacle::polygon8, Obstacle::polygon16, Obstacle::ellipse};
  return surroundings == Surroundings::discs ? Obstacle::disc : kMixed[k];
}

Scene random_scene(Stream& random, Surroundings surroundings) {
  Scene scene;
  const Vec2 origin{random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)};
  const double radius = random.uniform(0.2, 0.6);
  for (std::size_t k = 0; k < kSeen; ++k) {
    const double gap = random.uniform(0.05, 8.0);
    const Vec2 centre = origin + (1.0 + radius + gap) * random.direction();
    scene.seen[k] = {random_shape(random, kind_of(surroundings, k), centre), origin, radius};
  }
  scene.time_horizon = random.uniform(0.5, 4.0);
  scene.max_speed = kMaxSpeed;
  const Vec2 heading = random.direction();
  scene.velocity = random.uniform(0.0, kMaxSpeed) * heading;
  const double turn = random.uniform(-0.6, 0.6);
  scene.preferred = random.uniform(0.5 * kMaxSpeed, kMaxSpeed) * geometry::rotated(heading, turn);
  return scene;
}

}  // namespace

std::vector<Scene> random_scenes(Surroundings surroundings, std::size_t count, std::uint64_t seed) {
  Stream random(seed);
  std::vector<Scene> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(random_scene(random, surroundings));
  return out;
}

}  // namespace exactvo::bench
