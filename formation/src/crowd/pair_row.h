// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What keeps two robots apart in one time step: a half-plane of motions for each, in integers. Exact.
///
/// Positions and motions are whole lattice steps, radii are rounded up to whole ones. D = p_a - p_b is where a pair
/// stands, R the sum of its radii, (u_a, u_b) a joint motion that is known to be safe (rest: 0), (w_a, w_b) what the
/// two wish. The rows are N.m_a >= c_a and -N.m_b >= c_b, with N != 0 and a `bar` >= R |N|. Lemmas (tests quote the
/// numbers):
///  (1) If N.D >= bar and N.(D + m_a - m_b) >= bar, then |D + s (m_a - m_b)| >= R for all s in [0, 1]: the product is
///      affine in s, and N.z <= |N| |z|.
///  (2) c_a + c_b >= bar - N.D. So two motions that satisfy their rows satisfy (1), and each robot may compute its
///      row by itself: both follow from the same numbers in the order of ids.
///  (3) N = D always serves at u = 0, as N.D = |D|^2 >= R |D|; with c_a = c_b = 0 the distance does not shrink,
///      whatever R is: two robots that satisfy these rows never come nearer to each other in the step, even if they
///      overlap.
///  (4) The rows contain u. At u = 0 so c_a <= 0 and c_b <= 0: rest satisfies every row of every robot, and no linear
///      program made of them is infeasible.
///  (5) If all joint motions of the parallelogram between u and the wishes keep `bar` from 0 along the normal that was
///      chosen, both wishes satisfy their rows. If the parallelogram stays R and the rounding of normals away from 0,
///      such a normal is chosen.
/// Source: van den Berg et al. 2011 for the normal of a pair whose wishes cross. The split by what each wishes, and the
/// lemmas, are our own.

#include <cstdint>

namespace exactvo::formation::crowd {

/// Lattice steps.
struct Motion {
  std::int32_t x = 0, y = 0;

  friend bool operator==(Motion a, Motion b) { return a.x == b.x && a.y == b.y; }
  friend bool operator!=(Motion a, Motion b) { return !(a == b); }
};

/// n.m >= least. Products stay below 2^56.
struct MotionRow {
  std::int64_t nx = 0, ny = 0, least = 0;

  std::int64_t at(Motion m) const { return nx * m.x + ny * m.y; }
  bool allows(Motion m) const { return at(m) >= least; }
};

/// A pair in the order of ids.
struct PairInStep {
  std::int64_t dx = 0, dy = 0;  ///< p_a - p_b, below 2^31
  std::int64_t radius = 0;      ///< R, below 2^31
  Motion wish_a, wish_b;        ///< below 2^23
  Motion safe_a, safe_b;        ///< u
};

/// Of the two robots.
struct PairRows {
  MotionRow a, b;
  bool found = true;  ///< false: no normal was found for u != 0, and both have to keep it
};

/// Exact. REQUIRES: u = 0, or a motion for which `pair_rows` at an earlier u had rows.
PairRows pair_rows(const PairInStep& pair);

}  // namespace exactvo::formation::crowd
