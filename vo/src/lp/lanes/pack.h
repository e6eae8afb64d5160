// SPDX-License-Identifier: GPL-3.0-or-later
// A register full of problems and the feasibility phase. Compiled once per SIMD target, hence the toggling guard.
#if defined(EXACTVO_BATCH_PACK_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_PACK_H
#undef EXACTVO_BATCH_PACK_H
#else
#define EXACTVO_BATCH_PACK_H
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Asks for the line of the cache at `place`, for the second cache: what is not needed soon would displace what is.
HWY_INLINE void for_second_cache(const void* place) {
  __builtin_prefetch(place, 0, 2);
}

/// The lines of a pack: line k of its first lane stands at x[k * stride], y[...], c[...].
template <class T>
struct Rows {
  const T* x;
  const T* y;
  const T* c;
  std::size_t stride, count;
};

/// A line a lane. A lane without one has normal (0, 0), offset -1 and index kNoLine: it cuts nothing.
template <class D>
struct LineV {
  hn::Vec<D> x, y, c, index;
};

template <class D>
LineV<D> HWY_INLINE no_line(D d) {
  const hn::Vec<D> zero = hn::Zero(d);
  return {zero, zero, hn::Set(d, hn::TFromD<D>(-1)), hn::Set(d, hn::TFromD<D>(kNoLine))};
}

template <class V, class M>
V HWY_INLINE pick(M m, V yes, V no) {
  return hn::IfThenElse(m, yes, no);
}
/// Without kIndex no numbers of lines are needed, and they stay as they are.
template <bool kIndex = true, class D, class M>
LineV<D> HWY_INLINE pick(M m, const LineV<D>& yes, const LineV<D>& no) {
  return {pick(m, yes.x, no.x), pick(m, yes.y, no.y), pick(m, yes.c, no.c),
          kIndex ? pick(m, yes.index, no.index) : no.index};
}
template <class V>
V HWY_INLINE dot(V ax, V ay, V bx, V by) {
  return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by));
}
template <class V>
V HWY_INLINE cross(V ax, V ay, V bx, V by) {
  return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
}
template <class D>
hn::Vec<D> HWY_INLINE cross(const LineV<D>& a, const LineV<D>& b) {
  return cross(a.x, a.y, b.x, b.y);
}
template <class D>
hn::Vec<D> HWY_INLINE excess(const LineV<D>& line, hn::Vec<D> x, hn::Vec<D> y) {
  return hn::Sub(line.c, dot(line.x, line.y, x, y));
}

/// What is asked of the lanes of a pack, and how far they are.
template <class D>
struct Pack {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Id = hn::Vec<hn::RebindToUnsigned<D>>;

  D d;
  Id id;                        ///< which problem
  V px, py, speed, hard_count;  ///< preferred velocity, disc as given, hard lines
  V slack, noise, disc, disc_squared;
  V vx, vy;
  V level;                        ///< of the relaxation phase, m/s: what the soft lines of the basis are violated by
  LineV<D> first, second, third;  ///< the basis
  LineV<D> entering;              ///< the line violated most
  M violated;                     ///< lanes that have one
  M relaxing;                     ///< lanes on the relaxation phase
  std::size_t numbered = 0;       ///< while a lane relaxes, this many lines have numbers: among them all hard ones

  HWY_INLINE void derive() {
    const T u = sizeof(T) == 8 ? static_cast<T>(0x1p-53) : static_cast<T>(0x1p-24);
    slack = hn::Mul(speed, hn::Set(d, T(kSlackUnits) * u));
    noise = hn::Mul(speed, hn::Set(d, T(kNoiseUnits) * u));
    disc = hn::Mul(speed, hn::Set(d, T(1) - T(kDiscUnits) * u));
    disc_squared = hn::Mul(disc, disc);
  }

  HWY_INLINE M none() const { return hn::MaskFromVec(hn::Zero(d)); }
  HWY_INLINE M exists(const LineV<D>& line) const {
    return hn::Gt(hn::Max(hn::Abs(line.x), hn::Abs(line.y)), hn::Zero(d));
  }
  /// Where no line is hard numbers may be missing, and hard_count is 0.
  HWY_INLINE M is_soft(const LineV<D>& line) const {
    const M hard = hn::And(hn::Ge(line.index, hn::Zero(d)), hn::Lt(line.index, hard_count));
    return hn::AndNot(hard, exists(line));
  }

