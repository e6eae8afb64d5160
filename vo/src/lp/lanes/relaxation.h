// SPDX-License-Identifier: GPL-3.0-or-later
// The relaxation phase: the least violation, in the space (v_x, v_y, t) where a soft line is the plane t = c - n.v and
// a hard one a wall. Compiled once per SIMD target, hence the toggling guard.
#if defined(EXACTVO_BATCH_RELAX_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_RELAX_H
#undef EXACTVO_BATCH_RELAX_H
#else
#define EXACTVO_BATCH_RELAX_H
#endif

#include "lp/lanes/pack.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// A contradiction of three lines as found by the feasibility phase, in counter-clockwise order of normals and without
/// the slack that soft lines had there. `first` is said to enter: no other line has been looked for.
template <bool kHard, bool kIndex, class D>
HWY_INLINE void start_relaxing(Pack<D>& p, hn::Mask<D> which) {
  const hn::Vec<D> zero = hn::Zero(p.d);
  const auto without_slack = [&](LineV<D>& line) {
    const auto soft = kHard ? hn::And(which, p.is_soft(line)) : which;
    line.c = pick(soft, hn::Sub(line.c, p.slack), line.c);
  };
  without_slack(p.first);
  without_slack(p.second);
  without_slack(p.third);
  const auto clockwise = hn::And(which, hn::Lt(cross(p.first, p.second), zero));
  const LineV<D> first = p.first;
  p.first = pick<kIndex>(clockwise, p.second, first);
  p.second = pick<kIndex>(clockwise, first, p.second);
  p.entering = pick<kIndex>(which, p.first, p.entering);
}

/// Whether 0 lies strictly inside the triangle of the normals, which are in counter-clockwise order, and one is soft.
template <bool kHard, class D>
HWY_INLINE hn::Mask<D> surround_zero(const Pack<D>& p) {
  const hn::Vec<D> zero = hn::Zero(p.d);
  const auto around = hn::And(hn::Gt(cross(p.first, p.second), zero),
                              hn::And(hn::Gt(cross(p.second, p.third), zero), hn::Gt(cross(p.third, p.first), zero)));
  if (!kHard) return around;
  return hn::And(around, hn::Or(p.is_soft(p.first), hn::Or(p.is_soft(p.second), p.is_soft(p.third))));
}

