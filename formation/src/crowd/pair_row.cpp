// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/pair_row.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/pair_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = hn::CappedTag<double, kPack>;
using Whole = hn::Rebind<std::int32_t, Numbers>;
using N = hn::Vec<Numbers>;
using M = hn::Mask<Numbers>;

/// Length of normals in lattice steps. D is below 2^31, so N.D is below 2^52: whole in double too.
constexpr double kNormalLength = 0x1p20;

/// Halvings between the normal that hinders least and one that separates.
constexpr int kBends = 5;

HWY_INLINE N number(double value) {
  return hn::Set(Numbers(), value);
}

HWY_INLINE N load(const std::int32_t* column) {
  return hn::PromoteTo(Numbers(), hn::LoadU(Whole(), column));
}

HWY_INLINE std::uint32_t bits_of_mask(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Numbers(), mask, bytes);
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U;
}

struct Point {
  N x, y;
};

HWY_INLINE Point operator+(Point a, Point b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y)};
}
HWY_INLINE Point operator-(Point a, Point b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y)};
}
HWY_INLINE Point operator*(N s, Point a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y)};
}
HWY_INLINE N dot(Point a, Point b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y));
}
HWY_INLINE N cross(Point a, Point b) {
  return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x));
}
HWY_INLINE Point choose(M first, Point a, Point b) {
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y)};
}

/// The point nearest to 0 of the segment ab.
HWY_INLINE Point nearest_of_segment(Point a, Point b) {
  const N zero = number(0.0);
  const Point along = b - a;
  const N length = dot(along, along);
  const N share = hn::Div(hn::Neg(dot(a, along)), length);
  const Point inside = a + hn::Min(hn::Max(share, zero), number(1.0)) * along;
  return choose(hn::Gt(length, zero), inside, a);
}

/// The point nearest to 0 of { from + s a - t b : s, t in [0, 1] }, 0 where 0 is inside.
HWY_INLINE Point nearest_of_parallelogram(Point from, Point a, Point b) {
  const N zero = number(0.0);
  const Point corners[5] = {from, from + a, from + a - b, from - b, from};
  Point nearest = from;
  N least = dot(from, from);
  M left = hn::Lt(zero, zero), right = left;
  for (int k = 0; k < 4; ++k) {
    const Point p = corners[k], q = corners[k + 1], x = nearest_of_segment(p, q);
    const N squared = dot(x, x);
    const M is_nearer = hn::Lt(squared, least);
    nearest = choose(is_nearer, x, nearest);
    least = hn::IfThenElse(is_nearer, squared, least);
    const N side = cross(p, q);
    left = hn::Or(left, hn::Gt(side, zero));
    right = hn::Or(right, hn::Lt(side, zero));
  }
  const M inside = hn::AndNot(hn::And(left, right), hn::Ne(cross(a, b), zero));
  return choose(inside, {zero, zero}, nearest);
}

/// ORCA's normal for the relative motion m with the step as horizon: the boundary of the velocity obstacle nearest to
/// m.
HWY_INLINE Point reciprocal_normal(Point d, Point m, N radius) {
  const N zero = number(0.0);
  const Point end = d + m;
  const N along = dot(end, d), squared_end = dot(end, end), squared = dot(d, d), contact = hn::Mul(radius, radius);
  const M at_end = hn::And(hn::Gt(along, zero), hn::Ge(hn::Mul(along, along), hn::Mul(contact, squared_end)));
  const N leg = hn::Sqrt(hn::Max(zero, hn::Sub(squared, contact)));
  const N turn = hn::IfThenElse(hn::Ge(cross(d, end), zero), leg, hn::Neg(leg));
  const Point of_leg = {hn::Sub(hn::Mul(radius, d.x), hn::Mul(turn, d.y)),
                        hn::Add(hn::Mul(radius, d.y), hn::Mul(turn, d.x))};
  return choose(at_end, end, of_leg);
}

/// Of a normal what is left between the two robots along it.
struct Split {
  Point normal;
  N room;            ///< N.(D + u_a - u_b) - bar, >= 0 where the normal separates
  N need_a, need_b;  ///< of it, for the wishes
  M separates;