  /// Lanes whose squares neither overflow nor lose digits.
  HWY_INLINE M in_range() const {
    const V limit = hn::Mul(speed, speed), most = hn::Max(dot(px, py, px, py), limit);
    return hn::And(hn::Ge(limit, hn::Set(d, kLeastSquare<T>)), hn::Le(most, hn::Set(d, kMostSquare<T>)));
  }

  /// The optimum of the disc alone. The first step sets the working set.
  HWY_INLINE void start() {
    const T u = sizeof(T) == 8 ? static_cast<T>(0x1p-53) : static_cast<T>(0x1p-24);
    const V squared = dot(px, py, px, py);
    const V limit = hn::Mul(hn::Mul(speed, speed), hn::Set(d, T(1) - T(kDiscUnits) * u));
    const M inside = hn::Le(squared, limit);
    vx = px;
    vy = py;
    if (!hn::AllTrue(d, inside)) {
      const V shrink = hn::Div(disc, hn::Sqrt(hn::Max(squared, limit)));
      vx = pick(inside, px, hn::Mul(px, shrink));
      vy = pick(inside, py, hn::Mul(py, shrink));
    }
    level = hn::Zero(d);
    relaxing = none();
    third = no_line(d);
    entering.index = third.index;
  }
};

/// What is asked of a line: violated by more than `allowed` after `soft` or, where it is hard, `hard` has been added.
template <class D>
struct Asked {
  hn::Vec<D> allowed, hard, soft;
};

/// What is asked for while lines are priced, one line of the cache with each: of the pack that comes next, for the
/// first cache, and of a block some way beyond it, for the second.
template <class T>
struct Ahead {
  const T* next = nullptr;
  const T* beyond = nullptr;
};

/// Which of these.
enum class Ask { nothing, next, both };

/// The line violated most a lane, and by how much.
template <class D>
struct Most {
  hn::Vec<D> by;
  LineV<D> line;
};

/// The same among lines from `first` to `last` too. Three masked moves a line cost less than its number and a look at
/// the line afterwards: they are one operation each with AVX-512, and with AVX2 on AMD's processors. Where no lane
/// relaxes nothing is added (kExtra false).
template <bool kHard, bool kExtra, bool kNumber, Ask kAsk, class D, class T>
HWY_INLINE void find_most(const Rows<T>& rows, std::size_t first, std::size_t last, const Pack<D>& p,
                          const Asked<D>& asked, const Ahead<T>& ahead, Most<D>& found) {
  const D d;
  using V = hn::Vec<D>;
  const V one = hn::Set(d, T(1)), vx = p.vx, vy = p.vy, hard_count = p.hard_count;
  V most = found.by, ex = found.line.x, ey = found.line.y, ec = found.line.c, index = found.line.index,
    number = hn::Set(d, static_cast<T>(first));
  const T *nx = rows.x, *ny = rows.y, *c = rows.c, *beyond = ahead.beyond;
  const std::size_t stride = rows.stride, end = last * stride;
#pragma GCC unroll 2
  for (std::size_t at = first * stride; at < end; at += stride) {  // one index for all arrays
    if (kAsk != Ask::nothing) hwy::Prefetch(ahead.next + at);
    if (kAsk == Ask::both) for_second_cache(beyond), beyond += hn::MaxLanes(D());
    const V x = hn::LoadU(d, nx + at), y = hn::LoadU(d, ny + at), offset = hn::LoadU(d, c + at);
    V by = hn::Sub(offset, dot(x, y, vx, vy));
    if (kExtra) by = hn::Add(by, kHard ? pick(hn::Lt(number, hard_count), asked.hard, asked.soft) : asked.soft);
    const auto more = hn::Gt(by, most);
    most = hn::Max(most, by);
    ex = pick(more, x, ex);
    ey = pick(more, y, ey);
    ec = pick(more, offset, ec);
    if (kNumber) {
      index = pick(more, number, index);
      number = hn::Add(number, one);
    }
  }
  if (kExtra && !kNumber) index = pick(hn::Gt(most, found.by), hn::Set(d, T(kNoLine)), index);
  found = {most, {ex, ey, ec, index}};
}

