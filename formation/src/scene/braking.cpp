// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/braking.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/rounding.h"
#include "scene/static_field.h"

namespace exactvo::formation::detail {
namespace {

using geometry::HalfPlane;

/// Share of a limit that is left to roundings.
constexpr double kAimedAt = 1.0 - 1e-12;
/// Halvings of the skin: at most 2^-30 m of it are lost where it is used up.
constexpr int kHalvings = 30;

/// Beyond the rounding of the product.
bool surely_satisfies(const HalfPlane& h, Vec2 v) {
  constexpr double kRoundings = 4 * 0x1p-53;
  return dot(h.normal, v) - h.offset >= kRoundings * (geometry::dot_magnitude(h.normal, v) + std::fabs(h.offset));
}

/// What `make` makes of the largest room from `least` (m) up to the skin for which it `holds`; with the least where
/// none does.
template <class Make, class Holds>
auto with_room_left(const Make& make, const Holds& holds, double least = 0.0) {
  auto made = make(kContactSkin);
  if (holds(made)) return made;
  made = make(least);
  double most = kContactSkin;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (least + most);
    auto better = make(middle);
    if (!holds(better)) {
      most = middle;
      continue;
    }
    made = better;
    least = middle;
  }
  return made;
}

}  // namespace

void add_acceleration_limits(const DecisionRules& rules, Vec2 velocity, std::vector<HalfPlane>& out) {
  if (!(rules.acceleration < geometry::kInfinity)) return;
  constexpr double kSide = 2.0 * geometry::kPi / kSidesOfLimit;
  const double reach = kAimedAt * rules.acceleration * rules.time_step * std::cos(0.5 * kSide);
  const double braking = velocity == Vec2{} ? 0.0 : std::atan2(-velocity.y, -velocity.x);
  for (int k = 0; k < kSidesOfLimit; ++k) {
    const double angle = braking + (k + 0.5) * kSide;
    const Vec2 inward{-std::cos(angle), -std::sin(angle)};
    out.push_back({inward, dot(inward, velocity) - reach});
  }
}

vo::ProvenHalfPlane braking_half_plane(geometry::GrownShape& seen, const vo::VelocityObstacle::Nearest& nearest,
                                       Vec2 braked, double braking_time) {
  vo::ClearancePolicy policy;
  policy.time_horizon = braking_time;
  return with_room_left(
      [&](double room) {
        policy.room = room;
        return vo::half_plane_against(seen, nearest, braked, policy);
      },
      [&](const vo::ProvenHalfPlane& made) {
        return made.proof != vo::Proof::none && surely_satisfies(made.half_plane, braked);
      });
}

vo::ProvenHalfPlane mover_half_plane(double time_step, Vec2 position, Vec2 velocity, const Mover& mover) {
  const double tau = way_time(time_step, mover.steps);
  const double reached = mover.speed * static_cast<double>(mover.steps) * time_step;
  const Vec2 apart = position - mover.disc.center, end = apart + tau * velocity;
  // More than places, their ways and all that follows are off by. Each step of braking rounds again, and asks for less.
  constexpr double kRounding = 0x1p-45, kOfStep = 0x1p-48;
  const double share = kRounding + kOfStep * static_cast<double>(mover.steps);
  const double off = share * (std::fabs(position.x) + std::fabs(position.y) + std::fabs(mover.disc.center.x) +
                              std::fabs(mover.disc.center.y) + mover.disc.radius + reached + tau * norm(velocity));
  const auto make = [&](double room) {
    const double from = norm(apart), kept = mover.disc.radius + room;
    vo::ProvenHalfPlane made{{{1.0, 0.0}, 0.0}, vo::Proof::none};
    if (!(from > kept)) return made;
    const double most = std::acos(kept / from);
    const double turn = std::clamp(std::atan2(cross(apart, end), dot(apart, end)), -most, most);
    const Vec2 along = apart / from, n = std::cos(turn) * along + std::sin(turn) * Vec2{-along.y, along.x};
    made.half_plane = {n, (kept + reached - dot(n, apart)) / tau};
    if (dot(n, apart) >= mover.disc.radius + off && room >= off) made.proof = vo::Proof::alone;
    return made;
  };
  const auto holds = [&](const vo::ProvenHalfPlane& made) {
    return made.proof != vo::Proof::none && surely_satisfies(made.half_plane, velocity);
  };
  const vo::ProvenHalfPlane made = with_room_left(make, holds, off);
  return holds(made) ? made : make(kContactSkin);
}

vo::ReciprocalHalfPlanes braking_half_planes(const vo::MovingDisc& a, const vo::MovingDisc& b, double braking_time) {
  vo::ReciprocalOptions options;
  options.time_horizon = options.contact_time = braking_time;
  return with_room_left(
      [&](double room) {
        options.margin = room;
        return vo::reciprocal_half_planes(a, b, options);
      },
      [&](const vo::ReciprocalHalfPlanes& made) {
        return made.certified && surely_satisfies(made.a, a.velocity) && surely_satisfies(made.b, b.velocity);
      });
}

}  // namespace exactvo::formation::detail