/// Three planes or walls whose normals surround 0 (first, second, third counter-clockwise) are lowest where they meet.
///
///        second .           The one that enters takes the place of one of them: -n lies between the normals of two,
///              / \  n       and these two and n surround 0 again. (Where `first` enters, nothing changes.)
///     third . /_0_\ . first
///
/// Lanes where three walls would remain, where no two lie clearly on either side, or where they meet outside the disc
/// are given back untouched: they go on with Descent.
template <bool kHard, bool kIndex, class D>
HWY_INLINE hn::Mask<D> pivot(Pack<D>& p, hn::Mask<D> moving) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  const D d;
  const V zero = hn::Zero(d);
  const LineV<D> a = p.entering;
  const V by_first = cross(a, p.first), by_second = cross(a, p.second), by_third = cross(a, p.third);
  const M left_second = hn::Gt(by_second, zero);
  const M from_first = hn::AndNot(left_second, hn::Gt(by_first, zero));
  const M from_second = hn::AndNot(hn::Gt(by_third, zero), left_second);
  const LineV<D> b = pick<kIndex>(from_first, p.first, pick<kIndex>(from_second, p.second, p.third));
  const LineV<D> c = pick<kIndex>(from_first, p.second, pick<kIndex>(from_second, p.third, p.first));
  const V by_b = pick(from_first, by_first, pick(from_second, by_second, by_third));
  const V by_c = pick(from_first, by_second, pick(from_second, by_third, by_first));

  // A plane is as high as `top` on the line of their difference, a wall is its own line: two lines and where they meet.
  LineV<D> top = a, one = {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.c, b.c), b.index},
           two = {hn::Sub(a.x, c.x), hn::Sub(a.y, c.y), hn::Sub(a.c, c.c), c.index};
  M good = moving;
  if (kHard) {
    const M soft_a = p.is_soft(a), soft_b = p.is_soft(b), soft_c = p.is_soft(c);
    if (!hn::AllTrue(d, hn::Or(hn::And(soft_a, hn::And(soft_b, soft_c)), hn::Not(moving)))) {
      const M b_is_top = hn::AndNot(soft_a, soft_b);
      top = pick<false>(soft_a, a, pick<false>(b_is_top, b, c));
      const auto against_top = [&](M soft, const LineV<D>& line) {
        return LineV<D>{pick(soft, hn::Sub(top.x, line.x), line.x), pick(soft, hn::Sub(top.y, line.y), line.y),
                        pick(soft, hn::Sub(top.c, line.c), line.c), line.index};
      };
      one = pick<false>(b_is_top, a, against_top(soft_b, b));
      two = pick<false>(hn::Or(soft_a, b_is_top), against_top(soft_c, c), a);
      good = hn::And(good, hn::Or(soft_a, hn::Or(soft_b, soft_c)));
    }
  }
  const V inverse = hn::Div(hn::Set(d, T(1)), cross(one, two));
  const V x = hn::Mul(cross(one.c, one.y, two.c, two.y), inverse);
  const V y = hn::Mul(cross(one.x, one.c, two.x, two.c), inverse);
  const M between = hn::And(hn::Gt(by_b, zero), hn::Lt(by_c, zero));
  good = hn::And(good, hn::And(between, hn::Le(dot(x, y, x, y), p.disc_squared)));
  p.vx = pick(good, x, p.vx);
  p.vy = pick(good, y, p.vy);
  p.level = pick(good, excess(top, x, y), p.level);
  p.first = pick<kIndex>(good, a, p.first);
  p.second = pick<kIndex>(good, b, p.second);
  p.third = pick<kIndex>(good, c, p.third);
  return hn::AndNot(good, moving);
}

/// What cuts a stretch of a line q + s (-y, x) off: one of two lines of the working set, or the disc.
template <class D>
struct Stretch {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  V low, high;
  M low_first, low_second, high_first, high_second;
  M empty;

  template <bool kSecond>
  HWY_INLINE void clip(const Pack<D>& p, V qx, V qy, const LineV<D>& line, const LineV<D>& other) {
    const V zero = hn::Zero(p.d);
    const V slope = cross(line, other);
    const V missing = excess(other, qx, qy);
    const V where = hn::Div(missing, slope);
    const M raises = hn::And(hn::Gt(slope, zero), hn::Gt(where, low));
    const M lowers = hn::And(hn::Lt(slope, zero), hn::Lt(where, high));
    low = pick(raises, where, low);
    high = pick(lowers, where, high);
    if (kSecond) {
      low_first = hn::AndNot(raises, low_first);
      high_first = hn::AndNot(lowers, high_first);
      low_second = raises;
      high_second = lowers;
    } else {
      low_first = raises;
      high_first = lowers;
    }
    empty = hn::Or(empty, hn::And(hn::Eq(slope, zero), hn::Gt(missing, p.noise)));
  }
};

/// The part of the boundary of `line` inside the disc; `inverse` is 1 / |normal|^2.
template <class D, class V>
HWY_INLINE Stretch<D> inside_disc(const Pack<D>& p, const LineV<D>& line, V inverse) {
  const V zero = hn::Zero(p.d);
  const V room = hn::Sub(p.disc_squared, hn::Mul(hn::Mul(line.c, line.c), inverse));
  const V reach = hn::Sqrt(hn::Mul(hn::Max(room, zero), inverse));
  const auto none = p.none();
  return {hn::Neg(reach), reach, none, none, none, none, hn::Lt(room, zero)};
}

/// Any basis: soft planes, walls, the disc.
template <class D>
class Descent {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Line = LineV<D>;

