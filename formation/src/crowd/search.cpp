// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/search.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/to_front.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kPack>;
using Words = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using W = hn::Vec<Words>;

/// Candidates that are sorted before they are merged into a list.
constexpr std::size_t kBatch = 8;

/// Keys are floats that are not negative: their order is that of their bits, and processors have more units for whole
/// numbers.
HWY_INLINE void order(W& a, W& b) {
  const W low = hn::Min(a, b);
  b = hn::Max(a, b);
  a = low;
}

/// The optimal network of eight: 19 comparators.
HWY_INLINE void sort_batch(W* c) {
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
  explicit HWY_INLINE SortedLists(W none) {
    for (W& entry : list_) entry = none;
  }

  HWY_INLINE void merge(W* batch) {
    sort_batch(batch);
#pragma GCC unroll 8
    for (int i = 0; i < static_cast<int>(kBatch); ++i)
      if (kRanks - 1 - i >= 0) list_[kRanks - 1 - i] = hn::Min(list_[kRanks - 1 - i], batch[i]);
    stage<8>();
    stage<4>();
    stage<2>();
    stage<1>();
  }

  HWY_INLINE void store(Ranked& out, std::size_t lane) const {
    for (int r = 0; r < kRanks; ++r) hn::StoreU(hn::BitCast(Floats(), list_[r]), Floats(), out.key[r] + lane);
  }

 private:
  static constexpr int kBefore = 16 - kRanks;

  template <int kDistance>
  HWY_INLINE void stage() {
#pragma GCC unroll 16
    for (int i = kBefore; i < 16; ++i)
      if ((i & kDistance) == 0 && i + kDistance < 16) order(list_[i - kBefore], list_[i + kDistance - kBefore]);
  }

  W list_[kRanks];
};

/// What the candidates' keys are made of.
struct KeyMaker {
  W own_x, own_y, nobody;

  /// The keys of kBatch candidates from k on; from `end` on, the key of no robot.
  template <bool kSome>
  HWY_INLINE void make(const Candidates& among, std::size_t k, W* key) const {
    const Floats d;
    const Words words;
    const W distance_bits = hn::Set(words, ~kIndexBits), end = hn::Set(words, static_cast<std::int32_t>(among.count));
    W number = hn::Set(words, static_cast<std::int32_t>(k));
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kBatch; ++j) {
      const F dx = hn::ConvertTo(d, hn::Sub(hn::Set(words, among.x[k + j]), own_x));
      const F dy = hn::ConvertTo(d, hn::Sub(hn::Set(words, among.y[k + j]), own_y));
      const W squared = hn::BitCast(words, hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
      key[j] = hn::OrAnd(number, squared, distance_bits);
      if constexpr (kSome) key[j] = hn::IfThenElse(hn::Lt(number, end), key[j], nobody);
      number = hn::Add(number, hn::Set(words, 1));
    }
  }
};

template <int kRanks>
void nearest_in(const Candidates& among, const std::int32_t* x, const std::int32_t* y, const float* none, Ranked& out) {
  const Floats d;
  const Words words;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const KeyMaker keys{hn::LoadU(words, x + lane), hn::LoadU(words, y + lane),
                        hn::BitCast(words, hn::LoadU(d, none + lane))};
    SortedLists<kRanks> lists(keys.nobody);
    W key[kBatch];
    std::size_t k = 0;
    for (; k + kBatch <= among.count; k += kBatch) {
      keys.template make<false>(among, k, key);
      lists.merge(key);
    }
    if (k < among.count) {
      keys.template make<true>(among, k, key);
      lists.merge(key);
    }
    lists.store(out, lane);
  }
}

void nearest(const Candidates& among, const LaneQuery& q, const float* none, Ranked& out) {
  if (q.ranks == 6) return nearest_in<6>(among, q.x, q.y, none, out);
  if (q.ranks == 11) return nearest_in<11>(among, q.x, q.y, none, out);
  return nearest_in<16>(among, q.x, q.y, none, out);
}

void add_near(const RobotColumns& robots, const CandidateRule& rule, const CandidateStretch& s, Candidates& to) {
  const Words words;
  const auto lowest = hn::Set(words, rule.low), highest = hn::Set(words, rule.high), numbers = hn::Iota(words, 0);
  std::size_t count = to.count;
  for (std::size_t i = s.from; i < s.to; i += hn::Lanes(words)) {
    const auto y = hn::LoadU(words, robots.y + i);
    const auto there = hn::FirstN(words, std::min(hn::Lanes(words), s.to - i));
    const auto taken = hn::AndNot(hn::Or(hn::Lt(y, lowest), hn::Gt(y, highest)), there);
    const ToFront<Words> front(taken);
    const auto robot = hn::Add(numbers, hn::Set(words, static_cast<std::int32_t>(i)));
    hn::StoreU(front(hn::LoadU(words, robots.x + i)), words, to.x + count);
    hn::StoreU(front(y), words, to.y + count);
    hn::StoreU(front(hn::LoadU(words, robots.mx + i)), words, to.mx + count);
    hn::StoreU(front(hn::LoadU(words, robots.my + i)), words, to.my + count);
    hn::StoreU(front(robot), words, to.robot + count);
    count += hn::CountTrue(words, taken);
  }
  to.count = count;
}

