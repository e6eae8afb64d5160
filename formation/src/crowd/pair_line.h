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

template <bool kCertified, class D>
HWY_INLINE PairLine<D> pair_line(D d, const Pair<D>& p, hn::TFromD<D> inverse_time, hn::TFromD<D> lattice_slack) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  constexpr T u = sizeof(T) == 8 ? static_cast<T>(0x1p-53) : static_cast<T>(0x1p-24);
  const auto times_u = [&](V a, int units) { return hn::Mul(a, hn::Set(d, T(units) * u)); };
  const V zero = hn::Zero(d), one = hn::Set(d, T(1)), half = hn::Set(d, T(0.5));
  const V squared_distance = hn::Add(hn::Mul(p.px, p.px), hn::Mul(p.py, p.py));
  const V size = hn::Add(hn::Add(hn::Abs(p.px), hn::Abs(p.py)), p.radius);
  const V grown = kCertified ? hn::Add(p.radius, times_u(size, 32)) : p.radius;
  const V squared_radius = hn::Mul(grown, grown);
  const auto touching = hn::Le(squared_distance, squared_radius);
  const V inverse = hn::IfThenElse(touching, hn::Set(d, inverse_time), p.inverse_horizon);

  // w: the relative velocity, seen from the centre of the cut-off.
  const V rx = hn::Sub(p.vx, p.ox), ry = hn::Sub(p.vy, p.oy);
  V wx = hn::Sub(rx, hn::Mul(inverse, p.px)), wy = hn::Sub(ry, hn::Mul(inverse, p.py));
  V squared_w = hn::Add(hn::Mul(wx, wx), hn::Mul(wy, wy));
  const auto aimless = hn::And(touching, hn::Lt(squared_w, hn::Set(d, static_cast<T>(0x1p-100))));
  auto coincident = aimless;
  if (HWY_UNLIKELY(!hn::AllFalse(d, aimless))) {  // as fast as can be to where the other is: straight away from it
    wx = hn::IfThenElse(aimless, hn::Neg(p.px), wx);
    wy = hn::IfThenElse(aimless, hn::Neg(p.py), wy);
    squared_w = hn::Add(hn::Mul(wx, wx), hn::Mul(wy, wy));
    coincident = hn::And(aimless, hn::Eq(squared_w, zero));
  }
  const V along = hn::Add(hn::Mul(wx, p.px), hn::Mul(wy, p.py));
  const auto ahead = hn::And(hn::Lt(along, zero), hn::Gt(hn::Mul(along, along), hn::Mul(squared_radius, squared_w)));
  const auto cut_off = hn::Or(touching, ahead);

  // Cut-off: n along w. Leg: the tangent on the side of w.
  const V squared_tangent = hn::Max(hn::Sub(squared_distance, squared_radius), zero);
  const V root = hn::Sqrt(hn::IfThenElse(cut_off, squared_w, squared_tangent));
  const V scale =
      hn::Div(one, hn::Max(hn::IfThenElse(cut_off, root, squared_distance), hn::Set(d, static_cast<T>(0x1p-100))));
  const V turn = hn::Sub(hn::Mul(p.px, wy), hn::Mul(p.py, wx));
  const V leg = hn::IfThenElse(hn::Gt(turn, zero), root, hn::Neg(root));
  const V lx = hn::Neg(hn::Add(hn::Mul(grown, p.px), hn::Mul(leg, p.py)));
  const V ly = hn::Sub(hn::Mul(leg, p.px), hn::Mul(grown, p.py));
  V nx = hn::Mul(hn::IfThenElse(cut_off, wx, lx), scale);
  const V ny = hn::Mul(hn::IfThenElse(cut_off, wy, ly), scale);

  if (HWY_UNLIKELY(!hn::AllFalse(d, coincident))) nx = hn::IfThenElse(coincident, one, nx);  // any: see `coincident`

  const V sum = hn::Add(hn::Add(hn::Mul(nx, p.px), hn::Mul(ny, p.py)), p.radius);
  const V quotient = hn::Mul(kCertified ? hn::Add(sum, times_u(size, 12)) : sum, inverse);
  const V rounded_up = kCertified ? hn::Add(quotient, times_u(hn::Abs(quotient), 4)) : quotient;
  const V joint = hn::IfThenElseZero(cut_off, rounded_up);
  const V at_relative = hn::Add(hn::Mul(nx, rx), hn::Mul(ny, ry));
  const V at_own = hn::Add(hn::Mul(nx, p.vx), hn::Mul(ny, p.vy));
  V offset = hn::Add(at_own, hn::Mul(half, hn::Sub(joint, at_relative)));
  if (kCertified) {
    const V own = hn::Add(hn::Abs(p.vx), hn::Abs(p.vy)), other = hn::Add(hn::Abs(p.ox), hn::Abs(p.oy));
    const V terms = hn::Add(hn::Add(own, other), hn::Abs(joint));
    offset = hn::Add(offset, hn::Add(times_u(terms, 16), hn::Set(d, lattice_slack)));
  }
  return {nx, ny, offset, touching, coincident};
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