 public:
  explicit HWY_INLINE Descent(Pack<D>& pack) : p_(pack), unsettled(pack.none()) {}

  /// Searches to the end in the lanes in `moving`. Lanes that end `unsettled` are for `solve`.
  template <bool kHard, bool kIndex>
  HWY_INLINE void run(const Rows<T>& rows, M moving) {
    const M fresh = hn::And(same(p_.entering, p_.first), moving);
    start(fresh);
    moving = hn::AndNot(unsettled, moving);
    for (int round = 0; round < kMostLockstepRounds && !hn::AllFalse(p_.d, moving); ++round) {
      if (kHard) {
        const M wall = hn::AndNot(p_.is_soft(p_.entering), moving);
        lowest_on_plane(hn::AndNot(wall, moving));
        if (!hn::AllFalse(p_.d, wall)) lowest_on_wall(wall);
      } else {
        lowest_on_plane(moving);
      }
      const M priced = hn::AndNot(unsettled, moving);
      price<kHard, kIndex, Ask::nothing>(rows, p_);
      moving = hn::And(priced, p_.violated);
    }
    unsettled = hn::Or(unsettled, moving);
  }

 private:
  Pack<D>& p_;

 public:
  M unsettled;

 private:
  static HWY_INLINE M same(const Line& a, const Line& b) {
    return hn::And(hn::Eq(a.x, b.x), hn::And(hn::Eq(a.y, b.y), hn::Eq(a.c, b.c)));
  }

  /// What lies lowest on a plane or a wall: where, how high, what binds.
  struct Lowest {
    V x, y;
    Line bind, also;
    M failed;
  };

  /// A contradiction as the first basis. Its third line was found last and enters: the others alone leave velocities
  /// that violate nothing, so that it binds at the optimum, as a plane or as a wall.
  HWY_INLINE void start(M fresh) {
    const M some_give = hn::Or(p_.is_soft(p_.first), hn::Or(p_.is_soft(p_.second), p_.is_soft(p_.third)));
    p_.entering = pick(fresh, p_.third, p_.entering);
    p_.third = pick(fresh, no_line(p_.d), p_.third);
    unsettled = hn::Or(unsettled, hn::AndNot(some_give, fresh));
  }

  /// `line` as a half-plane on the plane of soft line `top`: where it is violated no more than top.
  HWY_INLINE Line below(const Line& top, const Line& line) const {
    const M soft = p_.is_soft(line);
    return {pick(soft, hn::Sub(line.x, top.x), line.x), pick(soft, hn::Sub(line.y, top.y), line.y),
            pick(soft, hn::Sub(line.c, top.c), line.c), line.index};
  }

  /// Which of the lines before bind where the search stands.
  struct Binding {
    M line, before0, before1;
  };

  /// The point of the plane `top` that is lowest among what the lines before `line` leave: on `line`, where violated.
  template <int kBefore>
  HWY_INLINE Binding descend(const Line& top, const Line& line, const Line& before0, const Line& before1,
                             Lowest& at) const {
    const D d;
    const V zero = hn::Zero(d);
    const V squared = dot(line.x, line.y, line.x, line.y);
    const M violated = hn::And(hn::Gt(excess(line, at.x, at.y), zero), hn::Gt(squared, zero));
    const V inverse = hn::Div(hn::Set(d, T(1)), squared);
    const V scale = hn::Mul(line.c, inverse);
    const V qx = hn::Mul(line.x, scale), qy = hn::Mul(line.y, scale);
    Stretch<D> s = inside_disc(p_, line, inverse);
    if (kBefore > 0) s.template clip<false>(p_, qx, qy, line, before0);
    if (kBefore > 1) s.template clip<true>(p_, qx, qy, line, before1);
    const V along = cross(line, top);
    const V foot = hn::Min(hn::Max(hn::Mul(cross(line.x, line.y, p_.px, p_.py), inverse), s.low), s.high);
    const M up = hn::Gt(along, zero), down = hn::Lt(along, zero);
    const V where = pick(up, s.high, pick(down, s.low, foot));
    at.failed = hn::Or(at.failed, hn::And(violated, hn::Or(s.empty, hn::Gt(s.low, s.high))));
    at.x = pick(violated, hn::Sub(qx, hn::Mul(where, line.y)), at.x);
    at.y = pick(violated, hn::Add(qy, hn::Mul(where, line.x)), at.y);
    return {violated, hn::And(violated, hn::Or(hn::And(up, s.high_first), hn::And(down, s.low_first))),
            hn::And(violated, hn::Or(hn::And(up, s.high_second), hn::And(down, s.low_second)))};
  }

