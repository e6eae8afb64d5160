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

/// A row over the length of its normal, rounded: |(x, y)| = 1, least in lattice steps.
struct UnitRow {
  double x, y, least;
};

/// A pair in the order of ids.
struct PairInStep {
  std::int64_t dx = 0, dy = 0;  ///< p_a - p_b, below 2^31
  std::int64_t radius = 0;      ///< R, below 2^32
  Motion wish_a, wish_b;        ///< below 2^23
  Motion safe_a, safe_b;        ///< u
};

/// Columns of robots that pairs are gathered from.
struct MotionColumns {
  const std::int32_t *id = nullptr, *x = nullptr, *y = nullptr, *wish_x = nullptr, *wish_y = nullptr;
  const std::int32_t *safe_x = nullptr, *safe_y = nullptr;  ///< u; null: rest
};

/// kPack pairs in columns; of each the row of one of its robots, the one that decides.
struct PairBlock {
  alignas(64) std::int32_t dx[kPack], dy[kPack];
  std::int32_t wish_ax[kPack], wish_ay[kPack], wish_bx[kPack], wish_by[kPack];
  std::int32_t safe_ax[kPack], safe_ay[kPack], safe_bx[kPack], safe_by[kPack];  ///< only where u is not rest
  std::int32_t is_a[kPack];                                                     ///< -1: a decides, 0: b does
  double radius[kPack];
  double normal_x[kPack], normal_y[kPack], least[kPack];  ///< of the row, whole
  double unit_x[kPack], unit_y[kPack], unit_least[kPack];
  std::uint32_t found = 0;   ///< bit k: pair k has a row; without one both robots have to keep u
  std::uint32_t grants = 0;  ///< bit k: its row surely allows the wish

  /// Puts pair `from` of another block to k.
  void copy(std::size_t k, const PairBlock& of, std::size_t from, bool at_rest);
};

/// Pairs, and their rows.
class PairTable {
 public:
  std::size_t size() const { return size_; }
  bool at_rest() const { return at_rest_; }
  /// The number of pairs, which are then put into `blocks`, and whether their u are all rest.
  void lay_out(std::size_t pairs, bool at_rest) {
    size_ = pairs, at_rest_ = at_rest;
    if (blocks_.size() * kPack < pairs) blocks_.resize(pairs / kPack + 1 + blocks_.size());
  }
  PairBlock* blocks() { return blocks_.data(); }
  /// Pair k, of which a or b decides.
  void put(std::size_t k, const PairInStep& pair, bool is_a);

  bool found(std::size_t k) const { return (block(k).found >> k % kPack & 1U) != 0; }
  bool grants(std::size_t k) const { return (block(k).grants >> k % kPack & 1U) != 0; }
  MotionRow row(std::size_t k) const {
    const std::size_t at = k % kPack;
    return {static_cast<std::int64_t>(block(k).normal_x[at]), static_cast<std::int64_t>(block(k).normal_y[at]),
            static_cast<std::int64_t>(block(k).least[at])};
  }
  UnitRow unit_row(std::size_t k) const {
    const std::size_t at = k % kPack;
    return {block(k).unit_x[at], block(k).unit_y[at], block(k).unit_least[at]};
  }

 private:
  const PairBlock& block(std::size_t k) const { return blocks_[k / kPack]; }

  Array<PairBlock> blocks_;
  std::size_t size_ = 0;
  bool at_rest_ = true;
};

/// Lays out the pairs of robot[k], which decide, with other[k], all but their radii; both arrays are read to a multiple
/// of kPack.
void gather_pairs(const MotionColumns& from, const std::int32_t* robot, const std::int32_t* other, std::size_t count,
                  PairTable& to);

/// Makes the rows of all pairs. Exact. REQUIRES: of every pair u = 0, or a motion for which it had rows at an earlier
/// u.
void make_pair_rows(PairTable& pairs);

}  // namespace exactvo::formation::crowd