void add_all(const RobotColumns& robots, const CandidateStretch& s, bool with_kinds, Candidates& to) {
  const Words words;
  const hn::Rebind<std::uint16_t, Words> tags;
  const auto numbers = hn::Iota(words, 0);
  for (std::size_t i = s.from, k = to.count; i < s.to; i += hn::Lanes(words), k += hn::Lanes(words)) {
    hn::StoreU(hn::LoadU(words, robots.x + i), words, to.x + k);
    hn::StoreU(hn::LoadU(words, robots.y + i), words, to.y + k);
    hn::StoreU(hn::LoadU(words, robots.mx + i), words, to.mx + k);
    hn::StoreU(hn::LoadU(words, robots.my + i), words, to.my + k);
    hn::StoreU(hn::Add(numbers, hn::Set(words, static_cast<std::int32_t>(i))), words, to.robot + k);
    if (with_kinds) {
      const auto tag = hn::PromoteTo(words, hn::LoadU(tags, robots.tag + i));
      hn::StoreU(hn::And(tag, hn::Set(words, kKindBits)), words, to.kind + k);
    }
  }
  to.count += s.to - s.from;
}

void add_to_table(const RobotColumns& robots, const CandidateRule& rule, const CandidateStretch* stretches,
                  std::size_t count, Candidates& to, std::int32_t* self) {
  const Words words;
  for (const CandidateStretch* s = stretches; s != stretches + count; ++s) {
    const std::size_t first = std::max(rule.begin, s->from), last = std::min(rule.end, s->to);
    if (first < last) {  // what is written beyond is overwritten by later stretches, or of no robot
      const auto number = static_cast<std::int32_t>(to.count + first - s->from);
      for (std::size_t k = 0; k < last - first; k += hn::Lanes(words))
        hn::StoreU(hn::Iota(words, number + static_cast<std::int32_t>(k)), words, self + (first - rule.begin) + k);
    } else if (s->outer && !rule.mixed) {
      add_near(robots, rule, *s, to);
      continue;
    }
    add_all(robots, *s, rule.mixed, to);
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
void count_in(const LaneQuery& q, const LaneLimits& limits, Ranked& ranked, LaneFinds& out) {
  const Floats d;
  const Words words;
  const F distance_bits = hn::BitCast(d, hn::Set(words, ~kIndexBits));
  out.most = out.neighbours = 0;
  out.unseen = out.crowded = 0;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const F none = hn::LoadU(d, limits.none + lane);
    const auto wanted = hn::LoadU(words, limits.wanted + lane);
    auto have = hn::Zero(words);
    F last = none;
    for (int r = 1; r < q.ranks; ++r) {
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
    out.most = std::max(out.most, hn::GetLane(hn::MaxOfLanes(words, have)));
    out.neighbours += hn::GetLane(hn::SumOfLanes(words, have));
    const auto is_full = hn::Lt(last, none);
    const F squared = hn::And(last, distance_bits);
    const auto distance = hn::ConvertTo(words, hn::Min(hn::Sqrt(squared), hn::Set(d, kFarthestHint)));
    const auto window = hn::LoadU(words, limits.window + lane);
    const auto hint = hn::IfThenElse(hn::RebindMask(words, is_full), hn::Min(distance, window), window);
    hn::StoreU(hint, words, out.hint + lane);
    out.unseen |= bits_from(hn::Gt(last, hn::Set(d, q.seen)), lane);
    out.crowded |= bits_from(hn::And(is_full, hn::Lt(squared, hn::LoadU(d, limits.reach + lane))), lane);
  }
}

void count_all(const LaneQuery& q, const LaneLimits& limits, Ranked& ranked, LaneFinds& out) {
  q.mixed ? count_in<true>(q, limits, ranked, out) : count_in<false>(q, limits, ranked, out);
}

std::uint32_t find_and_count(const Candidates& among, const LaneQuery& q, const LaneLimits& limits, Ranked& ranked,
                             LaneFinds& out) {
  nearest(among, q, limits.none, ranked);
  const std::uint32_t behind = behind_others(ranked, q.self) & q.lanes;
  if (behind == 0) count_all(q, limits, ranked, out);
  return behind;
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(add_to_table);
HWY_EXPORT(find_and_count);
HWY_EXPORT(count_all);

int ranks_sought(int wanted) {
  return wanted <= 6 ? 6 : wanted <= 11 ? 11 : 16;
}

void add_candidates(const RobotColumns& robots, const CandidateRule& rule, const CandidateStretch* stretches,
                    std::size_t count, Candidates& to, std::int32_t* self) {
  HWY_DYNAMIC_DISPATCH(add_to_table)(robots, rule, stretches, count, to, self);
}

std::uint32_t find_nearest(const Candidates& among, const LaneQuery& query, const LaneLimits& limits, Ranked& ranked,
                           LaneFinds& out) {
  return HWY_DYNAMIC_DISPATCH(find_and_count)(among, query, limits, ranked, out);
}

void count_neighbours(const LaneQuery& query, const LaneLimits& limits, Ranked& ranked, LaneFinds& out) {
  HWY_DYNAMIC_DISPATCH(count_all)(query, limits, ranked, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
