// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision/own_side.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "scene/static_field.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;
using geometry::Segment;

/// rad: parts of a cone are no wider. A line loses 1 - cos of half of it, 3 %, of what the robot may use.
constexpr double kWidestPart = 0.5;
static_assert(24 >= 13 + 3 + 3);  // parts of a turn, one more in each of three pieces, and the last ends
/// rad: more than angles of a cone are off by.
constexpr double kBeyond = 1e-9;

/// From the nearest point of `other` to that of `own`; 0 where they cross.
Vec2 shortest_between(const Segment& own, const Segment& other) {
  Vec2 shortest = own.a - nearest_on(other.a, other.b, own.a);
  for (const Vec2 between : {own.b - nearest_on(other.a, other.b, own.b), nearest_on(own.a, own.b, other.a) - other.a,
                             nearest_on(own.a, own.b, other.b) - other.b})
    if (norm(between) < norm(shortest)) shortest = between;
  return geometry::distance(own, other) > 0.0 ? shortest : Vec2{};
}

}  // namespace

ForeseenWay foreseen_way(const DecisionRules& rules, const Measurements& bounds, Vec2 position, Vec2 velocity,
                         double age) {
  constexpr double kRounding = 1.0 + 1e-9;
  const double off_speed = bounds.velocity + (age > 0.0 ? age * rules.acceleration : 0.0);
  const Vec2 now = position + age * velocity;
  return {{now, now + (rules.braking_time - rules.time_step) * velocity},
          kRounding * (bounds.position + (age + rules.braking_time) * off_speed)};
}

OwnSide::OwnSide(const DecisionRules& rules, Vec2 position, Vec2 velocity, const ForeseenWay& other, double radii) {
  const Vec2 braked = rules.braked(velocity);
  const Segment own{position, position + rules.braking_time * braked};
  const Vec2 between = shortest_between(own, other.way);
  const double apart = norm(between), least = apart - other.off;
  const bool is_known = least > 0.0;  // on which side it is
  const double mine = std::max(0.0, 0.5 * (least - radii - kContactSkin));
  const double room = std::max(kRoomOfLines, kRoomOfWays * norm(own.b - own.a));
  const double half = is_known
                          ? std::min(geometry::kPi, std::acos(std::min(1.0, least / (apart + other.off))) + kBeyond)
                          : geometry::kPi;
  const double middle = between == Vec2{} ? 0.0 : std::atan2(between.y, between.x);
  // Ends of the pieces of the cone in which the minimum over its own way is at one end.
  std::array<double, 4> ends{middle - half};
  std::size_t count = 1;
  if (!(braked == Vec2{})) {
    const double across = std::atan2(braked.y, braked.x) + 0.5 * geometry::kPi - middle;
    const double left = std::remainder(across, 2.0 * geometry::kPi);
    const double right = std::remainder(across + geometry::kPi, 2.0 * geometry::kPi);
    for (const double from_middle : {std::min(left, right), std::max(left, right)})
      if (std::fabs(from_middle) < half) ends[count++] = middle + from_middle;
  }
  ends[count++] = middle + half;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double width = ends[k + 1] - ends[k];
    const int parts = std::max(1, static_cast<int>(std::ceil(width / kWidestPart)));
    const double usable = mine * std::cos(0.5 * width / parts);
    for (int p = 0; p <= parts; ++p) {
      const double angle = ends[k] + width * p / parts;
      const Vec2 n{std::cos(angle), std::sin(angle)};
      lines_[count_++] = {n, std::min(0.0, dot(n, braked)) - (usable + room) / rules.braking_time};
    }
  }
}

}  // namespace exactvo::formation::detail