  /// The lowest point of the plane of soft line `top` above the planes, and beyond the walls, of three others.
  HWY_INLINE Lowest lowest(const Line& top, const Line& first, const Line& second, const Line& third) const {
    const Line a = below(top, first), b = below(top, second), c = below(top, third);
    const V reach = hn::Div(p_.disc, hn::Sqrt(dot(top.x, top.y, top.x, top.y)));
    Lowest at{hn::Mul(top.x, reach), hn::Mul(top.y, reach), no_line(p_.d), no_line(p_.d), p_.none()};
    const Binding on_a = descend<0>(top, a, a, a, at);
    const Binding on_b = descend<1>(top, b, a, a, at);
    const Binding on_c = descend<2>(top, c, a, b, at);
    at.bind = pick(on_c.line, third, pick(on_b.line, second, pick(on_a.line, first, at.bind)));
    at.also = pick(on_c.before0, first, pick(on_c.before1, second, at.also));
    at.also = pick(hn::AndNot(on_c.line, on_b.before0), first, at.also);
    return at;
  }

  HWY_INLINE void take(const Lowest& at, const Line& top, M moving) {
    p_.vx = pick(moving, at.x, p_.vx);
    p_.vy = pick(moving, at.y, p_.vy);
    p_.level = pick(moving, excess(top, at.x, at.y), p_.level);
    p_.first = pick(moving, top, p_.first);
    p_.second = pick(moving, at.bind, p_.second);
    p_.third = pick(moving, at.also, p_.third);
  }

  HWY_INLINE void lowest_on_plane(M moving) {
    const Lowest at = lowest(p_.entering, p_.first, p_.second, p_.third);
    unsettled = hn::Or(unsettled, hn::And(moving, at.failed));
    take(at, p_.entering, moving);
  }

  /// A hard line enters. Whatever the new lowest point is, a soft plane of the old basis binds there: of the lowest
  /// points on each of them, the lowest.
  HWY_INLINE void lowest_on_wall(M moving) {
    const Line wall = p_.entering, lines[3] = {p_.first, p_.second, p_.third};
    const V far = hn::Set(p_.d, T(kNowhere));
    V level = far;
    Lowest best{p_.vx, p_.vy, no_line(p_.d), no_line(p_.d), p_.none()};
    Line top = p_.first;
    for (int k = 0; k < 3; ++k) {
      const Line& plane = lines[k];
      const Lowest at = lowest(plane, wall, lines[(k + 1) % 3], lines[(k + 2) % 3]);
      const V height = excess(plane, at.x, at.y);
      const M can = hn::AndNot(at.failed, p_.is_soft(plane));
      const M better = hn::And(can, hn::Lt(height, level));
      level = pick(better, height, level);
      best.x = pick(better, at.x, best.x);
      best.y = pick(better, at.y, best.y);
      best.bind = pick(better, at.bind, best.bind);
      best.also = pick(better, at.also, best.also);
      top = pick(better, plane, top);
    }
    const M found = hn::And(moving, hn::Lt(level, far));
    unsettled = hn::Or(unsettled, hn::AndNot(found, moving));
    take(best, top, found);
  }

  /// Higher than any violation that a batch may hold.
  static constexpr T kNowhere = static_cast<T>(1e30);
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
