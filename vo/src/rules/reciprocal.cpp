// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/reciprocal.h"

#include <cmath>
#include <string>
#include <tuple>

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/support.h"
#include "exactvo/vo/velocity_obstacle.h"

namespace exactvo::vo {
namespace {

using geometry::dot;
using geometry::kUnitRoundoff;

/// n.(v_A' - v_B') >= offset.
struct Joint {
  Vec2 normal;
  double offset;
  bool certified;
};

/// The half-plane of the relative velocity, by the static construction around b seen from a.
Joint relative_half_plane(const MovingDisc& a, const MovingDisc& b, const ReciprocalOptions& options) {
  const geometry::Disc other{b.position, b.radius};
  const VelocityObstacle kept_apart(other, a.position, a.radius + options.margin, options.time_horizon);
  if (!kept_apart.overlaps()) {
    if (const auto h = kept_apart.half_plane(a.velocity - b.velocity)) return {h->normal, h->offset, true};
  }
  // Within the margin: part at the pace that restores it. An offset >= 0 is safe wherever the normal is.
  const VelocityObstacle::Nearest n0 = kept_apart.nearest();
  const Joint parting{n0.normal, std::fmax(-n0.distance, 0.0) / options.contact_time, false};
  const geometry::GrownShape bare{other, a.position, a.radius};
  const bool safe = half_plane_is_safe(bare, options.time_horizon, {parting.normal, parting.offset});
  return {parting.normal, parting.offset, safe};
}

/// share (c - n.(v_A - v_B)) + n.v, rounded up past the error of its terms: two products a dot, four sums.
double half_offset(double share, double c, Vec2 n, Vec2 own, Vec2 other) {
  const double at_own = dot(n, own);
  const double at_other = dot(n, other);
  const double value = at_own + share * (c - (at_own - at_other));
  const double terms = std::fabs(n.x * own.x) + std::fabs(n.y * own.y) + std::fabs(n.x * other.x) +
                       std::fabs(n.y * other.y) + std::fabs(c);
  constexpr double kRoundings = 16.0;  // at most 8 u of each term, twice that for the bound's own rounding
  return value + kRoundings * kUnitRoundoff * terms;
}

bool comes_first(const MovingDisc& a, const MovingDisc& b) {
  return std::tie(a.position.x, a.position.y, a.velocity.x, a.velocity.y, a.radius) <
         std::tie(b.position.x, b.position.y, b.velocity.x, b.velocity.y, b.radius);
}

ReciprocalHalfPlanes ordered(const MovingDisc& a, const MovingDisc& b, const ReciprocalOptions& options) {
  const Joint joint = relative_half_plane(a, b, options);
  const Vec2 n = joint.normal;
  const double c_a = half_offset(options.share_of_a, joint.offset, n, a.velocity, b.velocity);
  const double c_b = half_offset(1.0 - options.share_of_a, joint.offset, -n, b.velocity, a.velocity);
  return {{n, c_a}, {-n, c_b}, joint.certified};
}

}  // namespace

ReciprocalHalfPlanes reciprocal_half_planes(const MovingDisc& a, const MovingDisc& b,
                                            const ReciprocalOptions& options) {
  EXACTVO_REQUIRE(geometry::is_finite(a.velocity) && geometry::is_finite(b.velocity), "a velocity that is not finite");
  EXACTVO_REQUIRE(options.margin >= 0.0 && std::isfinite(options.margin), std::to_string(options.margin));
  EXACTVO_REQUIRE(options.contact_time > 0.0, std::to_string(options.contact_time));
  EXACTVO_REQUIRE(options.share_of_a >= 0.0 && options.share_of_a <= 1.0, std::to_string(options.share_of_a));
  if (!comes_first(b, a)) return ordered(a, b, options);
  // One order for both, so that exchanging the robots gives the same bits.
  ReciprocalOptions swapped = options;
  swapped.share_of_a = 1.0 - options.share_of_a;
  const ReciprocalHalfPlanes pair = ordered(b, a, swapped);
  return {pair.b, pair.a, pair.certified};
}

}  // namespace exactvo::vo
