// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/speed_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/geometry/require.h"
#include "motion/speed_stretches.h"

namespace exactvo::formation {
namespace {

using detail::for_each_stretch;
using Stretch = detail::SpeedStretch;

constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

double length_of(const std::vector<Vec2>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += norm(path[i] - path[i - 1]);
  return length;
}

std::vector<SpeedKnot> trapezoid(const std::vector<Vec2>& path, double speed, double acceleration) {
  EXACTVO_REQUIRE(speed > 0.0 && acceleration > 0.0, std::to_string(speed) + ", " + std::to_string(acceleration));
  const double length = length_of(path);
  const double top = std::min(speed, std::sqrt(length * acceleration));
  if (!(top > 0.0)) return {{0.0, 0.0}};
  const double ramp = top / acceleration;
  const double cruise = std::max(0.0, (length - top * ramp) / top);
  return {{0.0, 0.0}, {ramp, top}, {ramp + cruise, top}, {2.0 * ramp + cruise, 0.0}};
}

std::vector<SpeedKnot> speed_of_legs(const std::vector<Vec2>& path, const std::vector<double>& speeds) {
  EXACTVO_REQUIRE(speeds.size() + 1 == path.size(), std::to_string(speeds.size()) + " speeds");
  std::vector<SpeedKnot> knots;
  double time = 0.0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    EXACTVO_REQUIRE(speeds[i] > 0.0, std::to_string(speeds[i]));
    knots.push_back({time, speeds[i]});
    time += norm(path[i + 1] - path[i]) / speeds[i];
    knots.push_back({time, speeds[i]});
  }
  return knots;
}

double speed_at(const std::vector<SpeedKnot>& profile, double time) {
  double speed = profile.front().speed;
  for_each_stretch(profile, [&](const Stretch& s) {
    if (time < s.start) return true;
    speed = s.speed + s.rate * std::min(time - s.start, s.duration);
    return false;
  });
  return speed;
}

double distance_at(const std::vector<SpeedKnot>& profile, double time) {
  double distance = 0.0;
  for_each_stretch(profile, [&](const Stretch& s) {
    if (time <= s.start) return true;
    distance += s.distance(std::min(time - s.start, s.duration));
    return false;
  });
  return distance;
}

double time_to_cover(const std::vector<SpeedKnot>& profile, double distance) {
  double left = distance;
  double answer = distance > 0.0 ? kForever : 0.0;
  for_each_stretch(profile, [&](const Stretch& s) {
    if (!(left > 0.0)) return true;
    const double covered = std::isfinite(s.duration) ? s.distance(s.duration) : (s.speed > 0.0 ? kForever : 0.0);
    if (covered < left) {
      left -= covered;
      return false;
    }
    const double root = std::sqrt(std::max(0.0, s.speed * s.speed + 2.0 * s.rate * left));
    answer = s.start + 2.0 * left / (s.speed + root);
    return true;
  });
  return answer;
}

}  // namespace exactvo::formation
