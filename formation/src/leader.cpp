// SPDX-License-Identifier: GPL-3.0-or-later
#include "leader.h"

#include <limits>

namespace exactvo::formation::detail {
namespace {

double length_of(const Leader& leader) {
  double length = 0.0;
  for (std::size_t i = 1; i < leader.path.size(); ++i) length += norm(leader.path[i] - leader.path[i - 1]);
  return length;
}

}  // namespace

LeaderState leader_at(const Leader& leader, double time) {
  double left = leader.speed * time;
  for (std::size_t i = 1; i < leader.path.size(); ++i) {
    const Vec2 leg = leader.path[i] - leader.path[i - 1];
    const double length = norm(leg);
    if (left < length) {
      const Vec2 direction = leg / length;
      return {leader.path[i - 1] + left * direction, leader.speed * direction};
    }
    left -= length;
  }
  return {leader.path.back(), {}};
}

double leader_arrival(const Leader& leader) {
  const double length = length_of(leader);
  if (!(length > 0.0)) return 0.0;
  return leader.speed > 0.0 ? length / leader.speed : std::numeric_limits<double>::infinity();
}

}  // namespace exactvo::formation::detail