  HWY_INLINE M contents_both() const { return hn::Le(hn::Add(need_a, need_b), room); }
};

/// As many pairs as there are lanes.
template <bool kAtRest>
class PairLanes {
 public:
  /// Those from lane k of a block on.
  HWY_INLINE PairLanes(const PairBlock& t, std::size_t k)
      : d_{load(t.dx + k), load(t.dy + k)},
        wish_a_{load(t.wish_ax + k), load(t.wish_ay + k)},
        wish_b_{load(t.wish_bx + k), load(t.wish_by + k)},
        radius_(hn::Load(Numbers(), t.radius + k)) {
    if constexpr (kAtRest) {
      safe_a_ = safe_b_ = {number(0.0), number(0.0)};
      safe_end_ = d_;
      more_a_ = wish_a_;
      more_b_ = wish_b_;
    } else {
      safe_a_ = {load(t.safe_ax + k), load(t.safe_ay + k)};
      safe_b_ = {load(t.safe_bx + k), load(t.safe_by + k)};
      safe_end_ = d_ + safe_a_ - safe_b_;
      more_a_ = wish_a_ - safe_a_;
      more_b_ = wish_b_ - safe_b_;
    }
  }

  /// Between the two centres: separates the two, unless they touch or u leads round.
  HWY_INLINE Point centre() const { return kAtRest ? d_ : nearest_of_segment(d_, safe_end_); }

  /// The whole normal along `direction`. Does not separate where that has no length.
  HWY_INLINE Split split_along(Point direction) const {
    const N zero = number(0.0), per_length = hn::Div(number(kNormalLength), hn::Sqrt(dot(direction, direction)));
    Split s;
    s.normal = {hn::Round(hn::Mul(per_length, direction.x)), hn::Round(hn::Mul(per_length, direction.y))};
    // R |N| in double is off by at most 2^-52 of less than 2^52: by less than 2.
    const N bar = hn::Add(hn::Floor(hn::Mul(radius_, hn::Sqrt(dot(s.normal, s.normal)))), number(2.0));
    const N across = dot(s.normal, d_), at_end = kAtRest ? across : dot(s.normal, safe_end_);
    s.separates = hn::And(hn::Ge(across, bar), hn::Ge(at_end, bar));
    s.room = hn::Sub(at_end, bar);
    s.need_a = hn::Max(zero, hn::Neg(dot(s.normal, more_a_)));
    s.need_b = hn::Max(zero, dot(s.normal, more_b_));
    return s;
  }

  /// The direction of the normal that hinders the wishes least.
  HWY_INLINE Point wanted() const {
    const Point nearest = nearest_of_parallelogram(safe_end_, more_a_, more_b_);
    const M crosses = hn::Lt(dot(nearest, nearest), number(1.0));
    if (hn::AllFalse(Numbers(), crosses)) return nearest;
    return choose(crosses, reciprocal_normal(d_, wish_a_ - wish_b_, radius_), nearest);
  }

  /// Between `wanted`, which does not separate, and the centres.
  HWY_INLINE Split bent(Point wanted) const {
    const N one = number(1.0), zero = number(0.0);
    const Point middle = centre();
    const N far = hn::Sqrt(dot(wanted, wanted)), near = hn::Sqrt(dot(middle, middle));
    const M has_lengths = hn::And(hn::Gt(far, zero), hn::Gt(near, zero));
    const Point from = hn::Div(one, near) * middle, to = hn::Div(one, far) * wanted;
    N low = zero, high = one;  // low separates, if the centres do
    Split best = {from, zero, zero, zero, hn::Lt(zero, zero)};
    for (int k = 0; k < kBends; ++k) {
      const N share = hn::Mul(hn::Add(low, high), number(0.5));
      Split s = split_along(hn::Sub(one, share) * from + share * to);
      s.separates = hn::And(s.separates, has_lengths);
      low = hn::IfThenElse(s.separates, share, low);
      high = hn::IfThenElse(s.separates, high, share);
      take(s.separates, s, best);
    }
    return best;
  }

