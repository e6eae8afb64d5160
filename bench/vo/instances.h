// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Instances for the questions of this folder: an obstacle seen by a robot, a horizon and a velocity. Many and
/// distinct, since a branch predictor learns a small set. The same on every machine.

#include <cstdint>
#include <vector>

#include "exactvo/geometry/support.h"

namespace exactvo::bench {

enum class Obstacle { disc, ellipse, polygon8, polygon16, segment };

struct Instance {
  geometry::GrownShape s;
  double time_horizon;
  geometry::Vec2 velocity;
};

/// SplitMix64: number k of stream `seed` is the same everywhere.
class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high);
  geometry::Vec2 direction();

 private:
  std::uint64_t state_;
};

/// About 1 m wide; reaches at most 1 m from `centre`.
geometry::ConvexShape random_shape(Stream& random, Obstacle kind, geometry::Vec2 centre);

/// Obstacles of about 1 m, 0.05 m to 5 m from the robot's rim, velocities up to 2 m/s, half of them aimed within 0.6
/// rad of the obstacle, half in any direction: legs, cut-offs, inside and outside all occur.
Instance random_instance(Stream& random, Obstacle kind);
std::vector<Instance> random_instances(Obstacle kind, std::size_t count, std::uint64_t seed);

}  // namespace exactvo::bench
