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
namespace {

/// What a step adds to the unknown angle: rounding K w + m conj(w), for K >= 2 |m|.
constexpr double kNewDoubt = 0x1p-46;
/// What (2) leaves out at kMostDoubt, and rounding.
constexpr double kSecondOrder = 1.0 + 0x1p-21;

/// atan(t) / t for t^2 = s <= 1/3, up to 2^-25 of it: the seventh convergent of Gauss's continued fraction, 1 / (1 + s
/// / (3 + 4 s / (5 + 9 s / (7 + ...)))). No call of a library: the same bits everywhere.
double arc_of(double s) {
  const double above = 135135.0 + s * (173250.0 + s * (53487.0 + s * 2304.0));
  const double below = 135135.0 + s * (218295.0 + s * (99225.0 + s * 11025.0));
  return above / below;
}

/// The heading of a half-heading, of unit length.
Vec2 ahead_of(double a, double b) {
  const double shorter = 1.0 / (a * a + b * b);
  return {(a * a - b * b) * shorter, 2.0 * a * b * shorter};
}

}  // namespace

struct Wheels::Twist {
  double left, right;   ///< ways of the wheels, lattice steps
  double room, growth;  ///< what is unknown of the heading grows by growth / room
};

Wheels::Twist Wheels::twist_of(const Limits& limits, const WheelState& from, Motion m) {
  const double mx = m.x, my = m.y, ex = from.ahead.x, ey = from.ahead.y;
  const double x = mx * ex + my * ey, y = my * ex - mx * ey, ahead = limits.ahead + x;
  const double t = y / ahead, arc = arc_of(t * t), middle = x + y * t, across = limits.across * t;
  return {(middle - across) * arc, (middle + across) * arc, ahead * ahead + y * y,
          limits.ahead * limits.ahead - (mx * mx + my * my)};
}

bool Wheels::is_driven(const Limits& limits, const WheelState& from, Motion m) {
  const Twist twist = twist_of(limits, from, m);
  return std::fabs(twist.left) <= limits.most && std::fabs(twist.right) <= limits.most &&
         std::fabs(twist.left - from.left) <= limits.change && std::fabs(twist.right - from.right) <= limits.change &&
         std::fabs(twist.right - twist.left) <= limits.turn &&
         twist.left + twist.right >= limits.open - 2.0 * limits.back &&
         from.doubt * twist.growth * kSecondOrder <= (kMostDoubt - kNewDoubt) * twist.room;
}

void Wheels::drive(std::size_t kind, std::int32_t id, Motion m) {
  WheelState& s = states_[static_cast<std::size_t>(id)];
  if (m == Motion{}) {
    s.left = s.right = 0.0;  // and it heads exactly where it did
    return;
  }
  const Twist twist = twist_of(limits_[kind], s, m);
  const double k = limits_[kind].ahead, a = (k + m.x) * s.a + m.y * s.b, b = (k - m.x) * s.b + m.y * s.a;
  const double longer = 1.0 / std::sqrt(a * a + b * b), doubt = s.doubt * twist.growth * kSecondOrder / twist.room;
  s = {longer * a, longer * b, {}, std::min(doubt + kNewDoubt, kMostDoubt), twist.left, twist.right};
  s.ahead = ahead_of(s.a, s.b);
}

std::size_t Wheels::rows(std::size_t kind, std::int32_t id, geometry::HalfPlane* out) const {
  if (!has(kind)) return 0;
  const Vec2 e = state(id).ahead, left{-e.y, e.x};
  std::size_t count = 0;
  for (const geometry::HalfPlane& h : limits_[kind].polygon)
    out[count++] = {h.normal.x * e + h.normal.y * left, h.offset};
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
  has_some_ = false;
  most_rows_ = 0;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (!kinds[k].wheels) continue;
    const CrowdWheels& wheels = *kinds[k].wheels;
    const double fastest = kinds[k].max_speed;
    Limits& limits = limits_[k];
    has_some_ = true;
    limits.ahead = 2.0 * wheels.reference / q;
    limits.across = wheels.wheel_separation / q;
    limits.most = kSpare * fastest * per_speed;
    limits.change = kSpare * wheels.max_wheel_acceleration * options.time_step * per_speed;
    limits.turn = limits.across * (kSpare * wheels.max_angular_speed * options.time_step - 4.0 * kMostDoubt);
    limits.back = wheels.max_backward_speed * per_speed;
    limits.open = (1.0 - kSpare) * fastest * per_speed;
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
      limits.polygon.push_back({inward, geometry::dot(inward, from)});
    }
    if (wheels.max_backward_speed < side) limits.polygon.push_back({{1.0, 0.0}, -wheels.max_backward_speed});
    most_rows_ = std::max(most_rows_, limits.polygon.size());
  }
}

}  // namespace crowd
}  // namespace exactvo::formation