/// The line violated most a lane, as the line that enters. On the feasibility phase all lines carry the slack; on the
/// second only the hard ones do, and soft ones count from `level` on. The level is taken off the soft ones rather than
/// added to the hard ones: it may be many times the speed, and its rounding would then exceed the slack. The number of
/// the line is kept with kIndex and, where hard lines are told by it, while a lane relaxes.
///
/// While something is asked for ahead, in the first three rounds, no lane relaxes yet: that takes three lines.
template <bool kHard, bool kIndex, Ask kAsk, class D, class T>
HWY_INLINE void price(const Rows<T>& rows, Pack<D>& p, const Ahead<T>& ahead = {}) {
  const D d;
  using V = hn::Vec<D>;
  const V zero = hn::Zero(d), in_search = hn::Sub(p.noise, p.slack);
  const LineV<D> none = {zero, zero, zero, hn::Set(d, T(kNoLine))};
  if (kAsk != Ask::nothing) {
    Most<D> most = {in_search, none};
    find_most<kHard, false, kIndex, kAsk>(rows, 0, rows.count, p, {in_search, zero, zero}, ahead, most);
    p.violated = hn::Gt(most.by, in_search);
    p.entering = {most.line.x, most.line.y, hn::Add(most.line.c, p.slack), kIndex ? most.line.index : p.entering.index};
    return;
  }
  const V enough = kHard ? p.noise : hn::Add(p.level, p.noise);
  const Asked<D> asked = {pick(p.relaxing, enough, in_search), hn::IfThenElseZero(p.relaxing, p.slack),
                          hn::IfThenElseZero(p.relaxing, hn::Neg(p.level))};
  Most<D> most = {asked.allowed, none};
  if (kHard && !hn::AllFalse(d, p.relaxing)) {
    find_most<kHard, true, true, kAsk>(rows, 0, p.numbered, p, asked, ahead, most);
    find_most<false, true, false, kAsk>(rows, p.numbered, rows.count, p, asked, ahead, most);
  } else {
    find_most<kHard, false, kIndex, kAsk>(rows, 0, rows.count, p, asked, ahead, most);
  }
  p.violated = hn::Gt(most.by, asked.allowed);
  auto with_slack = hn::Not(p.relaxing);
  if (kHard) {
    const auto is_hard = hn::And(hn::Ge(most.line.index, zero), hn::Lt(most.line.index, p.hard_count));
    with_slack = hn::Or(with_slack, is_hard);
  }
  p.entering.x = most.line.x;
  p.entering.y = most.line.y;
  p.entering.c = hn::Add(most.line.c, hn::IfThenElseZero(with_slack, p.slack));
  if (kIndex || kHard) p.entering.index = most.line.index;
}

/// The numbers of the lines of the basis, in the lanes of `which`, where they were not kept: the first of the first
/// `count` lines that is the same, or none. REQUIRES: lanes whose basis carries the slack.
template <class D, class T>
HWY_INLINE void number_basis(const Rows<T>& rows, std::size_t count, hn::Mask<D> which, Pack<D>& p) {
  using V = hn::Vec<D>;
  const D d;
  LineV<D>* const basis[] = {&p.first, &p.second, &p.third};
  for (LineV<D>* line : basis) line->index = pick(which, hn::Set(d, T(kNoLine)), line->index);
  for (std::size_t k = count; k-- > 0;) {
    const std::size_t at = k * rows.stride;
    const V x = hn::LoadU(d, rows.x + at), y = hn::LoadU(d, rows.y + at);
    const V c = hn::Add(hn::LoadU(d, rows.c + at), p.slack), number = hn::Set(d, static_cast<T>(k));
    for (LineV<D>* line : basis) {
      const auto same = hn::And(hn::Eq(line->x, x), hn::And(hn::Eq(line->y, y), hn::Eq(line->c, c)));
      line->index = pick(hn::And(which, same), number, line->index);
    }
  }
}

