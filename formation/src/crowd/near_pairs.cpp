// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/near_pairs.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/near_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/entries.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kPack>;
using Words = hn::RebindToSigned<Floats>;
using Halves = hn::Rebind<std::int16_t, Words>;
using F = hn::Vec<Floats>;
using W = hn::Vec<Words>;

/// Above what squared distances, in float, are off by: 13 roundings.
constexpr float kWider = 1.0F + 0x1p-18F, kNarrower = 1.0F - 0x1p-18F;

/// What (6) is asked to have left: of S, and steps.
constexpr float kShareLeft = 0x1p-18F, kLeft = 1.0F;

template <class M>
HWY_INLINE std::uint32_t bits_of_mask(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), hn::RebindMask(Floats(), mask), bytes);
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U;
}

/// longest_way.
HWY_INLINE F way_of(W wish_x, W wish_y) {
  const W x = hn::Abs(wish_x), y = hn::Abs(wish_y);
  const W bound = hn::Add(hn::Max(x, y), hn::ShiftRight<1>(hn::Min(x, y)));
  return hn::ConvertTo(Floats(), hn::Add(bound, hn::Set(Words(), 1 + kRoundingRoom)));
}

/// What is known of a row of pairs: bit `lane` of each word.
struct Judged {
  std::uint32_t near = 0, clear = 0, doubtful = 0;
};

/// Robots, a lane each.
class OwnLanes {
 public:
  HWY_INLINE OwnLanes(W x, W y, W wish_x, W wish_y)
      : x_(x),
        y_(y),
        wish_x_(hn::ConvertTo(Floats(), wish_x)),
        wish_y_(hn::ConvertTo(Floats(), wish_y)),
        way_(way_of(wish_x, wish_y)) {}

  /// Whether each could meet another robot surely, or perhaps, and whether (6) holds. `contact`: R.
  HWY_INLINE Judged judge(const Robots& robots, W other, F contact) const {
    const Floats d;
    const F zero = hn::Zero(d);
    const Entries<Words> its_entry(other);
    const W its_x = its_entry.of(robots.wish_mx.data()), its_y = its_entry.of(robots.wish_my.data());
    const F dx = hn::ConvertTo(d, hn::Sub(x_, its_entry.of(robots.x.data())));
    const F dy = hn::ConvertTo(d, hn::Sub(y_, its_entry.of(robots.y.data())));
    const F squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const F reach = hn::Add(contact, hn::Add(way_, way_of(its_x, its_y)));
    const F limit = hn::Mul(reach, reach);
    const F apart = hn::Max(hn::Set(d, 1.0F), hn::Sub(contact, hn::Set(d, static_cast<float>(kRoundedContact))));
    const auto perhaps = hn::Lt(squared, hn::Mul(limit, hn::Set(d, kWider)));
    const auto surely = hn::And(hn::Lt(squared, hn::Mul(limit, hn::Set(d, kNarrower))),
                                hn::Gt(squared, hn::Mul(hn::Mul(apart, apart), hn::Set(d, kWider))));
    const F own = hn::Add(hn::Mul(dx, wish_x_), hn::Mul(dy, wish_y_));
    const F its = hn::Add(hn::Mul(dx, hn::ConvertTo(d, its_x)), hn::Mul(dy, hn::ConvertTo(d, its_y)));
    const F needs = hn::Add(hn::Max(zero, hn::Neg(own)), hn::Max(zero, its));
    const F distance = hn::Sqrt(squared);
    const F room = hn::Sub(hn::Sub(squared, hn::Mul(contact, distance)), needs);
    const F sum = hn::Add(distance, reach);
    const F left = hn::Mul(distance, hn::Add(hn::Mul(sum, hn::Set(d, kShareLeft)), hn::Set(d, kLeft)));
    return {bits_of_mask(surely), bits_of_mask(hn::Ge(room, left)), bits_of_mask(hn::AndNot(surely, perhaps))};
  }

 private:
  W x_, y_;
  F wish_x_, wish_y_, way_;
};

