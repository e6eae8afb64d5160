// SPDX-License-Identifier: GPL-3.0-or-later
// A thousand robots, each to a place of its own choice: none of those that are kept touches another.
#include <cmath>
#include <cstdio>
#include <vector>

#include "exactvo/formation/crowd.h"

using namespace exactvo;
using geometry::Vec2;

int main() {
  formation::Crowd crowd;
  crowd.add_kind({0.5, 1.5, 5.0, 15.0, 10});  // radius, max_speed, time_horizon, neighbour_distance, neighbours
  std::vector<Vec2> goals;
  for (int k = 0; k < 1000; ++k) {
    crowd.add_robot({2.5 * (k % 32), 2.5 * (k / 32)});
    goals.push_back({2.5 * ((k * 7) % 32), 2.5 * ((k * 11) % 32)});
  }
  crowd.set_steering([&](formation::CrowdSlice& slice) {
    for (std::size_t k = 0; k < slice.size(); ++k) {
      const Vec2 way = goals[slice.id(k)] - slice.position(k);
      slice.prefer(k, way * (1.2 / std::fmax(1.0, geometry::norm(way))));
    }
  });

  std::vector<std::uint8_t> kept;
  std::vector<Vec2> from, to;
  std::size_t steps_kept = 0, touching = 0;
  for (int step = 0; step < 100; ++step) {
    crowd.positions(from);
    crowd.step();
    crowd.positions(to);
    crowd.kept(kept);
    for (std::size_t a = 0; a < goals.size(); ++a) {
      steps_kept += kept[a];
      for (std::size_t b = 0; b < a; ++b) {
        const bool were_apart = geometry::norm(from[a] - from[b]) > 1.0 + 1e-5;
        touching += kept[a] && kept[b] && were_apart && geometry::squared_norm(to[a] - to[b]) <= 1.0;
      }
    }
  }
  std::printf("%zu of 100000 robot steps kept, %zu kept pairs touch\n", steps_kept, touching);
  return touching == 0 && steps_kept > 50000 ? 0 : 1;
}
