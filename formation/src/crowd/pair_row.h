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
///
/// All numbers but the directions of normals are whole and below 2^53, so doubles hold them exactly; pairs stand one
/// per SIMD lane, and every target gives the same bits.

#include <cstdint>

#include "crowd/layout.h"

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

/// Columns of robots: places below 2^30, motions below 2^23. R of two robots is below 2^32.
struct MotionColumns {
  const std::int32_t *x = nullptr, *y = nullptr, *wish_x = nullptr, *wish_y = nullptr;
  const std::int32_t *safe_x = nullptr, *safe_y = nullptr;  ///< u; null: rest
};

/// Pairs, each in the order of ids, and the rows of both its robots.
class PairTable {
 public:
  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }
  /// Adds the row of the robots at two places of the columns and returns its number. The caller sets R and the entries.
  std::size_t add(std::size_t robot_a, std::size_t robot_b) {
    if (size_ == room_) make_room();
    a[size_] = static_cast<std::int32_t>(robot_a);
    b[size_] = static_cast<std::int32_t>(robot_b);
    return size_++;
  }
  /// After the last pair there is room for kPack more, which are read, but not used.
  void pad() {
    if (a.empty()) make_room();
    for (std::size_t k = size_; k < size_ + kPack; ++k) a[k] = b[k] = 0;
  }

  /// Without a row both robots have to keep u.
  bool found(std::size_t k) const { return (flags[k] & kFound) != 0; }
  /// Its row surely allows the wish.
  bool grants(std::size_t k, bool of_a) const { return (flags[k] & (of_a ? kGrantsA : kGrantsB)) != 0; }
  MotionRow row(std::size_t k, bool of_a) const {
    const auto x = static_cast<std::int64_t>(normal_x[k]), y = static_cast<std::int64_t>(normal_y[k]);
    return of_a ? MotionRow{x, y, static_cast<std::int64_t>(least_a[k])}
                : MotionRow{-x, -y, static_cast<std::int64_t>(least_b[k])};
  }

  static constexpr std::int32_t kFound = 1, kGrantsA = 2, kGrantsB = 4, kGrantsBoth = 7;

  Array<std::int32_t> a, b;          ///< places of robots
  Array<double> radii;               ///< R
  Array<double> normal_x, normal_y;  ///< N, whole
  Array<double> least_a, least_b;    ///< of the rows, whole
  Array<std::int32_t> flags;
  Array<std::int32_t> before;        ///< of entry 2 k + (0: of a, 1: of b) that before it of the same robot; -1: none
  Array<std::int32_t> open;          ///< pairs that wait for better rows
  Array<double> wanted_x, wanted_y;  ///< their directions

 private:
  void make_room();

  std::size_t size_ = 0, room_ = 0;
};

/// Makes the rows of the pairs from `first` on. Exact. REQUIRES: of every pair u = 0, or a motion for which it had rows
/// at an earlier u.
void make_pair_rows(const MotionColumns& robots, PairTable& pairs, std::size_t first);

}  // namespace exactvo::formation::crowd
