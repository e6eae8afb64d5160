// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/lines.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/lines.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/entries.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The half-plane of one robot against another, one pair per lane.
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

/// 32 bits for each lane of D.
template <class D>
using WordsOf = hn::Rebind<std::int32_t, D>;

template <class D>
HWY_INLINE hn::Vec<D> numbers(D d, hn::Vec<WordsOf<D>> words) {
  if constexpr (sizeof(hn::TFromD<D>) == 8)
    return hn::PromoteTo(d, words);
  else
    return hn::ConvertTo(d, words);
}

template <class D>
HWY_INLINE hn::Vec<D> by_kind(D d, const hn::TFromD<D>* table, hn::Vec<WordsOf<D>> kind) {
  if constexpr (sizeof(hn::TFromD<D>) == 8)
    return hn::GatherIndex(d, table, hn::PromoteTo(hn::RebindToSigned<D>(), kind));
  else
    return hn::GatherIndex(d, table, kind);
}

/// Entries of a table of candidates, one a lane.
template <class D>
class Lookup {
  using Words = WordsOf<D>;
  using W = hn::Vec<Words>;

 public:
  HWY_INLINE Lookup(W at, std::size_t count) : at_(at), entries_(at), pairs_((count + 31) / 32) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    if constexpr (hn::MaxLanes(Words()) == 16) {
      const __m512i pair = _mm512_srli_epi32(at.raw, 5);
      for (int k = 1; k < kPairs; ++k) in_pair_[k] = _mm512_cmpeq_epi32_mask(pair, _mm512_set1_epi32(k));
    }
#endif
  }

  HWY_INLINE W operator()(const std::int32_t* table) const {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    if constexpr (hn::MaxLanes(Words()) == 16) {  // two registers of the table at a time
      if (HWY_LIKELY(pairs_ <= kPairs)) {
        __m512i found = entries(table);
        for (std::size_t k = 1; k < pairs_; ++k)
          found = _mm512_mask_mov_epi32(found, in_pair_[k], entries(table + 32 * k));
        return W{found};
      }
    }
#endif
    return entries_.of(table);
  }

 private:
  W at_;
  Entries<Words> entries_;
  std::size_t pairs_;
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  static constexpr int kPairs = 4;
  __mmask16 in_pair_[kPairs];
  HWY_INLINE __m512i entries(const std::int32_t* from) const {
    return _mm512_permutex2var_epi32(_mm512_load_si512(from), at_.raw, _mm512_load_si512(from + 16));
  }
#endif
};

/// The robots whose lines are made.
template <class D>
struct Own {
  hn::Vec<WordsOf<D>> x, y;
  hn::Vec<D> vx, vy, radius, inverse_horizon, least;

  HWY_INLINE Own(const KindTable<hn::TFromD<D>>& table, const LineQuery& q, std::size_t lane) {
    const D d;
    const WordsOf<D> words;
    const hn::Vec<D> unit = hn::Set(d, table.unit());
    x = hn::LoadU(words, q.x + lane);
    y = hn::LoadU(words, q.y + lane);
    vx = hn::Mul(numbers(d, hn::LoadU(words, q.mx + lane)), unit);
    vy = hn::Mul(numbers(d, hn::LoadU(words, q.my + lane)), unit);
    if (table.is_mixed()) {
      const auto kind = hn::LoadU(words, q.kind + lane);
      radius = by_kind(d, table.radius.data(), kind);
      inverse_horizon = by_kind(d, table.inverse_horizon.data(), kind);
      least = by_kind(d, table.least_offset.data(), kind);
    } else {
      radius = hn::Set(d, table.radius[0]);
      inverse_horizon = hn::Set(d, table.inverse_horizon[0]);
      least = hn::Set(d, table.least_offset[0]);
    }
  }
};

template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask, std::size_t lane) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return (static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8U) << lane;
}

/// Ranks whose half-planes are made side by side.
constexpr int kAtOnce = 6;

