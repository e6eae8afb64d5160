// SPDX-License-Identifier: GPL-3.0-or-later
// The half-plane of one robot against another, one pair per lane. Compiled once per SIMD target, hence the toggling
// guard.
//
// With p the position of the other seen from here, R the sum of the radii, n the normal, h(n) = n.p + R |n|, and the
// velocities v_a (own) and v_b: while n.(v_a' - v_b') >= h(n) / t and h(n) <= 0, the two do not touch within t,
// whatever n is (docs/guide/velocity-obstacles.md). Each takes half: n.v_a' >= n.v_a + (J - n.(v_a - v_b)) / 2 with J
// >= h(n)/t, and the two halves add up to J.
//
// Every operation is odd or even in the exchange of the two, which negates p and n and exchanges the velocities, and
// none is fused. So both get the same normal, negated, and the same J, each on its own.
//
// Rounding, u the unit roundoff of T, size = |px| + |py| + R as computed, p itself with an error of u:
//  (a) R' = R + 32 u size is at least R + 30 u size. A cut-off is chosen where fl(w.p) < 0, fl(w.p)^2 > R'^2 |w|^2 as
//      computed. Then -w.p >= R' |w| (1 - 4 u) - 3 u |w| size, and n, w scaled with an error of u a component, has
//      n.p + R|n| <= |n| (R (1 + 7 u) - R' + 5 u size) < 0. A leg has n.p = -R' up to 8 u size and |n| <= 1 + 6 u,
//      hence n.p + R |n| < 0 as well. So h(n) <= 0, exactly, but where `touching`.
//  (b) |n| <= 1 + 5 u. fl(n.p + R) is below h(n) by at most 9 u size; 12 u size are added. The product by 1/t rounds
//      twice: 4 u of it are added. So J >= h(n) / t; 0 on a leg.
//  (c) The half offset is a sum of terms with at most 7 roundings each, at most 9 u of the sum of magnitudes: 16 u are
//      added. What underflows is less than a hundredth of the lattice slack.
#if defined(EXACTVO_CROWD_PAIR_LINE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_CROWD_PAIR_LINE_H
#undef EXACTVO_CROWD_PAIR_LINE_H
#else
#define EXACTVO_CROWD_PAIR_LINE_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Pair {
  hn::Vec<D> px, py;           ///< m, the other from here
  hn::Vec<D> vx, vy, ox, oy;   ///< m/s, own and the other's
  hn::Vec<D> radius;           ///< m, the sum
  hn::Vec<D> inverse_horizon;  ///< 1/s
};

template <class D>
struct PairLine {
  hn::Vec<D> x, y, c;
  hn::Mask<D> touching;
  hn::Mask<D> coincident;  ///< in one place, with one velocity: what parts them is decided elsewhere, by ids
};

template <class D>
HWY_INLINE hn::Vec<D> times_u(D d, hn::Vec<D> a, int units) {
  using T = hn::TFromD<D>;
  constexpr T u = sizeof(T) == 8 ? static_cast<T>(0x1p-53) : static_cast<T>(0x1p-24);
  return hn::Mul(a, hn::Set(d, T(units) * u));
}

/// A half-plane is a chain of some two hundred cycles, with a root and a division in it, which a processor cannot look
/// past. So it is made in three parts, each of them for all the others of a robot: the gaps of one are filled by the
/// next.
template <bool kCertified, class D>
struct PairWork {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;

  V px, py, rx, ry, wx, wy;
  V squared_distance, under_root, grown, size, inverse, terms;
  V root, scale;
  hn::Mask<D> touching, coincident, cut_off;