/// R of lanes and the others, where there are several kinds.
HWY_INLINE F mixed_contact(const Robots& robots, const std::vector<StepsOfKind>& kinds, const std::int32_t* own,
                           W other) {
  HWY_ALIGN std::int32_t others[kPack];
  HWY_ALIGN float contact[kPack];
  hn::Store(other, Words(), others);
  for (std::size_t lane = 0; lane < hn::Lanes(Floats()); ++lane)
    contact[lane] = static_cast<float>(kinds[robots.kind(static_cast<std::size_t>(own[lane]))].radius +
                                       kinds[robots.kind(static_cast<std::size_t>(others[lane]))].radius);
  return hn::Load(Floats(), contact);
}

template <bool kMixed>
void judge_lists(const Robots& robots, const std::vector<StepsOfKind>& kinds, NearLists& lists, std::uint16_t* clear,
                 std::uint16_t* doubtful) {
  const Floats d;
  const Words words;
  const F both_radii = hn::Set(d, static_cast<float>(2 * kinds[0].radius));
  for (const NearLists::Lanes& pack : lists.packs) {
    const std::size_t last_row = pack.first_row + pack.rows;
    for (std::size_t row = pack.first_row; row < last_row; ++row) lists.near[row] = clear[row] = doubtful[row] = 0;
    for (std::size_t lane = 0; lane < pack.size; lane += hn::Lanes(d)) {
      const std::size_t at = static_cast<std::size_t>(pack.begin) + lane;
      const OwnLanes own(hn::LoadU(words, &robots.x[at]), hn::LoadU(words, &robots.y[at]),
                         hn::LoadU(words, &robots.wish_mx[at]), hn::LoadU(words, &robots.wish_my[at]));
      const W number = hn::Iota(words, static_cast<std::int32_t>(at));
      HWY_ALIGN std::int32_t numbers[kPack];
      if constexpr (kMixed) hn::Store(number, words, numbers);
      for (std::size_t row = pack.first_row; row < last_row; ++row) {
        const W away = hn::PromoteTo(words, hn::LoadU(Halves(), &lists.away[row * kPack + lane]));
        const W other = hn::Add(number, away);
        const std::uint32_t there = bits_of_mask(hn::Ne(away, hn::Zero(words)));
        if (there == 0) break;
        const F contact = kMixed ? mixed_contact(robots, kinds, numbers, other) : both_radii;
        const Judged j = own.judge(robots, other, contact);
        lists.near[row] = static_cast<std::uint16_t>(lists.near[row] | (j.near & there) << lane);
        clear[row] = static_cast<std::uint16_t>(clear[row] | (j.clear & there) << lane);
        doubtful[row] = static_cast<std::uint16_t>(doubtful[row] | (j.doubtful & there) << lane);
      }
    }
  }
}

void judge_all(const Robots& robots, const std::vector<StepsOfKind>& kinds, NearLists& lists, std::uint16_t* clear,
               std::uint16_t* doubtful) {
  kinds.size() > 1 ? judge_lists<true>(robots, kinds, lists, clear, doubtful)
                   : judge_lists<false>(robots, kinds, lists, clear, doubtful);
}

/// Finds the lanes of each pack whose safe motion is not what they wish.
void find_asked(const Robots& robots, const std::vector<NearLists::Lanes>& packs, std::uint16_t* asked) {
  const Words d;
  for (const NearLists::Lanes& pack : packs) {
    std::uint32_t lanes = 0;
    for (std::size_t lane = 0; lane < pack.size; lane += hn::Lanes(d)) {
      const std::size_t at = static_cast<std::size_t>(pack.begin) + lane;
      const auto in_x = hn::Ne(hn::LoadU(d, &robots.safe_mx[at]), hn::LoadU(d, &robots.wish_mx[at])),
                 in_y = hn::Ne(hn::LoadU(d, &robots.safe_my[at]), hn::LoadU(d, &robots.wish_my[at]));
      lanes |= bits_of_mask(hn::Or(in_x, in_y)) << lane;
    }
    *asked++ = static_cast<std::uint16_t>(lanes & ((1U << pack.size) - 1U));
  }
}

