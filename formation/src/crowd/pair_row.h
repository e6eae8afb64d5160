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

/// A pair in the order of ids.
struct PairInStep {
  std::int64_t dx = 0, dy = 0;  ///< p_a - p_b, below 2^31
  std::int64_t radius = 0;      ///< R, below 2^32
  Motion wish_a, wish_b;        ///< below 2^23
  Motion safe_a, safe_b;        ///< u
};

/// kPack pairs in columns, and their rows.
struct PairBlock {
  alignas(64) std::int32_t dx[kPack], dy[kPack];
  std::int32_t wish_ax[kPack], wish_ay[kPack], wish_bx[kPack], wish_by[kPack];
  std::int32_t safe_ax[kPack], safe_ay[kPack], safe_bx[kPack], safe_by[kPack];  ///< not at rest
  double radius[kPack];
  double normal_x[kPack], normal_y[kPack], least_a[kPack], least_b[kPack];  ///< of the rows, whole

  void put(std::size_t k, const PairInStep& pair, bool at_rest) {
    dx[k] = static_cast<std::int32_t>(pair.dx), dy[k] = static_cast<std::int32_t>(pair.dy);
    radius[k] = static_cast<double>(pair.radius);
    wish_ax[k] = pair.wish_a.x, wish_ay[k] = pair.wish_a.y;
    wish_bx[k] = pair.wish_b.x, wish_by[k] = pair.wish_b.y;
    if (at_rest) return;
    safe_ax[k] = pair.safe_a.x, safe_ay[k] = pair.safe_a.y;
    safe_bx[k] = pair.safe_b.x, safe_by[k] = pair.safe_b.y;
  }
  /// What was put at k.
  PairInStep pair(std::size_t k, bool at_rest) const {
    PairInStep p{dx[k], dy[k], static_cast<std::int64_t>(radius[k]), {wish_ax[k], wish_ay[k]}, {wish_bx[k], wish_by[k]},
                 {},    {}};
    if (!at_rest) p.safe_a = {safe_ax[k], safe_ay[k]}, p.safe_b = {safe_bx[k], safe_by[k]};
    return p;
  }
};

/// Pairs, and their rows.
class PairTable {
 public:
  std::size_t size() const { return size_; }
  bool at_rest() const { return at_rest_; }
  /// For pairs whose u is all 0, or for any.
  void clear(bool at_rest) { size_ = 0, at_rest_ = at_rest; }
  void add(const PairInStep& pair) {
    if (size_ == kPack * blocks_.size()) blocks_.emplace_back();
    blocks_[size_ / kPack].put(size_ % kPack, pair, at_rest_);
    ++size_;
  }
  PairBlock* blocks() { return blocks_.data(); }

  /// After `make_pair_rows`. False: no normal was found for u != 0, and both robots have to keep it.
  bool found(std::size_t k) const { return normal_x(k) != 0.0 || normal_y(k) != 0.0; }
  MotionRow row_a(std::size_t k) const { return row(normal_x(k), normal_y(k), blocks_[k / kPack].least_a[k % kPack]); }
  MotionRow row_b(std::size_t k) const {
    return row(-normal_x(k), -normal_y(k), blocks_[k / kPack].least_b[k % kPack]);
  }

 private:
  static MotionRow row(double x, double y, double least) {
    return {static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), static_cast<std::int64_t>(least)};
  }
  double normal_x(std::size_t k) const { return blocks_[k / kPack].normal_x[k % kPack]; }
  double normal_y(std::size_t k) const { return blocks_[k / kPack].normal_y[k % kPack]; }

  Array<PairBlock> blocks_;
  std::size_t size_ = 0;
  bool at_rest_ = true;
};

/// Makes the rows of all pairs. Exact. REQUIRES: of every pair u = 0, or a motion for which it had rows at an earlier
/// u.
void make_pair_rows(PairTable& pairs);

}  // namespace exactvo::formation::crowd
