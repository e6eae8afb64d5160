// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Robots and moving obstacles that tests of clearances and of the audit share.

#include <string>
#include <utility>

#include "exactvo/formation/scenario.h"
#include "support/seeded_random.h"

namespace exactvo::test {

inline formation::MovingObstacle square(const std::string& id, geometry::Vec2 middle, double half,
                                        formation::TimedPath motion) {
  using geometry::Vec2;
  return {id,
          geometry::Polygon{{middle + Vec2{-half, -half}, middle + Vec2{half, -half}, middle + Vec2{half, half},
                             middle + Vec2{-half, half}},
                            {}},
          std::move(motion)};
}

inline formation::Robot robot(const std::string& id, geometry::Vec2 position, geometry::Vec2 goal) {
  formation::Robot r;
  r.id = id;
  r.position = position;
  r.goals = {goal};
  return r;
}

/// A path of random legs, some of which go back, repeat a point or are very short, at a speed or with a profile that
/// has jumps and rests.
inline formation::TimedPath random_motion(SeededRandom& random) {
  formation::TimedPath motion{{random.in_box(5)}, random.uniform(0.0, 9.0)};
  for (int legs = random.integer(0, 8); legs > 0; --legs) {
    const int kind = random.integer(0, 5);
    const geometry::Vec2 last = motion.path.back();
    motion.path.push_back(kind == 0   ? last
                          : kind == 1 ? last + random.in_box(1e-9)
                          : kind == 2 ? motion.path[motion.path.size() / 2]
                                      : random.in_box(8));
  }
  double time = 0.0;
  for (int knots = random.integer(0, 6); knots > 0; --knots) {
    time += random.integer(0, 3) == 0 ? 0.0 : random.uniform(0.0, 1.0);
    motion.profile.push_back({time, random.integer(0, 4) == 0 ? 0.0 : random.uniform(0.0, 9.0)});
  }
  return motion;
}

}  // namespace exactvo::test