/// Writes the pairs whose row may not allow a wish, and returns how many.
std::size_t find_refusing(const PairTable& pairs, std::int32_t* refusing) {
  const Words d;
  const auto granted = hn::Set(d, PairTable::kGrantsBoth);
  std::size_t found = 0;
  for (std::size_t k = 0; k < pairs.size(); k += hn::Lanes(d)) {
    std::uint32_t lanes = bits_of_mask(hn::Ne(hn::LoadU(d, &pairs.flags[k]), granted));
    if (pairs.size() - k < hn::Lanes(d)) lanes &= (1U << (pairs.size() - k)) - 1U;
    for (; lanes != 0; lanes &= lanes - 1) refusing[found++] = static_cast<std::int32_t>(k) + __builtin_ctz(lanes);
  }
  return found;
}

/// One robot and `count` others, which are read to a multiple of kPack.
void judge_one(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot,
               const std::int32_t* others, std::size_t count, std::uint16_t* near, std::uint16_t* clear,
               std::uint16_t* doubtful) {
  const Words words;
  const OwnLanes own(hn::Set(words, robots.x[robot]), hn::Set(words, robots.y[robot]),
                     hn::Set(words, robots.wish_mx[robot]), hn::Set(words, robots.wish_my[robot]));
  HWY_ALIGN std::int32_t numbers[kPack];
  std::fill(numbers, numbers + kPack, static_cast<std::int32_t>(robot));
  for (std::size_t k = 0; k < count; k += hn::Lanes(words)) {
    const W other = hn::LoadU(words, others + k);
    const Judged j = own.judge(robots, other, mixed_contact(robots, kinds, numbers, other));
    const std::size_t lane = k % kPack, row = k / kPack;
    if (lane == 0) near[row] = clear[row] = doubtful[row] = 0;
    near[row] = static_cast<std::uint16_t>(near[row] | j.near << lane);
    clear[row] = static_cast<std::uint16_t>(clear[row] | j.clear << lane);
    doubtful[row] = static_cast<std::uint16_t>(doubtful[row] | j.doubtful << lane);
  }
}

/// Writes rows from `away` on, which has room for as many as there can be, and how many there are.
std::uint32_t list_lanes(std::size_t begin, const Candidates& others, const Ranked& ranked, const float* meeting,
                         const std::int32_t* most, std::int16_t* away, std::size_t& rows) {
  const Floats d;
  const Words words;
  std::uint32_t unknown = 0;
  rows = 0;
  for (int r = 1; r < kMostRanks; ++r) {
    std::uint32_t any = 0;
    for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
      const F key = hn::LoadU(d, ranked.key[r] + lane);
      const auto wanted = hn::LoadU(words, most + lane);
      const auto rank = hn::Set(words, r);
      const auto is_near = hn::RebindMask(words, hn::Lt(key, hn::LoadU(d, meeting + lane)));
      const auto is_there = hn::AndNot(hn::Gt(rank, wanted), is_near);
      const std::uint32_t bits = bits_of_mask(is_there);
      any |= bits;
      if (bits == 0) {
        hn::StoreU(hn::Zero(Halves()), Halves(), away + rows * kPack + lane);
        continue;
      }
      const W number = hn::And(hn::BitCast(words, key), hn::Set(words, kIndexBits));
      const W robot = hn::GatherIndex(words, others.robot, hn::IfThenElseZero(is_there, number));
      const W by =
          hn::IfThenElseZero(is_there, hn::Sub(robot, hn::Iota(words, static_cast<std::int32_t>(begin + lane))));
      const auto half = hn::DemoteTo(Halves(), by);
      hn::StoreU(half, Halves(), away + rows * kPack + lane);
      const auto far = hn::Ne(hn::PromoteTo(words, half), by), is_last = hn::And(is_there, hn::Eq(rank, wanted));
      unknown |= bits_of_mask(hn::Or(far, is_last)) << lane;
    }
    if (any == 0) break;
    ++rows;
  }
  return unknown;
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(judge_all);
HWY_EXPORT(find_asked);
HWY_EXPORT(find_refusing);
HWY_EXPORT(judge_one);
HWY_EXPORT(list_lanes);

