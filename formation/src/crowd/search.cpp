// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/search.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kPack>;
using Words = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;

/// Candidates that are sorted before they are merged into a list.
constexpr std::size_t kBatch = 8;

HWY_INLINE void order(F& a, F& b) {
  const F low = hn::Min(a, b);
  b = hn::Max(a, b);
  a = low;
}

/// The optimal network of eight: 19 comparators.
HWY_INLINE void sort_batch(F* c) {
  order(c[0], c[2]), order(c[1], c[3]), order(c[4], c[6]), order(c[5], c[7]);
  order(c[0], c[4]), order(c[1], c[5]), order(c[2], c[6]), order(c[3], c[7]);
  order(c[0], c[1]), order(c[2], c[3]), order(c[4], c[5]), order(c[6], c[7]);
  order(c[2], c[4]), order(c[3], c[5]);
  order(c[1], c[4]), order(c[3], c[6]);
  order(c[1], c[2]), order(c[3], c[4]), order(c[5], c[6]);
}

/// The smallest keys of each lane, ascending: the end of a bitonic sequence of sixteen that begins with minus infinity.
template <int kRanks>
class SortedLists {
 public:
  explicit HWY_INLINE SortedLists(F none) {
    for (F& entry : list_) entry = none;
  }

  HWY_INLINE void merge(F* batch) {
    sort_batch(batch);
    if (hn::AllFalse(Floats(), hn::Lt(batch[0], list_[kRanks - 1]))) return;
#pragma GCC unroll 8
    for (int i = 0; i < static_cast<int>(kBatch); ++i)
      if (kRanks - 1 - i >= 0) list_[kRanks - 1 - i] = hn::Min(list_[kRanks - 1 - i], batch[i]);
    stage<8>();
    stage<4>();
    stage<2>();
    stage<1>();
  }

  HWY_INLINE void store(Ranked& out, std::size_t lane) const {
    for (int r = 0; r < kRanks; ++r) hn::StoreU(list_[r], Floats(), out.key[r] + lane);
  }

 private:
  static constexpr int kBefore = 16 - kRanks;

  template <int kDistance>
  HWY_INLINE void stage() {
#pragma GCC unroll 16
    for (int i = kBefore; i < 16; ++i)
      if ((i & kDistance) == 0 && i + kDistance < 16) order(list_[i - kBefore], list_[i + kDistance - kBefore]);
  }

  F list_[kRanks];
};

template <int kRanks>
void nearest_in(const Candidates& among, const std::int32_t* x, const std::int32_t* y, const float* none, Ranked& out) {
  const Floats d;
  const Words words;
  const F distance_bits = hn::BitCast(d, hn::Set(words, ~kIndexBits));
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const auto own_x = hn::LoadU(words, x + lane), own_y = hn::LoadU(words, y + lane);
    const F nobody = hn::LoadU(d, none + lane);
    SortedLists<kRanks> lists(nobody);
    for (std::size_t k = 0; k < among.count; k += kBatch) {
      F key[kBatch];
#pragma GCC unroll 8
      for (std::size_t j = 0; j < kBatch; ++j) {
        const F dx = hn::ConvertTo(d, hn::Sub(hn::Set(words, among.x[k + j]), own_x));
        const F dy = hn::ConvertTo(d, hn::Sub(hn::Set(words, among.y[k + j]), own_y));
        const F squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
        const F number = hn::BitCast(d, hn::Set(words, static_cast<std::int32_t>(k + j)));
        key[j] = hn::Or(hn::And(squared, distance_bits), number);
      }
      if (k + kBatch > among.count)
        for (std::size_t j = among.count - k; j < kBatch; ++j) key[j] = nobody;
      lists.merge(key);
    }
    lists.store(out, lane);
  }
}

void nearest(const Candidates& among, const std::int32_t* x, const std::int32_t* y, const float* none, int ranks,
             Ranked& out) {
  if (ranks == 6) return nearest_in<6>(among, x, y, none, out);
  if (ranks == 11) return nearest_in<11>(among, x, y, none, out);
  return nearest_in<16>(among, x, y, none, out);
}

void add_some_between(const RobotColumns& robots, std::size_t count, std::int32_t low, std::int32_t high,
                      Candidates& to) {
  const Words words;
  const auto lowest = hn::Set(words, low), highest = hn::Set(words, high);
  for (std::size_t k = 0; k < count; k += hn::Lanes(words)) {
    const auto y = hn::LoadU(words, robots.y + k);
    const auto there = hn::FirstN(words, std::min(hn::Lanes(words), count - k));
    const auto taken = hn::AndNot(hn::Or(hn::Lt(y, lowest), hn::Gt(y, highest)), there);
    hn::StoreU(hn::Compress(hn::LoadU(words, robots.x + k), taken), words, to.x + to.count);
    hn::StoreU(hn::Compress(y, taken), words, to.y + to.count);
    hn::StoreU(hn::Compress(hn::LoadU(words, robots.mx + k), taken), words, to.mx + to.count);
    hn::StoreU(hn::Compress(hn::LoadU(words, robots.my + k), taken), words, to.my + to.count);
    to.count += hn::CountTrue(words, taken);
  }
}

