// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/wheels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/pi.h"

namespace exactvo::formation {

// No call of a library: the same bits everywhere.
Vec2 half_heading_of(double degrees) {
  constexpr Vec2 kEighths[] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}};
  const double half = std::remainder(0.5 * degrees, 360.0), eighth = std::nearbyint(half / 45.0);
  const double rest = (half - 45.0 * eighth) * (geometry::kPi / 180.0), s = rest * rest;  // at most 22.5 degrees
  double cosine = 1.0, sine = 1.0;  // by their series, the latter without its factor
  for (int k = 16; k > 0; k -= 2) {
    cosine = 1.0 - s / (k * (k - 1)) * cosine;
    sine = 1.0 - s / (k * (k + 1)) * sine;
  }
  sine *= rest;
  const Vec2 e = kEighths[static_cast<int>(eighth) + 4];
  return {e.x * cosine - e.y * sine, e.x * sine + e.y * cosine};
}

namespace crowd {

bool Wheels::is_driven(const WheelLimits& limits, const WheelState& from, Motion m) {
  TwistLanes lanes;
  lanes.put(0, limits, from, m.x, m.y);
  return drivable(lanes, 1) == 1;
}

/// Lanes without a robot, or one without wheels, stand.
void Wheels::put_lanes(const Robots& robots, std::size_t first, std::size_t count, const std::int32_t* mx,
                       const std::int32_t* my, TwistLanes& lanes) const {
  for (std::size_t lane = 0; lane < kPack; ++lane) {
    const std::size_t kind = lane < count ? robots.kind(first + lane) : 0;
    if (lane < count && has(kind))
      lanes.put(lane, limits_[kind], state(robots.id[first + lane]), mx[lane], my[lane]);
    else
      lanes.put(lane, {}, {}, 0.0, 0.0);
  }
}

std::uint32_t Wheels::allow(const Robots& robots, std::size_t first, std::size_t count, const std::int32_t* mx,
                            const std::int32_t* my) const {
  TwistLanes lanes;
  put_lanes(robots, first, count, mx, my, lanes);
  return drivable(lanes, kPack);
}

void Wheels::drive(const Robots& robots, std::size_t first, std::size_t last) {
  TwistLanes lanes;
  for (; first < last; first += kPack) {
    const std::size_t count = std::min(kPack, last - first);
    fetch(robots, first + kPack, first + 2 * kPack);
    put_lanes(robots, first, count, &robots.next_mx[first], &robots.next_my[first], lanes);
    crowd::drive(lanes, count);
    for (std::size_t lane = 0; lane < count; ++lane)
      if (has(robots.kind(first + lane)))
        states_[static_cast<std::size_t>(robots.id[first + lane])] = lanes.taken(lane);
  }
}

std::size_t Wheels::rows(std::size_t kind, std::int32_t id, geometry::HalfPlane* out) const {
  if (!has(kind)) return 0;
  const Vec2 e = state(id).ahead, left{-e.y, e.x};
  std::size_t count = 0;
  for (const geometry::HalfPlane& h : polygons_[kind]) out[count++] = {h.normal.x * e + h.normal.y * left, h.offset};
  return count;
}

void Wheels::put(std::int32_t id, Vec2 half_heading) {
  const auto at = static_cast<std::size_t>(id);
  if (at >= states_.size()) states_.resize(at + 1);
  const double a = half_heading.x, b = half_heading.y;
  states_[at] = {a, b, ahead_of(a, b), 0.0, 0.0, 0.0};
}

bool Wheels::set_states(std::vector<WheelState> states) {
  for (WheelState& s : states) {
    const double size = s.a * s.a + s.b * s.b;
    if (!(size > 0.5 && size < 4.0 && s.doubt >= 0.0 && s.doubt <= kMostDoubt && std::fabs(s.left) <= kLongestMotion &&
          std::fabs(s.right) <= kLongestMotion))
      return false;
    s.ahead = ahead_of(s.a, s.b);
  }
  states_ = std::move(states);
  return true;
}

void Wheels::take_kinds(const std::vector<CrowdKind>& kinds, const CrowdOptions& options) {
  const double q = options.position_step, per_speed = options.time_step / q;
  limits_.assign(kinds.size(), {});
  polygons_.assign(kinds.size(), {});
  has_some_ = false;
  most_rows_ = 0;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (!kinds[k].wheels) continue;
    const CrowdWheels& wheels = *kinds[k].wheels;
    const double fastest = kinds[k].max_speed;
    WheelLimits& limits = limits_[k];
    std::vector<geometry::HalfPlane>& polygon = polygons_[k];
    has_some_ = true;
    limits.ahead = 2.0 * wheels.reference / q;
    limits.across = wheels.wheel_separation / q;
    limits.most = kSpare * fastest * per_speed;
    limits.change = kSpare * wheels.max_wheel_acceleration * options.time_step * per_speed;
    limits.turn = limits.across * (kSpare * wheels.max_angular_speed * options.time_step - 4.0 * kMostDoubt);
    limits.back = (1.0 - kSpare) * fastest * per_speed - 2.0 * (wheels.max_backward_speed * per_speed);
    // Theorem 1, for twists: their ways are longer than chords.
    const double sine = fastest * options.time_step / (2.0 * wheels.reference), squared = 1.0 - sine * sine;
    const double longer = arc_of(sine * sine / squared) / std::sqrt(squared);  // asin(sine) / sine
    const double beta = wheels.wheel_separation / (2.0 * wheels.reference);
    const double apex = kSpare * fastest / longer;
    const double side =
        std::min(fastest / std::sqrt(1.0 + beta * beta), wheels.reference * wheels.max_angular_speed) / longer * kSpare;
    const double cosine = std::min(1.0, side / apex), half = std::sqrt((1.0 - cosine) / (1.0 + cosine));
    const double touches = 2.0 * half * arc_of(half * half), arc = 2.0 * (geometry::kPi - touches);  // acos, nearly
    std::vector<Vec2> corners{{apex, 0.0}};
    for (std::size_t c = 0; c <= kChordsOfWheels; ++c) {
      const double angle = touches + arc * static_cast<double>(c) / static_cast<double>(kChordsOfWheels);
      corners.push_back(side * geometry::normalized(half_heading_of(angle * (360.0 / geometry::kPi))));
    }
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Vec2 from = corners[c], along = corners[(c + 1) % corners.size()] - from;
      if (!(geometry::norm(along) > 0x1p-20 * apex)) continue;
      const Vec2 inward = geometry::normalized(Vec2{-along.y, along.x});
      polygon.push_back({inward, geometry::dot(inward, from)});
    }
    if (wheels.max_backward_speed < side) polygon.push_back({{1.0, 0.0}, -wheels.max_backward_speed});
    most_rows_ = std::max(most_rows_, polygon.size());
  }
}

}  // namespace crowd
}  // namespace exactvo::formation