namespace {

enum class PairState { far, near, overlapping };

/// Exact.
PairState judged(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t j) {
  const std::int64_t dx = std::int64_t{robots.x[i]} - robots.x[j], dy = std::int64_t{robots.y[i]} - robots.y[j];
  const std::int64_t contact = kinds[robots.kind(i)].radius + kinds[robots.kind(j)].radius;
  const std::int64_t reach =
      contact + longest_way(robots.wish_mx[i], robots.wish_my[i]) + longest_way(robots.wish_mx[j], robots.wish_my[j]);
  const std::int64_t squared = dx * dx + dy * dy, apart = std::max<std::int64_t>(1, contact - kRoundedContact);
  if (squared >= reach * reach) return PairState::far;
  return squared >= apart * apart ? PairState::near : PairState::overlapping;
}

std::size_t lowest(std::uint32_t bits) {
  return static_cast<std::size_t>(__builtin_ctz(bits));
}

template <class Column>
void grow(Column& column, std::size_t size) {
  if (column.size() >= size) return;
  column.reserve(size + size / 8);  // resize alone may take twice as much
  column.resize(size + size / 8);
}

}  // namespace

std::int64_t longest_way(std::int32_t wish_x, std::int32_t wish_y) {
  const std::int64_t x = std::abs(wish_x), y = std::abs(wish_y);
  return std::max(x, y) + std::min(x, y) / 2 + 1 + kRoundingRoom;
}

void NearLists::add(std::size_t begin, std::size_t size, const Candidates& others, const Ranked& ranked,
                    const float* meeting, const std::int32_t* most, std::uint32_t unknown) {
  grow(away, (rows_ + kMostRanks) * kPack);
  grow(near, rows_ + kMostRanks);
  std::size_t rows = 0;
  unknown |= HWY_DYNAMIC_DISPATCH(list_lanes)(begin, others, ranked, meeting, most, away.data() + rows_ * kPack, rows);
  packs.push_back({static_cast<std::int32_t>(begin), static_cast<std::uint32_t>(rows_),
                   static_cast<std::uint16_t>(unknown), static_cast<std::uint8_t>(size),
                   static_cast<std::uint8_t>(rows)});
  rows_ += rows;
}

void NearPairs::start(const std::vector<StepsOfKind>& kinds, std::size_t first, std::size_t last, bool is_first) {
  first_ = first, last_ = last, is_first_ = is_first;
  const double radii = kinds.size() == 1 ? 2.0 * static_cast<double>(kinds[0].radius) : 0.0;
  if (radii != both_radii_) with_radii_ = 0;
  both_radii_ = radii;
  pairs.clear();
  cut.clear();
  overlapping = 0;
  state.assign(last - first, is_first ? kAsked : 0);
  last_of_.resize(last - first);
  std::memset(last_of_.data(), 0xFF, (last - first) * sizeof last_of_[0]);
}

/// The radii of pairs of one kind, once for all places.
void NearPairs::make_radii() {
  if (both_radii_ == 0.0) return;
  std::fill(pairs.radii.begin() + static_cast<std::ptrdiff_t>(with_radii_), pairs.radii.end(), both_radii_);
  with_radii_ = pairs.radii.size();
}

HWY_INLINE void NearPairs::add(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot,
                               std::size_t other, bool of_both) {
  const bool is_a = robots.id[robot] < robots.id[other];
  const std::size_t pair = pairs.add(is_a ? robot : other, is_a ? other : robot);
  if (both_radii_ == 0.0)
    pairs.radii[pair] = static_cast<double>(kinds[robots.kind(robot)].radius + kinds[robots.kind(other)].radius);
  const auto link = [this](std::size_t to, std::size_t entry) {
    pairs.before[entry] = last_of_[to - first_];
    last_of_[to - first_] = static_cast<std::int32_t>(entry);
  };
  link(robot, 2 * pair + std::size_t{!is_a});
  if (of_both) link(other, 2 * pair + std::size_t{is_a});
}

