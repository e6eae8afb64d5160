// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far places of a roadmap are from a robot's goal: what a joint search is guided by. Searches stay complete
/// whatever they are guided by.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "liveness/roadmap.h"

namespace exactvo::formation::detail {

inline constexpr float kFarAway = std::numeric_limits<float>::infinity();

/// m: from every place to the goal along ways that have room for the radius (Dijkstra). `cost`: m, of the way from a
/// place to another.
template <class Cost>
std::vector<float> distances_to(const Roadmap& map, PlaceNumber goal, double radius, const Cost& cost) {
  std::vector<float> distance(map.size(), kFarAway);
  using Entry = std::pair<float, PlaceNumber>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> open;
  distance[goal] = 0.0f;
  open.push({0.0f, goal});
  while (!open.empty()) {
    const auto [so_far, at] = open.top();
    open.pop();
    if (so_far > distance[at]) continue;
    for (const PlaceNumber next : map.ways(at)) {
      const float all = so_far + static_cast<float>(cost(next, at));
      if (!(all < distance[next]) || map.room(next) < radius) continue;
      distance[next] = all;
      open.push({all, next});
    }
  }
  return distance;
}

inline double length_of_way(const Roadmap& map, PlaceNumber a, PlaceNumber b) {
  return norm(map.place(a) - map.place(b));
}

/// Which way robots go through places. To go against them costs more, so that those who come the other way take another
/// lane (after Chen, Harabor, Li and Stuckey, "Traffic Flow Optimisation for Lifelong Multi-Agent Path Finding", AAAI
/// 2024, whose contraflow is counted on edges of a grid).
class Traffic {
 public:
  explicit Traffic(const Roadmap& map) : map_(map), flow_(map.size()) {}

  /// `sign`: 1 adds a robot's way, -1 takes it out again.
  void add(const std::vector<PlaceNumber>& way, double sign) {
    for (std::size_t k = 1; k < way.size(); ++k) {
      const Vec2 step = (0.5 * sign) * direction(way[k - 1], way[k]);
      flow_[way[k - 1]] += step;
      flow_[way[k]] += step;
    }
  }

  /// m: of the way from a to b. Each robot that comes the other way counts as the length of the way.
  double cost(PlaceNumber a, PlaceNumber b) const {
    const double against = -0.5 * dot(direction(a, b), flow_[a] + flow_[b]);
    return length_of_way(map_, a, b) * (1.0 + std::max(0.0, against));
  }

  /// From a place to where the distance is 0.
  std::vector<PlaceNumber> way_from(PlaceNumber at, const std::vector<float>& distance) const {
    std::vector<PlaceNumber> way{at};
    while (distance[at] > 0.0f && way.size() <= map_.size()) {
      float least = kFarAway;
      PlaceNumber best = at;
      for (const PlaceNumber to : map_.ways(at)) {
        const float all = distance[to] + static_cast<float>(cost(at, to));
        if (!(all < least) || !(distance[to] < distance[at])) continue;
        least = all;
        best = to;
      }
      if (best == at) break;
      way.push_back(at = best);
    }
    return way;
  }

 private:
  Vec2 direction(PlaceNumber a, PlaceNumber b) const {
    const Vec2 way = map_.place(b) - map_.place(a);
    return way / norm(way);
  }

  const Roadmap& map_;
  std::vector<Vec2> flow_;  ///< through each place, in robots
};

}  // namespace exactvo::formation::detail