/// 1 / |n|^2 of a normal of length within 2^-10 of 1, by multiplying: a divider takes one register at a time, and a
/// step has enough for it to do. Wrong by e in |n|^2, 2 - |n|^2 is wrong by e^2, and each of Newton's steps squares
/// that again: from e <= 2^-8, 2^-64 after two, 2^-32 after one. Rounding adds 2 u.
template <class D, class V>
HWY_INLINE V inverse_of_square(D d, V squared) {
  const V two = hn::Set(d, hn::TFromD<D>(2));
  V inverse = hn::Sub(two, squared);
  for (int k = 0; k < (sizeof(hn::TFromD<D>) == 8 ? 2 : 1); ++k)
    inverse = hn::Mul(inverse, hn::Sub(two, hn::Mul(squared, inverse)));
  return inverse;
}

/// Where `other` cuts the boundary of `line` off. Parallel lines are taken for very nearly so: a nudge that is lost in
/// any other slope stands for 0.
template <class D, class V>
HWY_INLINE V cut_off(D d, const LineV<D>& line, V squared, const LineV<D>& other, V& low, V& high) {
  using T = hn::TFromD<D>;
  const V slope = hn::Add(cross(line, other), hn::Set(d, kParallel<T>));
  const V missing = hn::Sub(hn::Mul(other.c, squared), hn::Mul(dot(line.x, line.y, other.x, other.y), line.c));
  const V cut = hn::Div(missing, slope);
  const auto raises = hn::Gt(slope, hn::Zero(d));
  low = pick(raises, hn::Max(low, cut), low);
  high = pick(raises, high, hn::Min(high, cut));
  return cut;
}

/// A round of the feasibility phase for the lanes in `moving`: the optimum on the boundary of `entering`, of the kKept
/// lines of the working set those that bind. Gives the lanes where nothing is left: entering, first and second
/// contradict.
///
/// The boundary is v = (c n + s n') / |n|^2, n' being n turned left, and each line of the working set cuts it off at an
/// s of its own. Masks cost more than numbers, so what binds is found by comparing with that s. The disc is asked only
/// where the s found lies beyond it.
template <int kKept, bool kIndex, class D>
HWY_INLINE hn::Mask<D> step(Pack<D>& p, hn::Mask<D> moving) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  const D d;
  const LineV<D> h = p.entering;
  const V squared = dot(h.x, h.y, h.x, h.y);
  const V inverse = inverse_of_square(d, squared);
  const V far = hn::Set(d, hwy::HighestValue<T>());
  V low = hn::Neg(far), high = far;
  V cut_first = hn::Zero(d), cut_second = cut_first;
  if (kKept > 0) cut_first = cut_off(p.d, h, squared, p.first, low, high);
  if (kKept > 1) cut_second = cut_off(p.d, h, squared, p.second, low, high);
  const V wish = cross(h.x, h.y, p.px, p.py);
  V where = hn::Min(hn::Max(wish, low), high);
  const V room = hn::Sub(hn::Mul(p.disc_squared, squared), hn::Mul(h.c, h.c));
  const M beyond = hn::And(moving, hn::Gt(hn::Mul(where, where), room));
  M empty = hn::Gt(low, high);
  if (!hn::AllFalse(d, beyond)) {
    const V reach = hn::Sqrt(hn::Max(room, hn::Zero(d)));
    low = hn::Max(low, hn::Neg(reach));
    high = hn::Min(high, reach);
    where = hn::Min(hn::Max(wish, low), high);
    empty = hn::Or(hn::Gt(low, high), hn::Lt(room, hn::Zero(d)));
  }
  const M moves = hn::AndNot(empty, moving);
  p.vx = pick(moves, hn::Mul(hn::Sub(hn::Mul(h.x, h.c), hn::Mul(where, h.y)), inverse), p.vx);
  p.vy = pick(moves, hn::Mul(hn::Add(hn::Mul(h.y, h.c), hn::Mul(where, h.x)), inverse), p.vy);
  const LineV<D> none = no_line(d);
  if (kKept == 0) {
    p.second = none;
    p.first = pick<kIndex>(moves, h, none);
    return hn::And(moving, empty);
  }
  LineV<D> kept = none;
  if (kKept > 1) kept = pick<kIndex>(hn::Eq(where, cut_second), p.second, kept);
  kept = pick<kIndex>(hn::Eq(where, cut_first), p.first, kept);
  p.second = pick<kIndex>(moves, kept, p.second);
  p.first = pick<kIndex>(moves, h, p.first);
  return hn::And(moving, empty);
}

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