  /// Lemma 2. A robot whose wish has room gets what it needs; what is left is halved, what is missing shared in
  /// proportion.
  HWY_INLINE N part_a(const Split& s) const {
    const N needs = hn::Add(s.need_a, s.need_b);
    const N halved = hn::Add(s.need_a, hn::Floor(hn::Mul(hn::Sub(s.room, needs), number(0.5))));
    const N shared = hn::Floor(hn::Div(hn::Mul(s.room, s.need_a), needs));
    const N part = hn::IfThenElse(s.contents_both(), halved, shared);
    return hn::Min(hn::Max(part, number(0.0)), s.room);
  }

  /// Into lanes k and after of a block the rows of a normal that separates, elsewhere `otherwise` as normals of rows
  /// through 0.
  HWY_INLINE void put_rows(const Split& s, Point otherwise, PairBlock& to, std::size_t k) const {
    const Numbers d;
    const N zero = number(0.0), part = part_a(s), rest = hn::Sub(s.room, part);
    const M is_a = hn::Ne(load(to.is_a + k), zero);
    Point normal = choose(is_a, s.normal, {hn::Neg(s.normal.x), hn::Neg(s.normal.y)});
    N least = hn::Neg(hn::IfThenElse(is_a, part, rest));
    if constexpr (!kAtRest) least = hn::Add(dot(normal, choose(is_a, safe_a_, safe_b_)), least);
    const M grants = hn::And(s.separates, hn::Ge(dot(normal, choose(is_a, wish_a_, wish_b_)), least));
    otherwise = choose(is_a, otherwise, {hn::Neg(otherwise.x), hn::Neg(otherwise.y)});
    normal = choose(s.separates, normal, otherwise);
    const M found = hn::Or(hn::Ne(normal.x, zero), hn::Ne(normal.y, zero));
    hn::Store(normal.x, d, to.normal_x + k);
    hn::Store(normal.y, d, to.normal_y + k);
    least = hn::IfThenElseZero(s.separates, least);
    hn::Store(least, d, to.least + k);
    const N length = hn::Sqrt(dot(normal, normal));
    hn::Store(hn::Div(normal.x, length), d, to.unit_x + k);
    hn::Store(hn::Div(normal.y, length), d, to.unit_y + k);
    hn::Store(hn::Div(least, length), d, to.unit_least + k);
    if (k == 0) to.found = to.grants = 0;
    to.found |= bits_of_mask(found) << k;
    to.grants |= bits_of_mask(grants) << k;
  }

  /// Lemma 3. In one place: the lower id leaves to the left. Where u is not rest: no normal.
  HWY_INLINE Point last_resort() const {
    const N zero = number(0.0);
    const M together = hn::And(hn::Eq(d_.x, zero), hn::Eq(d_.y, zero));
    const Point apart = {hn::IfThenElse(together, number(-1.0), d_.x), d_.y};
    if constexpr (kAtRest) return apart;
    const Point moves = {hn::Or(hn::Abs(safe_a_.x), hn::Abs(safe_a_.y)),
                         hn::Or(hn::Abs(safe_b_.x), hn::Abs(safe_b_.y))};
    return choose(hn::Eq(hn::Or(moves.x, moves.y), zero), apart, {zero, zero});
  }

 private:
  static HWY_INLINE void take(M lanes, const Split& from, Split& to) {
    to.normal = choose(lanes, from.normal, to.normal);
    to.room = hn::IfThenElse(lanes, from.room, to.room);
    to.need_a = hn::IfThenElse(lanes, from.need_a, to.need_a);
    to.need_b = hn::IfThenElse(lanes, from.need_b, to.need_b);
    to.separates = hn::Or(to.separates, lanes);
  }

  Point d_, wish_a_, wish_b_, safe_a_, safe_b_, safe_end_, more_a_, more_b_;
  N radius_;
};

/// Pairs that wait for better rows until a block of them is full. Normals of rows stand for directions before.
template <bool kAtRest>
class Waiting {
 public:
  explicit Waiting(PairBlock* of) : of_(of) {}

