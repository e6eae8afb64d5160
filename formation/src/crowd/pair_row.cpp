// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/pair_row.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/pair_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/entries.h"

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

using Places = Entries<Whole>;

HWY_INLINE N numbers(const std::int32_t* column, const Places& at) {
  return hn::PromoteTo(Numbers(), at.of(column));
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

/// A normal, and the room that is left between the two robots along it.
struct Split {
  Point normal;
  N room;            ///< N.(D + u_a - u_b) - bar, >= 0 where the normal separates
  N need_a, need_b;  ///< of it, for the wishes
  M separates;

  HWY_INLINE M contents_both() const { return hn::Le(hn::Add(need_a, need_b), room); }
};

/// The rows of both robots.
struct Rows {
  Point normal;
  N least_a, least_b;
  hn::Vec<Whole> flags;
};

/// As many pairs as there are lanes.
template <bool kAtRest>
class PairLanes {
 public:
  /// The pairs of the robots at places a and b.
  HWY_INLINE PairLanes(const MotionColumns& of, const Places& a, const Places& b, N radius)
      : d_{difference(of.x, a, b), difference(of.y, a, b)},
        wish_a_{numbers(of.wish_x, a), numbers(of.wish_y, a)},
        wish_b_{numbers(of.wish_x, b), numbers(of.wish_y, b)},
        radius_(radius) {
    if constexpr (kAtRest) {
      safe_a_ = safe_b_ = {number(0.0), number(0.0)};
      safe_end_ = d_;
      more_a_ = wish_a_;
      more_b_ = wish_b_;
    } else {
      safe_a_ = {numbers(of.safe_x, a), numbers(of.safe_y, a)};
      safe_b_ = {numbers(of.safe_x, b), numbers(of.safe_y, b)};
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

  /// The rows of a normal that separates, elsewhere `otherwise` as the normal of rows through 0.
  HWY_INLINE Rows rows(const Split& s, Point otherwise) const {
    const N zero = number(0.0), part = part_a(s);
    N least_a = hn::Neg(part), least_b = hn::Sub(part, s.room);
    if constexpr (!kAtRest) {
      least_a = hn::Add(dot(s.normal, safe_a_), least_a);
      least_b = hn::Sub(least_b, dot(s.normal, safe_b_));
    }
    const M grants_a = hn::And(s.separates, hn::Ge(dot(s.normal, wish_a_), least_a)),
            grants_b = hn::And(s.separates, hn::Ge(hn::Neg(dot(s.normal, wish_b_)), least_b));
    Rows r;
    r.normal = choose(s.separates, s.normal, otherwise);
    r.least_a = hn::IfThenElseZero(s.separates, least_a);
    r.least_b = hn::IfThenElseZero(s.separates, least_b);
    const M found = hn::Or(hn::Ne(r.normal.x, zero), hn::Ne(r.normal.y, zero));
    const auto flag = [](M m, std::int32_t value) { return hn::IfThenElseZero(m, number(value)); };
    r.flags = hn::DemoteTo(Whole(),
                           hn::Add(flag(found, PairTable::kFound),
                                   hn::Add(flag(grants_a, PairTable::kGrantsA), flag(grants_b, PairTable::kGrantsB))));
    return r;
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
  static HWY_INLINE N difference(const std::int32_t* column, const Places& a, const Places& b) {
    return hn::PromoteTo(Numbers(), hn::Sub(a.of(column), b.of(column)));
  }

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

/// Rows along the centres, which are the best ones where both wishes have room; of the other pairs those of the normal
/// that hinders least, or of one on the way from it to the centres.
template <bool kAtRest>
class RowMaker {
 public:
  RowMaker(const MotionColumns& robots, PairTable& pairs) : robots_(robots), pairs_(pairs) {}

  void make(std::size_t first) {
    std::size_t open = 0;
    for (std::size_t k = first; k < pairs_.size(); k += hn::Lanes(Numbers())) {
      const Lanes lanes(robots_, Places(hn::LoadU(Whole(), &pairs_.a[k])), Places(hn::LoadU(Whole(), &pairs_.b[k])),
                        hn::LoadU(Numbers(), &pairs_.radii[k]));
      const Split s = lanes.split_along(lanes.centre());
      put(lanes.rows(s, lanes.last_resort()), k);
      std::uint32_t rest = bits_of_mask(hn::Not(hn::And(s.separates, s.contents_both())));
      rest &= lanes_of(pairs_.size() - k);
      for (; rest != 0; rest &= rest - 1) pairs_.open[open++] = static_cast<std::int32_t>(k) + __builtin_ctz(rest);
    }
    const std::size_t left = make_wanted(open);
    make_bent(left);
  }

 private:
  using Lanes = PairLanes<kAtRest>;

  /// Bits of the lanes that hold one of `count` pairs.
  static HWY_INLINE std::uint32_t lanes_of(std::size_t count) {
    return (1U << std::min(count, hn::Lanes(Numbers()))) - 1U;
  }

  HWY_INLINE void put(const Rows& rows, std::size_t k) const {
    const Numbers d;
    hn::StoreU(rows.normal.x, d, &pairs_.normal_x[k]);
    hn::StoreU(rows.normal.y, d, &pairs_.normal_y[k]);
    hn::StoreU(rows.least_a, d, &pairs_.least_a[k]);
    hn::StoreU(rows.least_b, d, &pairs_.least_b[k]);
    hn::StoreU(rows.flags, Whole(), &pairs_.flags[k]);
  }

  /// Those from place k of `open` on.
  HWY_INLINE Lanes open_lanes(std::size_t k) const {
    const Whole d;
    const auto pair = hn::LoadU(d, &pairs_.open[k]);
    const auto wide = hn::PromoteTo(hn::RebindToSigned<Numbers>(), pair);
    const Places at(pair);
    return {robots_, Places(at.of(pairs_.a.data())), Places(at.of(pairs_.b.data())),
            hn::GatherIndex(Numbers(), pairs_.radii.data(), wide)};
  }

  /// The rows of `lanes` to the open pairs from place k on.
  HWY_INLINE void put_open(const Rows& rows, std::uint32_t lanes, std::size_t k) const {
    const Numbers d;
    HWY_ALIGN double x[kPack], y[kPack], least_a[kPack], least_b[kPack];
    HWY_ALIGN std::int32_t flags[kPack];
    hn::Store(rows.normal.x, d, x);
    hn::Store(rows.normal.y, d, y);
    hn::Store(rows.least_a, d, least_a);
    hn::Store(rows.least_b, d, least_b);
    hn::Store(rows.flags, Whole(), flags);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(lanes));
      const auto pair = static_cast<std::size_t>(pairs_.open[k + lane]);
      pairs_.normal_x[pair] = x[lane], pairs_.normal_y[pair] = y[lane];
      pairs_.least_a[pair] = least_a[lane], pairs_.least_b[pair] = least_b[lane];
      pairs_.flags[pair] = flags[lane];
    }
  }

  /// Places to a multiple of the lanes.
  void fill_open(std::size_t count) const {
    for (std::size_t k = count; k < count + kPack; ++k) pairs_.open[k] = 0;
  }

  /// Leaves in `open` pairs whose wanted normal does not separate, and that in wanted_x and wanted_y; how many.
  HWY_INLINE std::size_t make_wanted(std::size_t count) {
    const Numbers d;
    std::size_t left = 0;
    fill_open(count);
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
      const Lanes lanes = open_lanes(k);
      const Point wanted = lanes.wanted();
      const Split s = lanes.split_along(wanted);
      const std::uint32_t there = lanes_of(count - k), separates = bits_of_mask(s.separates);
      put_open(lanes.rows(s, {number(0.0), number(0.0)}), separates & there, k);
      std::uint32_t rest = ~separates & there;
      if (rest == 0) continue;
      HWY_ALIGN double x[kPack], y[kPack];
      hn::Store(wanted.x, d, x);
      hn::Store(wanted.y, d, y);
      for (; rest != 0; rest &= rest - 1, ++left) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(rest));
        pairs_.open[left] = pairs_.open[k + lane];
        pairs_.wanted_x[left] = x[lane], pairs_.wanted_y[left] = y[lane];
      }
    }
    return left;
  }

  HWY_INLINE void make_bent(std::size_t count) {
    const Numbers d;
    fill_open(count);
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
      const Lanes lanes = open_lanes(k);
      const Split s = lanes.bent({hn::LoadU(d, &pairs_.wanted_x[k]), hn::LoadU(d, &pairs_.wanted_y[k])});
      put_open(lanes.rows(s, {number(0.0), number(0.0)}), bits_of_mask(s.separates) & lanes_of(count - k), k);
    }
  }

  const MotionColumns& robots_;
  PairTable& pairs_;
};

void make_all_rows(const MotionColumns& robots, PairTable& pairs, std::size_t first) {
  robots.safe_x == nullptr ? RowMaker<true>(robots, pairs).make(first) : RowMaker<false>(robots, pairs).make(first);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(make_all_rows);

void PairTable::make_room() {
  const std::size_t room = 2 * a.size() + 4 * kPack;
  for (auto* column : {&a, &b, &flags, &open}) column->resize(room);
  for (auto* column : {&radii, &normal_x, &normal_y, &least_a, &least_b, &wanted_x, &wanted_y}) column->resize(room);
  before.resize(2 * room);
  room_ = room - 2 * kPack;
}

void make_pair_rows(const MotionColumns& robots, PairTable& pairs, std::size_t first) {
  pairs.pad();
  HWY_DYNAMIC_DISPATCH(make_all_rows)(robots, pairs, first);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