template <class Mask>
HWY_INLINE std::uint32_t bits_from(Mask mask, std::size_t lane) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  return (bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U) << lane;
}

std::uint32_t behind_others(const Ranked& ranked, const std::int32_t* self) {
  const Floats d;
  const Words words;
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const auto number = hn::And(hn::BitCast(words, hn::LoadU(d, ranked.key[0] + lane)), hn::Set(words, kIndexBits));
    bits |= bits_from(hn::RebindMask(d, hn::Ne(number, hn::LoadU(words, self + lane))), lane);
  }
  return bits;
}

/// The farthest that a hint says, lattice steps.
constexpr float kFarthestHint = 0x1p30F;

template <bool kMixed>
void count_in(const LaneLimits& limits, float seen, int ranks, Ranked& ranked, LaneFinds& out) {
  const Floats d;
  const Words words;
  const F distance_bits = hn::BitCast(d, hn::Set(words, ~kIndexBits));
  out.most = 0;
  out.unseen = out.crowded = 0;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const F none = hn::LoadU(d, limits.none + lane);
    const auto wanted = hn::LoadU(words, limits.wanted + lane);
    auto have = hn::Zero(words);
    F last = none;
    for (int r = 1; r < ranks; ++r) {
      F key = hn::LoadU(d, ranked.key[r] + lane);
      const auto rank = hn::Set(words, r);
      if constexpr (kMixed) {
        key = hn::IfThenElse(hn::RebindMask(d, hn::Gt(rank, wanted)), none, key);
        hn::StoreU(key, d, ranked.key[r] + lane);
      }
      const auto is_there = hn::AndNot(hn::Gt(rank, wanted), hn::RebindMask(words, hn::Lt(key, none)));
      have = hn::IfThenElse(is_there, rank, have);  // keys ascend
      last = hn::IfThenElse(hn::RebindMask(d, hn::Eq(rank, wanted)), key, last);
    }
    hn::StoreU(have, words, out.have + lane);
    out.most = std::max(out.most, static_cast<int>(hn::GetLane(hn::MaxOfLanes(words, have))));
    const auto is_full = hn::Lt(last, none);
    const F squared = hn::And(last, distance_bits);
    const auto distance = hn::ConvertTo(words, hn::Min(hn::Sqrt(squared), hn::Set(d, kFarthestHint)));
    const auto window = hn::LoadU(words, limits.window + lane);
    const auto hint = hn::IfThenElse(hn::RebindMask(words, is_full), hn::Min(distance, window), window);
    hn::StoreU(hint, words, out.hint + lane);
    out.unseen |= bits_from(hn::Gt(last, hn::Set(d, seen)), lane);
    out.crowded |= bits_from(hn::And(is_full, hn::Lt(squared, hn::LoadU(d, limits.reach + lane))), lane);
  }
}

void count_all(const LaneLimits& limits, float seen, int ranks, bool mixed, Ranked& ranked, LaneFinds& out) {
  mixed ? count_in<true>(limits, seen, ranks, ranked, out) : count_in<false>(limits, seen, ranks, ranked, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(add_some_between);
HWY_EXPORT(nearest);
HWY_EXPORT(behind_others);
HWY_EXPORT(count_all);

int ranks_sought(int wanted) {
  return wanted <= 6 ? 6 : wanted <= 11 ? 11 : 16;
}

void add_between(const RobotColumns& robots, std::size_t count, std::int32_t low, std::int32_t high, Candidates& to) {
  HWY_DYNAMIC_DISPATCH(add_some_between)(robots, count, low, high, to);
}

void find_nearest(const Candidates& among, const std::int32_t* x, const std::int32_t* y, const float* none, int ranks,
                  Ranked& out) {
  HWY_DYNAMIC_DISPATCH(nearest)(among, x, y, none, ranks, out);
}

std::uint32_t lanes_behind_others(const Ranked& ranked, const std::int32_t* self) {
  return HWY_DYNAMIC_DISPATCH(behind_others)(ranked, self);
}

void count_neighbours(const LaneLimits& limits, float seen, int ranks, bool mixed, Ranked& ranked, LaneFinds& out) {
  HWY_DYNAMIC_DISPATCH(count_all)(limits, seen, ranks, mixed, ranked, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
