// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/leader.h"

#include <algorithm>
#include <limits>

#include "exactvo/formation/speed_profile.h"

namespace exactvo::formation::detail {
namespace {

/// Share of the path: a profile that covers all but this covers it; sums over knots round by less.
constexpr double kWholePath = 1e-12;

/// Share of a time that roundings of products and sums explain.
constexpr double kSameTime = 0x1p-48;

/// Whether the speed jumps from time `from` to time `to` (s): two knots are there.
bool jumps_within(const std::vector<SpeedKnot>& profile, double from, double to) {
  const auto first =
      std::partition_point(profile.begin(), profile.end(), [&](const SpeedKnot& knot) { return knot.time < from; });
  return profile.end() - first > 1 && (first + 1)->time <= to;
}

/// `covered` along the path, m, at `speed`.
LeaderState on_path(const TimedPath& leader, double covered, double speed) {
  for (std::size_t i = 1; i < leader.path.size(); ++i) {
    const Vec2 leg = leader.path[i] - leader.path[i - 1];
    const double length = norm(leg);
    if (covered < length) {
      const Vec2 direction = leg / length;
      return {leader.path[i - 1] + covered * direction, speed * direction};
    }
    covered -= length;
  }
  return {leader.path.back(), {}};
}

}  // namespace

LeaderState leader_at(const TimedPath& leader, double time) {
  if (leader.profile.empty()) return on_path(leader, leader.speed * time, leader.speed);
  if (time >= leader_arrival(leader)) return {leader.path.back(), {}};
  const double covered = distance_at(leader.profile, time);
  // Where a leg and a speed begin together, no rounding of the time or of the way lets one come before the other.
  const double soon = time * (1.0 + kSameTime);
  if (!jumps_within(leader.profile, time * (1.0 - kSameTime), soon))
    return on_path(leader, covered, speed_at(leader.profile, time));
  const double further = distance_at(leader.profile, soon) + kWholePath * length_of(leader.path);
  return {on_path(leader, covered, 0.0).position, on_path(leader, further, speed_at(leader.profile, soon)).velocity};
}

double leader_arrival(const TimedPath& leader) {
  const double length = length_of(leader.path);
  if (!(length > 0.0)) return 0.0;
  if (!leader.profile.empty()) return time_to_cover(leader.profile, length * (1.0 - kWholePath));
  return leader.speed > 0.0 ? length / leader.speed : std::numeric_limits<double>::infinity();
}

double rests_from(const TimedPath& leader) {
  const double arrival = leader_arrival(leader);
  if (leader.profile.empty()) return leader.speed > 0.0 ? arrival : 0.0;
  return leader.profile.back().speed > 0.0 ? arrival : std::min(arrival, leader.profile.back().time);
}

}  // namespace exactvo::formation::detail
