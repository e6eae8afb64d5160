// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/lines.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/lines.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/pair_line.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

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
  HWY_INLINE Lookup(W at, std::size_t count) : at_(at), pairs_((count + 31) / 32) {
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
    return hn::GatherIndex(Words(), table, at_);
  }

 private:
  W at_;
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

  HWY_INLINE Own(const LineRule<hn::TFromD<D>>& rule, const LineQuery& q, std::size_t lane) {
    const D d;
    const WordsOf<D> words;
    const hn::Vec<D> unit = hn::Set(d, rule.velocity_step);
    x = hn::LoadU(words, q.x + lane);
    y = hn::LoadU(words, q.y + lane);
    vx = hn::Mul(numbers(d, hn::LoadU(words, q.mx + lane)), unit);
    vy = hn::Mul(numbers(d, hn::LoadU(words, q.my + lane)), unit);
    if (rule.mixed) {
      const auto kind = hn::LoadU(words, q.kind + lane);
      radius = by_kind(d, rule.radius, kind);
      inverse_horizon = by_kind(d, rule.inverse_horizon, kind);
      least = by_kind(d, rule.least_offset, kind);
    } else {
      radius = hn::Set(d, rule.radius[0]);
      inverse_horizon = hn::Set(d, rule.inverse_horizon[0]);
      least = hn::Set(d, rule.least_offset[0]);
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

/// The other robots of a rank, seen from those of some lanes. Nobody's are anything.
template <bool kMixed, class D>
HWY_INLINE Pair<D> pair_of(D d, const LineRule<hn::TFromD<D>>& rule, const LineQuery& q, const Own<D>& own,
                           const hn::Vec<WordsOf<D>>& at) {
  const hn::Vec<D> step = hn::Set(d, rule.position_step), unit = hn::Set(d, rule.velocity_step);
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
    pair.radius = hn::Add(own.radius, by_kind(d, rule.radius, kind));
    pair.inverse_horizon = hn::Max(own.inverse_horizon, by_kind(d, rule.inverse_horizon, kind));
  } else {
    pair.radius = hn::Add(own.radius, own.radius);
    pair.inverse_horizon = own.inverse_horizon;
  }
  return pair;
}

template <bool kCertified, bool kMixed, class D>
HWY_INLINE LineFlags lines_of_lanes(D d, const LineRule<hn::TFromD<D>>& rule, const LineQuery& q,
                                    const LineRows<hn::TFromD<D>>& out, std::size_t lane) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  const WordsOf<D> words;
  const Own<D> own(rule, q, lane);
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
      const Pair<D> pair = pair_of<kMixed>(d, rule, q, own, at);
      radius[k] = pair.radius;
      work[k].begin(d, pair, rule.inverse_time);
    }
    for (int k = 0; k < ranks; ++k) work[k].divide(d);
    for (int k = 0; k < ranks; ++k) {
      const PairLine<D> line = work[k].line(d, own.vx, own.vy, radius[k], rule.lattice_slack);
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
LineFlags all_lines(const LineRule<T>& rule, const LineQuery& q, const LineRows<T>& out) {
  const hn::CappedTag<T, kPack> d;
  LineFlags flags;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const LineFlags some = lines_of_lanes<kCertified, kMixed>(d, rule, q, out, lane);
    flags.touching |= some.touching;
    flags.coincident |= some.coincident;
  }
  return flags;
}

template <class T>
LineFlags lines_by_rule(const LineRule<T>& rule, const LineQuery& q, const LineRows<T>& out) {
  if (rule.certified) return rule.mixed ? all_lines<true, true>(rule, q, out) : all_lines<true, false>(rule, q, out);
  return rule.mixed ? all_lines<false, true>(rule, q, out) : all_lines<false, false>(rule, q, out);
}

LineFlags float_lines(const LineRule<float>& rule, const LineQuery& q, const LineRows<float>& out) {
  return lines_by_rule(rule, q, out);
}
LineFlags double_lines(const LineRule<double>& rule, const LineQuery& q, const LineRows<double>& out) {
  return lines_by_rule(rule, q, out);
}

template <class T>
std::uint32_t round_some(const LineRule<T>& rule, const Answers<T>& in, Rounded& out) {
  const hn::CappedTag<T, kPack> d;
  using V = hn::Vec<hn::CappedTag<T, kPack>>;
  const WordsOf<hn::CappedTag<T, kPack>> words;
  const V per_metre = hn::Set(d, rule.inverse_step), unit = hn::Set(d, rule.velocity_step);
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
    if (!rule.certified) continue;
    const V vx = hn::Mul(x, unit), vy = hn::Mul(y, unit);
    V most = hn::Set(d, static_cast<T>(kNever));
    for (std::size_t k = 0; k < in.lines; ++k) {
      const std::size_t at = k * in.stride + lane;
      const V met = hn::Add(hn::Mul(vx, hn::LoadU(d, in.x + at)), hn::Mul(vy, hn::LoadU(d, in.y + at)));
      most = hn::Max(most, hn::Sub(hn::LoadU(d, in.c + at), met));
    }
    kept |= bits_of(d, hn::Le(most, hn::LoadU(d, in.allowed + lane)), lane);
  }
  if (!rule.certified)
    for (std::size_t lane = 0; lane < kPack; ++lane) kept |= std::uint32_t{in.status[lane] == 0} << lane;
  return kept;
}

std::uint32_t round_floats(const LineRule<float>& rule, const Answers<float>& in, Rounded& out) {
  return round_some(rule, in, out);
}
std::uint32_t round_doubles(const LineRule<double>& rule, const Answers<double>& in, Rounded& out) {
  return round_some(rule, in, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(float_lines);
HWY_EXPORT(double_lines);
HWY_EXPORT(round_floats);
HWY_EXPORT(round_doubles);

LineFlags make_lines(const LineRule<float>& rule, const LineQuery& query, const LineRows<float>& out) {
  return HWY_DYNAMIC_DISPATCH(float_lines)(rule, query, out);
}
LineFlags make_lines(const LineRule<double>& rule, const LineQuery& query, const LineRows<double>& out) {
  return HWY_DYNAMIC_DISPATCH(double_lines)(rule, query, out);
}
std::uint32_t round_to_lattice(const LineRule<float>& rule, const Answers<float>& answers, Rounded& out) {
  return HWY_DYNAMIC_DISPATCH(round_floats)(rule, answers, out);
}
std::uint32_t round_to_lattice(const LineRule<double>& rule, const Answers<double>& answers, Rounded& out) {
  return HWY_DYNAMIC_DISPATCH(round_doubles)(rule, answers, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