/// The other robots of a rank, seen from those of some lanes. In lanes without a robot they are unspecified.
template <bool kMixed, class D>
HWY_INLINE Pair<D> pair_of(D d, const KindTable<hn::TFromD<D>>& table, const LineQuery& q, const Own<D>& own,
                           const hn::Vec<WordsOf<D>>& at) {
  const hn::Vec<D> step = hn::Set(d, table.position_step), unit = hn::Set(d, table.unit());
  const Lookup<D> of(at, q.others->count);
  Pair<D> pair;
  pair.px = hn::Mul(numbers(d, hn::Sub(of(q.others->x), own.x)), step);
  pair.py = hn::Mul(numbers(d, hn::Sub(of(q.others->y), own.y)), step);
  pair.vx = own.vx;
  pair.vy = own.vy;
  pair.ox = hn::Mul(numbers(d, of(q.others->mx)), unit);
  pair.oy = hn::Mul(numbers(d, of(q.others->my)), unit);
  if (kMixed) {
    const auto kind = of(q.others->kind);
    pair.radius = hn::Add(own.radius, by_kind(d, table.radius.data(), kind));
    pair.inverse_horizon = hn::Max(own.inverse_horizon, by_kind(d, table.inverse_horizon.data(), kind));
  } else {
    pair.radius = hn::Add(own.radius, own.radius);
    pair.inverse_horizon = own.inverse_horizon;
  }
  return pair;
}

template <bool kCertified, bool kMixed, class D>
HWY_INLINE LineFlags lines_of_lanes(D d, const KindTable<hn::TFromD<D>>& table, const LineQuery& q,
                                    const LineRows<hn::TFromD<D>>& out, std::size_t lane) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  const WordsOf<D> words;
  const Own<D> own(table, q, lane);
  const auto none = hn::BitCast(words, hn::LoadU(hn::Rebind<float, D>(), q.none + lane));
  auto touching = hn::MaskFromVec(hn::Zero(d)), coincident = touching;
  PairWork<kCertified, D> work[kAtOnce];
  V radius[kAtOnce];
  hn::Mask<D> there[kAtOnce];
  for (int first = q.first_rank; first < q.end_rank; first += kAtOnce) {
    const int ranks = std::min(kAtOnce, q.end_rank - first);
    for (int k = 0; k < ranks; ++k) {
      const auto key = hn::BitCast(words, hn::LoadU(hn::Rebind<float, D>(), q.ranked->key[first + k] + lane));
      const auto there_words = hn::Lt(key, none);
      // Lanes without one read the first entry: what stands elsewhere may be anything.
      const auto at = hn::And(hn::IfThenElseZero(there_words, key), hn::Set(words, kIndexBits));
      there[k] = hn::Ne(numbers(d, hn::IfThenElseZero(there_words, hn::Set(words, 1))), hn::Zero(d));
      const Pair<D> pair = pair_of<kMixed>(d, table, q, own, at);
      radius[k] = pair.radius;
      work[k].begin(d, pair, table.inverse_time);
    }
    for (int k = 0; k < ranks; ++k) work[k].divide(d);
    for (int k = 0; k < ranks; ++k) {
      const PairLine<D> line = work[k].line(d, own.vx, own.vy, radius[k], table.lattice_slack);
      const std::size_t to = static_cast<std::size_t>(first + k - q.first_rank) * out.stride + lane;
      hn::StoreU(hn::IfThenElse(there[k], line.x, hn::Set(d, T(1))), d, out.x + to);
      hn::StoreU(hn::IfThenElseZero(there[k], line.y), d, out.y + to);
      const V offset = hn::Max(line.c, own.least);
      hn::StoreU(hn::IfThenElse(there[k], offset, hn::Set(d, static_cast<T>(kNever))), d, out.c + to);
      touching = hn::Or(touching, hn::And(line.touching, there[k]));
      coincident = hn::Or(coincident, hn::And(line.coincident, there[k]));
    }
  }
  return {bits_of(d, touching, lane), bits_of(d, coincident, lane)};
}

