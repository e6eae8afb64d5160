// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Exact predicates on shapes of doubles taken as the rationals they are. Each is decided by a floating-point filter
/// (round to nearest, error bound derived in the .cpp) and, where that is undecided, in exact arithmetic. No answer
/// depends on rounding; NaN and infinity are a caller's mistake.
///
/// Other files call the predicates by letters: A `sign_of_support`, is a half-plane safe? B1 `locate`, where is a point
/// of a grown shape? B2 `segment_meets`, does a motion reach it? E `contains`, is a point in an ellipse? F, is
/// a goal outside the evolute of an ellipse, so that no robot on its way there can stall at it?
///
/// Properties (tests quote the numbers):
///  (1) growing `radius` never lowers `sign_of_support`;
///  (2) scaling n and c by the same power of two does not change it;
///  (3) if q is in S, then h_S(n) >= n.q for every n;
///  (4) orientation(b, c, a) == orientation(a, b, c) and orientation(c, b, a) == -orientation(a, b, c);
///  (5) segment_meets grows with t_max, and holds if `locate` puts either end in S.

#include <cstdint>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/support.h"

namespace exactvo::geometry {

/// The sign of a number.
enum class Sign : int {
  negative = -1,  ///< below 0
  zero = 0,       ///< exactly 0
  positive = 1    ///< above 0
};

/// The sign of h_S(n) - tau * c. Exact. (Predicate A: a half-plane { n.v >= c } excludes the velocity obstacle of S
/// with horizon tau iff this is not positive, and neither is it with c = 0.)
Sign sign_of_support(const GrownShape& s, Vec2 n, double tau, double c);

/// Whether { v : normal . v >= offset } is disjoint from the interior of the truncated velocity obstacle
/// { v : t v in S, 0 < t <= tau }: h_S(n) <= 0 and h_S(n) <= tau * offset; for the
/// zero normal, offset > 0. Exact. REQUIRES tau > 0.
bool half_plane_is_safe(const GrownShape& s, double tau, const HalfPlane& h);

/// Where a point lies with respect to a closed set.
enum class Place : int {
  inside = -1,   ///< in the interior
  boundary = 0,  ///< exactly on the boundary
  outside = 1    ///< not in the set
};

/// Where q lies with respect to S (predicate B1). Exact. Lengths should lie in [2^-60, 2^60] m; outside, the exact
/// stage answers.
Place locate(const GrownShape& s, Vec2 q);

/// Whether t * direction lies in S for some 0 <= t <= t_max (predicate B2). Exact. REQUIRES t_max >= 0, finite.
bool segment_meets(const GrownShape& s, Vec2 direction, double t_max);

/// Whether x lies in the closed ellipse (predicate E). Exact.
bool contains(const Ellipse& ellipse, Vec2 x);

/// The sign of the turn a -> b -> c: positive is counter-clockwise. Exact.
Sign orientation(Vec2 a, Vec2 b, Vec2 c);

/// Whether the goal lies strictly outside the evolute of the ellipse, so that no stable trap exists on the boundary of
/// the ellipse grown by any disc (predicate F; docs/guide/trap-test.md). Exact: the cube roots are cleared.
/// (a|gx|)^(2/3) + (b|gy|)^(2/3) > (1 + slack) (a^2 - b^2)^(2/3) in the ellipse's frame. The cube of 1 + slack is
/// rounded once, before the test; slack = 0 is the condition itself. REQUIRES slack >= 0.
bool goal_outside_evolute(const Ellipse& ellipse, Vec2 goal, double slack = 0.0);

/// Which stage answered, counted over all threads since the start or the last reset.
struct StageCounts {
  std::uint64_t filter = 0;  ///< decided in floating point
  std::uint64_t exact = 0;   ///< needed exact arithmetic
};
/// The counts so far.
StageCounts stage_counts();
/// Sets both counts to 0.
void reset_stage_counts();

}  // namespace exactvo::geometry