/// Into round_ all robots that `robot` could meet or that overlap it, and what is judged of them.
void NearPairs::look_round(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot) {
  round_.clear();
  const Window at{robots.x[robot], robots.x[robot], robots.y[robot], robots.y[robot]};
  const Cells cells = robots.cells_of(grown(at, kinds[robots.kind(robot)].reach));
  for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
    const Stretch stretch = robots.stretch(cells, row);
    for (std::size_t j = stretch.from; j < stretch.to; ++j)
      if (j != robot && judged(robots, kinds, robot, j) != PairState::far)
        round_.push_back(static_cast<std::int32_t>(j));
  }
  const std::size_t count = round_.size(), rows = count / kPack + 1;
  round_.resize(rows * kPack, static_cast<std::int32_t>(robot));
  for (auto* bits : {&round_near_, &round_clear_, &round_doubtful_}) grow(*bits, rows);
  HWY_DYNAMIC_DISPATCH(judge_one)
  (robots, kinds, robot, round_.data(), count, round_near_.data(), round_clear_.data(), round_doubtful_.data());
  round_.resize(count);
}

/// Robots without a list: where a pair is open, all of them. Whether there are any, open or not.
bool NearPairs::add_of_unknown(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot) {
  look_round(robots, kinds, robot);
  const auto bit = [](const std::vector<std::uint16_t>& of, std::size_t k) {
    return (of[k / kPack] >> k % kPack & 1) != 0;
  };
  std::size_t near = 0;
  bool open = !is_first_, overlaps = false;
  for (std::size_t k = 0; k < round_.size(); ++k) {
    const auto other = static_cast<std::size_t>(round_[k]);
    const PairState pair = bit(round_doubtful_, k) ? judged(robots, kinds, robot, other)
                           : bit(round_near_, k)   ? PairState::near
                                                   : PairState::far;
    overlaps |= pair == PairState::overlapping;
    if (pair != PairState::near) continue;
    const bool is_clear = is_first_ && bit(round_clear_, k);
    open |= !is_clear;
    round_[near++] = is_clear ? -1 - round_[k] : round_[k];
  }
  overlapping += overlaps;
  for (std::size_t k = 0; open && k < near; ++k) {
    const bool is_clear = round_[k] < 0;
    const auto other = static_cast<std::size_t>(is_clear ? -1 - round_[k] : round_[k]);
    const bool both = !is_clear && is_asked(other);
    if (!both || other > robot) add(robots, kinds, robot, other, both);
  }
  return near > 0;
}

void NearPairs::find(Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t first, std::size_t last,
                     NearLists& lists) {
  start(kinds, first, last, true);
  for (auto* bits : {&clear_, &doubtful_}) grow(*bits, lists.rows() + 1);
  HWY_DYNAMIC_DISPATCH(judge_all)(robots, kinds, lists, clear_.data(), doubtful_.data());
  for (const NearLists::Lanes& pack : lists.packs) take_pack(robots, kinds, pack, lists);
  make_radii();
}

void NearPairs::take_pack(Robots& robots, const std::vector<StepsOfKind>& kinds, const NearLists::Lanes& pack,
                          NearLists& lists) {
  const std::uint32_t known = ~std::uint32_t{pack.unknown};
  const auto begin = static_cast<std::size_t>(pack.begin);
  std::uint32_t meets = 0, overlap = 0;
  for (std::size_t row = pack.first_row; row < pack.first_row + std::size_t{pack.rows}; ++row) {
    const std::int16_t* const away = &lists.away[row * kPack];
    const auto other_of = [&](std::size_t lane) {
      return static_cast<std::size_t>(pack.begin + static_cast<std::int32_t>(lane) + away[lane]);
    };
    std::uint32_t near = lists.near[row] & known;
    for (std::uint32_t doubtful = doubtful_[row] & known; doubtful != 0; doubtful &= doubtful - 1) {
      const std::size_t lane = lowest(doubtful);
      const PairState pair = judged(robots, kinds, begin + lane, other_of(lane));
      near |= std::uint32_t{pair == PairState::near} << lane;
      overlap |= std::uint32_t{pair == PairState::overlapping} << lane;
    }
    lists.near[row] = static_cast<std::uint16_t>(near);
    meets |= near;
    std::uint32_t open = near & ~std::uint32_t{clear_[row]};
    for (; open != 0; open &= open - 1) {
      const std::size_t lane = lowest(open), other = other_of(lane);
      const bool both = is_ours(other);
      if (!both || other > begin + lane) add(robots, kinds, begin + lane, other, both);
    }
  }
  overlapping += static_cast<std::size_t>(__builtin_popcount(overlap));
  for (std::uint32_t lanes = pack.unknown; lanes != 0; lanes &= lanes - 1)
    meets |= std::uint32_t{add_of_unknown(robots, kinds, begin + lowest(lanes))} << lowest(lanes);
  for (; meets != 0; meets &= meets - 1) robots.next_kept[begin + lowest(meets)] |= Robots::kHasMet;
}