template <bool kCertified, bool kMixed, class T>
LineFlags all_lines(const KindTable<T>& table, const LineQuery& q, const LineRows<T>& out) {
  const hn::CappedTag<T, kPack> d;
  LineFlags flags;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const LineFlags some = lines_of_lanes<kCertified, kMixed>(d, table, q, out, lane);
    flags.touching |= some.touching;
    flags.coincident |= some.coincident;
  }
  return flags;
}

template <class T>
LineFlags lines_by_table(const KindTable<T>& table, const LineQuery& q, const LineRows<T>& out) {
  if (table.certified)
    return table.is_mixed() ? all_lines<true, true>(table, q, out) : all_lines<true, false>(table, q, out);
  return table.is_mixed() ? all_lines<false, true>(table, q, out) : all_lines<false, false>(table, q, out);
}

LineFlags float_lines(const KindTable<float>& table, const LineQuery& q, const LineRows<float>& out) {
  return lines_by_table(table, q, out);
}
LineFlags double_lines(const KindTable<double>& table, const LineQuery& q, const LineRows<double>& out) {
  return lines_by_table(table, q, out);
}

template <class T>
std::uint32_t round_some(const KindTable<T>& table, const Answers<T>& in, Rounded& out) {
  const hn::CappedTag<T, kPack> d;
  using V = hn::Vec<hn::CappedTag<T, kPack>>;
  const WordsOf<hn::CappedTag<T, kPack>> words;
  const V per_metre = hn::Set(d, table.inverse_step), unit = hn::Set(d, table.unit());
  std::uint32_t kept = 0;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const V x = hn::Round(hn::Mul(hn::LoadU(d, in.vx + lane), per_metre));
    const V y = hn::Round(hn::Mul(hn::LoadU(d, in.vy + lane), per_metre));
    if constexpr (sizeof(T) == 8) {
      hn::StoreU(hn::DemoteTo(words, x), words, out.mx + lane);
      hn::StoreU(hn::DemoteTo(words, y), words, out.my + lane);
    } else {
      hn::StoreU(hn::ConvertTo(words, x), words, out.mx + lane);
      hn::StoreU(hn::ConvertTo(words, y), words, out.my + lane);
    }
    if (!table.certified) continue;
    const V vx = hn::Mul(x, unit), vy = hn::Mul(y, unit);
    V most = hn::Set(d, static_cast<T>(kNever));
    for (std::size_t k = 0; k < in.lines; ++k) {
      const std::size_t at = k * in.stride + lane;
      const V met = hn::Add(hn::Mul(vx, hn::LoadU(d, in.x + at)), hn::Mul(vy, hn::LoadU(d, in.y + at)));
      most = hn::Max(most, hn::Sub(hn::LoadU(d, in.c + at), met));
    }
    kept |= bits_of(d, hn::Le(most, hn::LoadU(d, in.allowed + lane)), lane);
  }
  if (!table.certified)
    for (std::size_t lane = 0; lane < kPack; ++lane) kept |= std::uint32_t{in.status[lane] == 0} << lane;
  return kept;
}

std::uint32_t round_floats(const KindTable<float>& table, const Answers<float>& in, Rounded& out) {
  return round_some(table, in, out);
}
std::uint32_t round_doubles(const KindTable<double>& table, const Answers<double>& in, Rounded& out) {
  return round_some(table, in, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(float_lines);
HWY_EXPORT(double_lines);
HWY_EXPORT(round_floats);
HWY_EXPORT(round_doubles);

LineFlags make_lines(const KindTable<float>& table, const LineQuery& query, const LineRows<float>& out) {
  return HWY_DYNAMIC_DISPATCH(float_lines)(table, query, out);
}
LineFlags make_lines(const KindTable<double>& table, const LineQuery& query, const LineRows<double>& out) {
  return HWY_DYNAMIC_DISPATCH(double_lines)(table, query, out);
}
std::uint32_t round_to_lattice(const KindTable<float>& table, const Answers<float>& answers, Rounded& out) {
  return HWY_DYNAMIC_DISPATCH(round_floats)(table, answers, out);
}
std::uint32_t round_to_lattice(const KindTable<double>& table, const Answers<double>& answers, Rounded& out) {
  return HWY_DYNAMIC_DISPATCH(round_doubles)(table, answers, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