  PairBlock block = {};

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  bool is_full() const { return count_ == kPack; }
  /// Where pair k comes from.
  std::size_t at(std::size_t k) const { return at_[k]; }
  /// Takes a pair that comes from `at` from place k of a block; where.
  std::size_t add(std::size_t at, const PairBlock& from, std::size_t k) {
    block.copy(count_, from, k, kAtRest);
    at_[count_] = at;
    return count_++;
  }
  /// The rows of pairs that have some, to where they come from.
  void give_back() {
    for (std::size_t k = 0; k < count_; ++k) {
      if ((block.found >> k & 1U) == 0) continue;
      const std::size_t to = at_[k] % kPack;
      PairBlock& out = of_[at_[k] / kPack];
      out.normal_x[to] = block.normal_x[k];
      out.normal_y[to] = block.normal_y[k];
      out.least[to] = block.least[k];
      out.unit_x[to] = block.unit_x[k];
      out.unit_y[to] = block.unit_y[k];
      out.unit_least[to] = block.unit_least[k];
      out.found |= 1U << to;
      out.grants = (out.grants & ~(1U << to)) | (block.grants >> k & 1U) << to;
    }
    count_ = 0;
  }

 private:
  PairBlock* of_;
  std::size_t at_[kPack], count_ = 0;
};

/// Pairs that have no room for both wishes along their centres: the normal that hinders least, or one on the way from
/// it to the centres.
template <bool kAtRest>
class Hindered {
 public:
  explicit Hindered(PairBlock* of) : wait_(of), bend_(of) {}

  void add(std::size_t at, const PairBlock& block, std::size_t k) {
    wait_.add(at, block, k);
    if (wait_.is_full()) make_wanted();
  }

  void finish() {
    if (!wait_.empty()) make_wanted();
    if (!bend_.empty()) make_bent();
  }

 private:
  HWY_INLINE void make_wanted() {
    PairBlock& block = wait_.block;
    const Numbers d;
    for (std::size_t k = 0; k < wait_.count(); k += hn::Lanes(d)) {
      const PairLanes<kAtRest> pairs(block, k);
      const Point wanted = pairs.wanted();
      const Split s = pairs.split_along(wanted);
      pairs.put_rows(s, {number(0.0), number(0.0)}, block, k);
      std::uint32_t rest = bits_of_mask(hn::Not(s.separates));
      if (wait_.count() - k < hn::Lanes(d)) rest &= (1U << (wait_.count() - k)) - 1U;
      if (rest == 0) continue;
      alignas(64) double x[kPack], y[kPack];
      hn::Store(wanted.x, d, x);
      hn::Store(wanted.y, d, y);
      for (; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(rest));
        const std::size_t to = bend_.add(wait_.at(k + lane), block, k + lane);
        bend_.block.normal_x[to] = x[lane];
        bend_.block.normal_y[to] = y[lane];
        if (bend_.is_full()) make_bent();
      }
    }
    wait_.give_back();
  }

  HWY_INLINE void make_bent() {
    PairBlock& block = bend_.block;
    const Numbers d;
    for (std::size_t k = 0; k < bend_.count(); k += hn::Lanes(d)) {
      const PairLanes<kAtRest> pairs(block, k);
      const Point wanted = {hn::Load(d, block.normal_x + k), hn::Load(d, block.normal_y + k)};
      pairs.put_rows(pairs.bent(wanted), {number(0.0), number(0.0)}, block, k);
    }
    bend_.give_back();
  }

  Waiting<kAtRest> wait_, bend_;
};

/// Rows along the centres, which are the best ones where both wishes have room; of the other pairs those of the best
/// normal that separates.
template <bool kAtRest>
void make_rows(PairBlock* blocks, std::size_t count) {
  Hindered<kAtRest> hindered(blocks);
  for (std::size_t k = 0; k < count; k += hn::Lanes(Numbers())) {
    PairBlock& block = blocks[k / kPack];
    const std::size_t lane = k % kPack;
    const PairLanes<kAtRest> pairs(block, lane);
    const Split s = pairs.split_along(pairs.centre());
    pairs.put_rows(s, pairs.last_resort(), block, lane);
    std::uint32_t rest = bits_of_mask(hn::Not(hn::And(s.separates, s.contents_both())));
    if (count - k < hn::Lanes(Numbers())) rest &= (1U << (count - k)) - 1U;
    for (; rest != 0; rest &= rest - 1) {
      const auto at = static_cast<std::size_t>(__builtin_ctz(rest));
      hindered.add(k + at, block, lane + at);
    }
  }
  hindered.finish();
}

