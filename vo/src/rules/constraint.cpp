// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/constraint.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "cone/separation.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"
#include "exactvo/vo/reciprocal.h"

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

namespace {

/// The half-plane of the relative velocity, n.(v_A' - v_B') >= offset, by the static construction around b seen from a.
ProvenHalfPlane relative_half_plane(const MovingDisc& a, const MovingDisc& b, const ReciprocalOptions& options) {
  geometry::GrownShape seen{geometry::Disc{b.position, b.radius}, a.position, a.radius};
  ClearancePolicy policy;
  policy.time_horizon = options.time_horizon;
  policy.room = options.margin;
  policy.restore_within = options.contact_time;
  return half_plane_against(seen, {}, a.velocity - b.velocity, policy);
}

/// n.v + a (c - (n.v_A - n.v_B)), rounded up, where v is v_A and a the responsibility. In units of u, a product of n.v
/// passes 3 roundings where it stands first (its own, the dot's sum, the last sum) and 6 a in the brackets, which it
/// enters once more: 3 + 6 a <= 9. The product by a is exact where a is 0, 1/2 or 1, which leaves 3 + 5 a <= 8; n.v_B
/// and c pass fewer. `magnitude`: of n.v_A, n.v_B and c.
double half_offset(double responsibility, double c, Vec2 n, Vec2 own, Vec2 other, double magnitude) {
  const double at_own = dot(n, own);
  const double at_other = dot(n, other);
  const double value = at_own + responsibility * (c - (at_own - at_other));
  const bool exact_product = responsibility == 0.0 || responsibility == 0.5 || responsibility == 1.0;
  return geometry::rounded_up_sum(value, magnitude, exact_product ? 8.0 : 9.0);
}

bool comes_first(const MovingDisc& a, const MovingDisc& b) {
  return std::tie(a.position.x, a.position.y, a.velocity.x, a.velocity.y, a.radius) <
         std::tie(b.position.x, b.position.y, b.velocity.x, b.velocity.y, b.radius);
}

ReciprocalHalfPlanes ordered(const MovingDisc& a, const MovingDisc& b, const ReciprocalOptions& options) {
  const ProvenHalfPlane joint = relative_half_plane(a, b, options);
  const Vec2 n = joint.half_plane.normal;
  const double c = joint.half_plane.offset;
  const double magnitude = geometry::dot_magnitude(n, a.velocity) + geometry::dot_magnitude(n, b.velocity) +
                           geometry::product_magnitude(1.0, c);
  const double c_a = half_offset(options.responsibility_of_a, c, n, a.velocity, b.velocity, magnitude);
  const double c_b = half_offset(1.0 - options.responsibility_of_a, c, -n, b.velocity, a.velocity, magnitude);
  return {{n, c_a}, {-n, c_b}, joint.proof == Proof::alone};
}

}  // namespace

ReciprocalHalfPlanes reciprocal_half_planes(const MovingDisc& a, const MovingDisc& b,
                                            const ReciprocalOptions& options) {
  EXACTVO_REQUIRE(geometry::is_finite(a.velocity) && geometry::is_finite(b.velocity), "a velocity that is not finite");
  EXACTVO_REQUIRE(geometry::is_finite(a.position) && geometry::is_finite(b.position), "a position that is not finite");
  EXACTVO_REQUIRE(a.radius >= 0.0 && b.radius >= 0.0 && std::isfinite(a.radius) && std::isfinite(b.radius),
                  std::to_string(a.radius) + ", " + std::to_string(b.radius));
  EXACTVO_REQUIRE(options.time_horizon > 0.0, std::to_string(options.time_horizon));
  EXACTVO_REQUIRE(options.margin >= 0.0 && std::isfinite(options.margin), std::to_string(options.margin));
  EXACTVO_REQUIRE(options.contact_time > 0.0, std::to_string(options.contact_time));
  EXACTVO_REQUIRE(options.responsibility_of_a >= 0.0 && options.responsibility_of_a <= 1.0,
                  std::to_string(options.responsibility_of_a));
  if (!comes_first(b, a)) return ordered(a, b, options);
  // One order for both, so that exchanging the robots gives the same bits.
  ReciprocalOptions swapped = options;
  swapped.responsibility_of_a = 1.0 - options.responsibility_of_a;
  const ReciprocalHalfPlanes pair = ordered(b, a, swapped);
  return {pair.b, pair.a, pair.certified};
}

}  // namespace exactvo::vo
