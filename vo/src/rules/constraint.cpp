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

void BodyTable::move(Number body, geometry::ConvexShape shape, Vec2 velocity) {
  EXACTVO_REQUIRE(geometry::is_valid(shape), geometry::excerpt(shape));
  Entry& entry = entries_[body];
  entry.body.velocity = velocity;
  entry.box = box_of(shape);
  entry.seen.shape = shape;
  entry.body.shape = std::move(shape);
}

Nearest clearance_of(const GrownShape& seen) {
  return detail::nearest_to(seen, {});
}

ProvenHalfPlane half_plane_against(GrownShape& seen, const Nearest& nearest, Vec2 velocity,
                                   const ClearancePolicy& policy) {
  const double radius = seen.radius;
  seen.radius = radius + policy.room;
  std::optional<HalfPlane> h;
  if (is_apart(seen)) h = detail::separating_half_plane(seen, policy.time_horizon, velocity);
  if (!h && policy.restore_within > 0.0) {
    h = parting(detail::nearest_to(seen, {}), policy.restore_within);
    seen.radius = radius;
    return {*h, half_plane_is_safe(seen, policy.time_horizon, *h) ? Proof::alone : Proof::none};
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