void gather(const MotionColumns& from, const std::int32_t* robot, const std::int32_t* other, std::size_t count,
            PairBlock* to) {
  using Words = hn::CappedTag<std::int32_t, kPack>;
  const Words d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    PairBlock& block = to[k / kPack];
    const std::size_t lane = k % kPack;
    const auto own = hn::LoadU(d, robot + k), its = hn::LoadU(d, other + k);
    const auto is_a = hn::Lt(hn::GatherIndex(d, from.id, own), hn::GatherIndex(d, from.id, its));
    const auto a = hn::IfThenElse(is_a, own, its), b = hn::IfThenElse(is_a, its, own);
    const auto put = [&](auto value, std::int32_t* column) { hn::Store(value, d, column + lane); };
    put(hn::VecFromMask(d, is_a), block.is_a);
    put(hn::Sub(hn::GatherIndex(d, from.x, a), hn::GatherIndex(d, from.x, b)), block.dx);
    put(hn::Sub(hn::GatherIndex(d, from.y, a), hn::GatherIndex(d, from.y, b)), block.dy);
    put(hn::GatherIndex(d, from.wish_x, a), block.wish_ax);
    put(hn::GatherIndex(d, from.wish_y, a), block.wish_ay);
    put(hn::GatherIndex(d, from.wish_x, b), block.wish_bx);
    put(hn::GatherIndex(d, from.wish_y, b), block.wish_by);
    if (from.safe_x == nullptr) continue;
    put(hn::GatherIndex(d, from.safe_x, a), block.safe_ax);
    put(hn::GatherIndex(d, from.safe_y, a), block.safe_ay);
    put(hn::GatherIndex(d, from.safe_x, b), block.safe_bx);
    put(hn::GatherIndex(d, from.safe_y, b), block.safe_by);
  }
}

void make_all_rows(PairBlock* blocks, std::size_t count, bool at_rest) {
  at_rest ? make_rows<true>(blocks, count) : make_rows<false>(blocks, count);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(gather);
HWY_EXPORT(make_all_rows);

void PairBlock::copy(std::size_t k, const PairBlock& of, std::size_t from, bool at_rest) {
  dx[k] = of.dx[from], dy[k] = of.dy[from], radius[k] = of.radius[from], is_a[k] = of.is_a[from];
  wish_ax[k] = of.wish_ax[from], wish_ay[k] = of.wish_ay[from];
  wish_bx[k] = of.wish_bx[from], wish_by[k] = of.wish_by[from];
  if (at_rest) return;
  safe_ax[k] = of.safe_ax[from], safe_ay[k] = of.safe_ay[from];
  safe_bx[k] = of.safe_bx[from], safe_by[k] = of.safe_by[from];
}

void PairTable::put(std::size_t k, const PairInStep& pair, bool is_a) {
  PairBlock& to = blocks_[k / kPack];
  const std::size_t at = k % kPack;
  to.dx[at] = static_cast<std::int32_t>(pair.dx), to.dy[at] = static_cast<std::int32_t>(pair.dy);
  to.radius[at] = static_cast<double>(pair.radius), to.is_a[at] = is_a ? -1 : 0;
  to.wish_ax[at] = pair.wish_a.x, to.wish_ay[at] = pair.wish_a.y;
  to.wish_bx[at] = pair.wish_b.x, to.wish_by[at] = pair.wish_b.y;
  to.safe_ax[at] = pair.safe_a.x, to.safe_ay[at] = pair.safe_a.y;
  to.safe_bx[at] = pair.safe_b.x, to.safe_by[at] = pair.safe_b.y;
}

void gather_pairs(const MotionColumns& from, const std::int32_t* robot, const std::int32_t* other, std::size_t count,
                  PairTable& to) {
  to.lay_out(count, from.safe_x == nullptr);
  HWY_DYNAMIC_DISPATCH(gather)(from, robot, other, count, to.blocks());
}

void make_pair_rows(PairTable& pairs) {
  HWY_DYNAMIC_DISPATCH(make_all_rows)(pairs.blocks(), pairs.size(), pairs.at_rest());
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
