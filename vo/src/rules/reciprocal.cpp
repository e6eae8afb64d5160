// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/reciprocal.h"

#include <cmath>
#include <string>
#include <tuple>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"
#include "exactvo/vo/constraint.h"

namespace exactvo::vo {
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
/// and c pass fewer.
double half_offset(double responsibility, double c, Vec2 n, Vec2 own, Vec2 other) {
  const double at_own = dot(n, own);
  const double at_other = dot(n, other);
  const double value = at_own + responsibility * (c - (at_own - at_other));
  const double magnitude =
      geometry::dot_magnitude(n, own) + geometry::dot_magnitude(n, other) + geometry::product_magnitude(1.0, c);
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
  const double c_a = half_offset(options.responsibility_of_a, c, n, a.velocity, b.velocity);
  const double c_b = half_offset(1.0 - options.responsibility_of_a, c, -n, b.velocity, a.velocity);
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