void NearPairs::add_clear(const Robots& robots, const std::vector<StepsOfKind>& kinds, const NearLists& lists) {
  if (cut.empty()) return;
  for (const NearLists::Lanes& pack : lists.packs) {
    const auto begin = static_cast<std::size_t>(pack.begin);
    std::uint32_t lanes = 0;
    for (std::size_t lane = 0; lane < pack.size; ++lane)
      lanes |= std::uint32_t{(state_of(begin + lane) & kCut) != 0} << lane;
    lanes &= ~std::uint32_t{pack.unknown};
    for (std::size_t row = pack.first_row; lanes != 0 && row < pack.first_row + std::size_t{pack.rows}; ++row)
      for (std::uint32_t clear = lists.near[row] & clear_[row] & lanes; clear != 0; clear &= clear - 1) {
        const std::size_t lane = lowest(clear);
        const std::int32_t own = pack.begin + static_cast<std::int32_t>(lane);
        add(robots, kinds, static_cast<std::size_t>(own),
            static_cast<std::size_t>(own + lists.away[row * kPack + lane]), false);
      }
  }
  make_radii();
}

void NearPairs::find_again(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t first,
                           std::size_t last, const NearLists& lists) {
  start(kinds, first, last, false);
  grow(asked_, lists.packs.size());
  HWY_DYNAMIC_DISPATCH(find_asked)(robots, lists.packs, asked_.data());
  for (std::size_t p = 0; p < lists.packs.size(); ++p)
    for (std::uint32_t lanes = asked_[p]; lanes != 0; lanes &= lanes - 1)
      state_of(static_cast<std::size_t>(lists.packs[p].begin) + lowest(lanes)) = kAsked;
  for (std::size_t p = 0; p < lists.packs.size(); ++p) {
    const std::uint32_t asked = asked_[p];
    if (asked == 0) continue;
    const NearLists::Lanes& pack = lists.packs[p];
    const auto begin = static_cast<std::size_t>(pack.begin);
    for (std::size_t row = pack.first_row; row < pack.first_row + std::size_t{pack.rows}; ++row)
      for (std::uint32_t near = lists.near[row] & asked; near != 0; near &= near - 1) {
        const std::size_t lane = lowest(near), robot = begin + lane;
        const auto other =
            static_cast<std::size_t>(pack.begin + static_cast<std::int32_t>(lane) + lists.away[row * kPack + lane]);
        const bool both = is_asked(other);
        if (!both || other > robot) add(robots, kinds, robot, other, both);
      }
    for (std::uint32_t lanes = pack.unknown & asked; lanes != 0; lanes &= lanes - 1)
      add_of_unknown(robots, kinds, begin + lowest(lanes));
  }
  make_radii();
}

HWY_INLINE void NearPairs::cut_short(std::size_t robot, std::uint8_t how) {
  if (!is_asked(robot)) return;
  std::uint8_t& own = state_of(robot);
  if ((own & kCut) == 0) cut.push_back(static_cast<std::int32_t>(robot));
  own |= kCut | how;
}

void NearPairs::judge_rows() {
  grow(refusing_, pairs.size() + kPack);
  const std::size_t count = HWY_DYNAMIC_DISPATCH(find_refusing)(pairs, refusing_.data());
  for (std::size_t r = 0; r < count; ++r) {
    const auto k = static_cast<std::size_t>(refusing_[r]);
    const std::uint8_t how = pairs.found(k) ? 0 : kStays;
    if (!pairs.grants(k, true)) cut_short(static_cast<std::size_t>(pairs.a[k]), how);
    if (!pairs.grants(k, false)) cut_short(static_cast<std::size_t>(pairs.b[k]), how);
  }
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