  HWY_INLINE void begin(D d, const Pair<D>& p, T inverse_time) {
    const V zero = hn::Zero(d);
    px = p.px;
    py = p.py;
    squared_distance = hn::Add(hn::Mul(px, px), hn::Mul(py, py));
    size = hn::Add(hn::Add(hn::Abs(px), hn::Abs(py)), p.radius);
    grown = kCertified ? hn::Add(p.radius, times_u(d, size, 32)) : p.radius;
    const V squared_radius = hn::Mul(grown, grown);
    touching = hn::Le(squared_distance, squared_radius);
    inverse = hn::IfThenElse(touching, hn::Set(d, inverse_time), p.inverse_horizon);

    // w: the relative velocity, seen from the centre of the cut-off.
    rx = hn::Sub(p.vx, p.ox);
    ry = hn::Sub(p.vy, p.oy);
    wx = hn::Sub(rx, hn::Mul(inverse, px));
    wy = hn::Sub(ry, hn::Mul(inverse, py));
    V squared_w = hn::Add(hn::Mul(wx, wx), hn::Mul(wy, wy));
    const auto aimless = hn::And(touching, hn::Lt(squared_w, hn::Set(d, static_cast<T>(0x1p-100))));
    coincident = aimless;
    if (HWY_UNLIKELY(!hn::AllFalse(d, aimless))) {  // as fast as can be to where the other is: straight away from it
      wx = hn::IfThenElse(aimless, hn::Neg(px), wx);
      wy = hn::IfThenElse(aimless, hn::Neg(py), wy);
      squared_w = hn::Add(hn::Mul(wx, wx), hn::Mul(wy, wy));
      coincident = hn::And(aimless, hn::Eq(squared_w, zero));
    }
    const V along = hn::Add(hn::Mul(wx, px), hn::Mul(wy, py));
    const auto ahead = hn::And(hn::Lt(along, zero), hn::Gt(hn::Mul(along, along), hn::Mul(squared_radius, squared_w)));
    cut_off = hn::Or(touching, ahead);
    const V squared_tangent = hn::Max(hn::Sub(squared_distance, squared_radius), zero);
    under_root = hn::IfThenElse(cut_off, squared_w, squared_tangent);
    if (kCertified) {
      const V own = hn::Add(hn::Abs(p.vx), hn::Abs(p.vy)), other = hn::Add(hn::Abs(p.ox), hn::Abs(p.oy));
      terms = hn::Add(own, other);
    }
  }

  HWY_INLINE void divide(D d) {
    root = hn::Sqrt(under_root);
    const V length = hn::IfThenElse(cut_off, root, squared_distance);
    scale = hn::Div(hn::Set(d, T(1)), hn::Max(length, hn::Set(d, static_cast<T>(0x1p-100))));
  }

  HWY_INLINE PairLine<D> line(D d, const V& vx, const V& vy, const V& radius, T lattice_slack) const {
    const V zero = hn::Zero(d), half = hn::Set(d, T(0.5));
    // Cut-off: n along w. Leg: the tangent on the side of w.
    const V turn = hn::Sub(hn::Mul(px, wy), hn::Mul(py, wx));
    const V leg = hn::IfThenElse(hn::Gt(turn, zero), root, hn::Neg(root));
    const V lx = hn::Neg(hn::Add(hn::Mul(grown, px), hn::Mul(leg, py)));
    const V ly = hn::Sub(hn::Mul(leg, px), hn::Mul(grown, py));
    V nx = hn::Mul(hn::IfThenElse(cut_off, wx, lx), scale);
    const V ny = hn::Mul(hn::IfThenElse(cut_off, wy, ly), scale);
    // Any direction: see `coincident`.
    if (HWY_UNLIKELY(!hn::AllFalse(d, coincident))) nx = hn::IfThenElse(coincident, hn::Set(d, T(1)), nx);

    const V sum = hn::Add(hn::Add(hn::Mul(nx, px), hn::Mul(ny, py)), radius);
    const V quotient = hn::Mul(kCertified ? hn::Add(sum, times_u(d, size, 12)) : sum, inverse);
    const V rounded_up = kCertified ? hn::Add(quotient, times_u(d, hn::Abs(quotient), 4)) : quotient;
    const V joint = hn::IfThenElseZero(cut_off, rounded_up);
    const V at_relative = hn::Add(hn::Mul(nx, rx), hn::Mul(ny, ry));
    const V at_own = hn::Add(hn::Mul(nx, vx), hn::Mul(ny, vy));
    V offset = hn::Add(at_own, hn::Mul(half, hn::Sub(joint, at_relative)));
    if (kCertified) {
      const V all_terms = hn::Add(terms, hn::Abs(joint));
      offset = hn::Add(offset, hn::Add(times_u(d, all_terms, 16), hn::Set(d, lattice_slack)));
    }
    return {nx, ny, offset, touching, coincident};
  }
};

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
