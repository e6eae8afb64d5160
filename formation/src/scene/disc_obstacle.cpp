// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/disc_obstacle.h"

#include <utility>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/round_polygon.h"

namespace exactvo::formation {
namespace {

double signed_distance_to(const geometry::Obstacle& shape, const std::optional<geometry::Disc>& disc, Vec2 x) {
  return disc ? norm(x - disc->center) - disc->radius : geometry::signed_distance(shape, x);
}

Core core(const geometry::Obstacle& shape, const std::optional<geometry::Disc>& disc) {
  if (!disc) return {shape, 0.0};
  return {geometry::Polyline{{disc->center, disc->center}}, disc->radius};
}

}  // namespace

SceneObstacle disc_obstacle(std::string id, const geometry::Disc& disc) {
  return {std::move(id), geometry::polygon_round(disc), disc};
}

MovingObstacle moving_disc(std::string id, const geometry::Disc& disc, TimedPath motion) {
  return {std::move(id), geometry::polygon_round(disc), std::move(motion), disc};
}

double signed_distance(const SceneObstacle& obstacle, Vec2 x) {
  return signed_distance_to(obstacle.shape, obstacle.disc, x);
}

double signed_distance(const MovingObstacle& obstacle, Vec2 x) {
  return signed_distance_to(obstacle.shape, obstacle.disc, x);
}

Core core_of(const SceneObstacle& obstacle) {
  return core(obstacle.shape, obstacle.disc);
}

Core core_of(const MovingObstacle& obstacle) {
  return core(obstacle.shape, obstacle.disc);
}

TimedPath path_of(Vec2 start, const std::vector<TimedVelocity>& velocities, double end) {
  constexpr double kBeyond = 1.0 + 1e-6;  // of the end: the path's end is not reached by then
  TimedPath motion{{start}};
  if (velocities.empty()) return motion;
  if (velocities.front().time > 0.0) motion.profile.push_back({0.0, 0.0});
  for (std::size_t k = 0; k < velocities.size() && velocities[k].time < end; ++k) {
    const bool is_last = k + 1 == velocities.size() || !(velocities[k + 1].time < end);
    const double until = is_last ? kBeyond * end : velocities[k + 1].time;
    const double speed = norm(velocities[k].velocity), lasts = until - velocities[k].time;
    if (!motion.profile.empty()) motion.profile.push_back({velocities[k].time, motion.profile.back().speed});
    motion.profile.push_back({velocities[k].time, speed});
    if (speed > 0.0 && lasts > 0.0) motion.path.push_back(motion.path.back() + lasts * velocities[k].velocity);
  }
  const bool is_one_speed = motion.profile.size() == 1;  // from the start on
  if (is_one_speed) {
    motion.speed = motion.profile.front().speed;
    motion.profile.clear();
  }
  return motion;
}

}  // namespace exactvo::formation
