// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/constraint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cone/separation.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"

namespace exactvo::vo {
namespace {

using geometry::GrownShape;
using Nearest = VelocityObstacle::Nearest;

bool is_apart(const GrownShape& s) {
  return geometry::locate(s, Vec2{}) == geometry::Place::outside;
}

/// Away from the nearest point at the pace that restores what is missing. An offset >= 0 is safe wherever the normal
/// is.
HalfPlane parting(const Nearest& n0, double within) {
  return {n0.normal, std::fmax(-n0.distance, 0.0) / within};
}

}  // namespace

BodyTable::Number BodyTable::add(Body body) {
  EXACTVO_REQUIRE(geometry::is_valid(body.shape), geometry::excerpt(body.shape));
  Entry entry{std::move(body), {}, {}};
  entry.box = box_of(entry.body.shape);
  entry.seen.shape = entry.body.shape;
  entries_.push_back(std::move(entry));
  return entries_.size() - 1;
}

void BodyTable::move(Number body, const geometry::ConvexShape& shape, Vec2 velocity) {
  EXACTVO_REQUIRE(geometry::is_valid(shape), geometry::excerpt(shape));
  Entry& entry = entries_[body];
  entry.body.velocity = velocity;
  entry.box = box_of(shape);
  entry.seen.shape = shape;
  entry.body.shape = shape;
}

Nearest clearance_of(const GrownShape& seen) {
  return std::holds_alternative<geometry::Segment>(seen.shape) ? detail::nearest_to(detail::SeenSegment(seen), {})
                                                               : detail::nearest_to(seen, {});
}

namespace {

/// The first step of the sequence, for a robot grown already. `clearance` is that of the robot as it is.
std::optional<HalfPlane> with_margin(const GrownShape& grown, double clearance, Vec2 velocity,
                                     const ClearancePolicy& policy) {
  if (std::holds_alternative<geometry::Segment>(grown.shape)) {
    const detail::SeenSegment segment(grown);
    if (!is_surely_apart(segment, policy.room, clearance) && !is_apart(grown)) return std::nullopt;
    return detail::separating_half_plane(segment, policy.time_horizon, velocity);
  }
  if (!is_apart(grown)) return std::nullopt;
  return detail::separating_half_plane(grown, policy.time_horizon, velocity);
}

}  // namespace

ProvenHalfPlane half_plane_against(GrownShape& seen, const Nearest& nearest, Vec2 velocity,
                                   const ClearancePolicy& policy) {
  const double radius = seen.radius;
  seen.radius = radius + policy.room;
  const std::optional<HalfPlane> h = with_margin(seen, nearest.distance, velocity, policy);
  if (!h && policy.restore_within > 0.0) {
    const HalfPlane back = parting(detail::nearest_to(seen, {}), policy.restore_within);
    seen.radius = radius;
    return {back, half_plane_is_safe(seen, policy.time_horizon, back) ? Proof::alone : Proof::none};
  }
  seen.radius = radius;
  return h ? ProvenHalfPlane{*h, Proof::alone} : contact_or_push_out(seen, nearest, policy);
}

ProvenHalfPlane contact_or_push_out(const GrownShape& seen, const Nearest& nearest, const ClearancePolicy& policy) {
  if (is_apart(seen) && nearest.normal != Vec2{} &&
      sign_of_support(seen, nearest.normal, 1.0, 0.0) != geometry::Sign::positive)
    return {{nearest.normal, 0.0}, Proof::alone};
  const HalfPlane out = parting(nearest, policy.push_out_time);
  return {{out.normal, std::min(out.offset, policy.push_out_speed)}, Proof::none};
}

HalfPlane shifted_by(const HalfPlane& h, Vec2 u) {
  if (u == Vec2{}) return h;
  const double magnitude = std::fabs(h.offset) + geometry::dot_magnitude(h.normal, u);
  return {h.normal, geometry::rounded_up_sum(h.offset + dot(h.normal, u), magnitude, 4.0)};
}

}  // namespace exactvo::vo
