// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/near_pairs.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/near_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef EXACTVO_NEAR_PAIRS_ONCE
#define EXACTVO_NEAR_PAIRS_ONCE
namespace exactvo::formation::crowd {

/// Lattice steps by which a motion may be longer than the wish: what rounding to the lattice adds, and some.
inline constexpr std::int32_t kRoundingRoom = 4;

enum class PairState { far, near, overlapping };

/// By whole numbers.
PairState state_of(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t j);

/// Behind the first `count` pairs of out.judged_other all robots that `i` could meet or that overlap it, in the order
/// of their places; how many there are then. Leaves room for `more`.
std::size_t look_round(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t count,
                       std::size_t more, NearPairs& out);

}  // namespace exactvo::formation::crowd
#endif

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kPack>;
using Words = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using W = hn::Vec<Words>;

/// Above what squared distances, in float, are off by: 13 roundings.
constexpr float kWider = 1.0F + 0x1p-18F, kNarrower = 1.0F - 0x1p-18F;

/// What (6) is asked to have left: of S, and steps.
constexpr float kShareLeft = 0x1p-18F, kLeft = 1.0F;

HWY_INLINE std::uint64_t bits_of_mask(hn::Mask<Floats> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  return bytes[0] | static_cast<std::uint64_t>(bytes[1]) << 8U;
}

/// longest_way.
HWY_INLINE F way_of(W wish_x, W wish_y) {
  const W x = hn::Abs(wish_x), y = hn::Abs(wish_y);
  const W bound = hn::Add(hn::Max(x, y), hn::ShiftRight<1>(hn::Min(x, y)));
  return hn::ConvertTo(Floats(), hn::Add(bound, hn::Set(Words(), 1 + kRoundingRoom)));
}

/// The pairs of robots side by side. Writes whole registers.
class PairLayout {
 public:
  HWY_INLINE PairLayout(const Robots& robots, NearPairs& out) : robots_(robots), out_(out) {}

  std::size_t count = 0;

  /// The own columns of pairs from `count` to `end`.
  HWY_INLINE void put_own(std::size_t robot, std::size_t end) const {
    const Words d;
    const W x = hn::Set(d, robots_.x[robot]), y = hn::Set(d, robots_.y[robot]);
    const W wish_x = hn::Set(d, robots_.wish_mx[robot]), wish_y = hn::Set(d, robots_.wish_my[robot]);
    std::int32_t *const own_x = out_.own_x.data(), *const own_y = out_.own_y.data();
    std::int32_t *const own_wish_x = out_.own_wish_x.data(), *const own_wish_y = out_.own_wish_y.data();
    for (std::size_t k = count; k < end; k += hn::Lanes(d)) {
      hn::StoreU(x, d, own_x + k);
      hn::StoreU(y, d, own_y + k);
      hn::StoreU(wish_x, d, own_wish_x + k);
      hn::StoreU(wish_y, d, own_wish_y + k);
    }
  }

  HWY_INLINE void put_listed(std::size_t robot, const std::int16_t* away, std::size_t listed) const {
    const Words d;
    const W own = hn::Set(d, static_cast<std::int32_t>(robot));
    std::int32_t* const to = out_.judged_other.data() + count;
    for (std::size_t n = 0; n < listed; n += hn::Lanes(d))
      hn::StoreU(hn::Add(own, hn::PromoteTo(d, hn::LoadU(hn::Rebind<std::int16_t, Words>(), away + n))), d, to + n);
  }

 private:
  const Robots& robots_;
  NearPairs& out_;
};

/// Whether the first `count` pairs could meet surely, or perhaps, and whether (6) holds: a bit each. Reads and writes
/// to a multiple of kPack. `both_radii`: of any two robots, if there is one kind.
template <bool kMixed>
void judge(const Robots& robots, float both_radii, std::size_t count, NearPairs& pairs) {
  const Floats d;
  const Words words;
  const F zero = hn::Zero(d);
  std::uint64_t near = 0, clear = 0, doubtful = 0;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const W other = hn::LoadU(words, &pairs.judged_other[k]);
    const W own_x = hn::LoadU(words, &pairs.own_wish_x[k]), own_y = hn::LoadU(words, &pairs.own_wish_y[k]);
    const W its_x = hn::GatherIndex(words, robots.wish_mx.data(), other),
            its_y = hn::GatherIndex(words, robots.wish_my.data(), other);
    const F dx =
        hn::ConvertTo(d, hn::Sub(hn::LoadU(words, &pairs.own_x[k]), hn::GatherIndex(words, robots.x.data(), other)));
    const F dy =
        hn::ConvertTo(d, hn::Sub(hn::LoadU(words, &pairs.own_y[k]), hn::GatherIndex(words, robots.y.data(), other)));
    const F contact = kMixed ? hn::LoadU(d, &pairs.contact[k]) : hn::Set(d, both_radii);
    const F squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const F reach = hn::Add(contact, hn::Add(way_of(own_x, own_y), way_of(its_x, its_y)));
    const F limit = hn::Mul(reach, reach);
    const F apart = hn::Max(hn::Set(d, 1.0F), hn::Sub(contact, hn::Set(d, static_cast<float>(kRoundedContact))));
    const auto perhaps = hn::Lt(squared, hn::Mul(limit, hn::Set(d, kWider)));
    const auto surely = hn::And(hn::Lt(squared, hn::Mul(limit, hn::Set(d, kNarrower))),
                                hn::Gt(squared, hn::Mul(hn::Mul(apart, apart), hn::Set(d, kWider))));
    const F own = hn::Add(hn::Mul(dx, hn::ConvertTo(d, own_x)), hn::Mul(dy, hn::ConvertTo(d, own_y)));
    const F its = hn::Add(hn::Mul(dx, hn::ConvertTo(d, its_x)), hn::Mul(dy, hn::ConvertTo(d, its_y)));
    const F needs = hn::Add(hn::Max(zero, hn::Neg(own)), hn::Max(zero, its));
    const F distance = hn::Sqrt(squared);
    const F room = hn::Sub(hn::Sub(squared, hn::Mul(contact, distance)), needs);
    const F sum = hn::Add(distance, reach);
    const F left = hn::Mul(distance, hn::Add(hn::Mul(sum, hn::Set(d, kShareLeft)), hn::Set(d, kLeft)));
    const std::size_t lane = k % kPack;
    near |= bits_of_mask(surely) << lane;
    doubtful |= bits_of_mask(hn::AndNot(surely, perhaps)) << lane;
    clear |= bits_of_mask(hn::Ge(room, left)) << lane;
    if (lane + hn::Lanes(d) < kPack && k + hn::Lanes(d) < count) continue;
    const std::size_t byte = k / kPack * (kPack / 8);
    std::memcpy(&pairs.near[byte], &near, kPack / 8);
    std::memcpy(&pairs.clear[byte], &clear, kPack / 8);
    std::memcpy(&pairs.doubtful[byte], &doubtful, kPack / 8);
    near = clear = doubtful = 0;
  }
}

template <bool kMixed>
void lay_out_and_judge(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
                       const std::vector<AskedRobot>& asked, bool first_round, const NearLists& lists, NearPairs& out) {
  PairLayout pairs(robots, out);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const std::size_t robot = asked[k].robot, listed = lists.count[robot - begin];
    std::size_t end = pairs.count;
    if (listed == NearLists::kUnknown) {
      end = look_round(robots, kinds, robot, pairs.count, kMostNeighbours * asked.size(), out);
    } else if (first_round) {
      end += listed;
      pairs.put_listed(robot, lists.away.data() + asked[k].list, listed);
    }
    pairs.put_own(robot, end);
    if constexpr (kMixed)
      for (std::size_t n = pairs.count; n < end; ++n)
        out.contact[n] = static_cast<float>(kinds[robots.kind(robot)].radius +
                                            kinds[robots.kind(static_cast<std::size_t>(out.judged_other[n]))].radius);
    out.judged_end[k] = pairs.count = end;
  }
  for (std::size_t k = pairs.count; k % kPack != 0; ++k) out.judged_other[k] = 0;
  judge<kMixed>(robots, static_cast<float>(2 * kinds[0].radius), pairs.count, out);
}

void judge_all(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
               const std::vector<AskedRobot>& asked, bool first_round, const NearLists& lists, NearPairs& out) {
  kinds.size() > 1 ? lay_out_and_judge<true>(robots, kinds, begin, asked, first_round, lists, out)
                   : lay_out_and_judge<false>(robots, kinds, begin, asked, first_round, lists, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(judge_all);

namespace {

/// Bits that are taken at once.
constexpr std::size_t kBits = 32;

/// A bit a pair.
class Bits {
 public:
  explicit Bits(const std::vector<std::uint8_t>& of) : of_(of.data()) {}

  /// So many from `from` on, kBits at most.
  std::uint64_t take(std::size_t from, std::size_t count) const {
    std::uint64_t word = 0;
    std::memcpy(&word, of_ + from / 8, sizeof word);
    return word >> from % 8 & ((std::uint64_t{1} << count) - 1U);
  }

 private:
  const std::uint8_t* of_;
};

/// From bits to the pairs of hindered robots.
class PairTaker {
 public:
  PairTaker(const Robots& robots, const std::vector<StepsOfKind>& kinds, NearPairs& out)
      : robots_(robots),
        kinds_(kinds),
        near_(out.near),
        clear_(out.clear),
        doubtful_(out.doubtful),
        robot_(out.robot.data()),
        other_(out.other.data()),
        judged_(out.judged_other.data()) {}

  /// Pairs `from` to `end` of those that were judged. `hinders`: whatever (6) says. `list`: of the robot; null if it
  /// has none. Leaves in it what is taken.
  std::uint8_t take(std::size_t robot, std::size_t from, std::size_t end, bool hinders, std::int16_t* list) {
    const std::size_t first = count_;
    std::uint64_t open = 0;
    bool meets = false, overlaps = false;
    for (std::size_t at = from; at < end; at += kBits) {
      const std::size_t some = std::min(kBits, end - at);
      std::uint64_t near = near_.take(at, some), doubtful = doubtful_.take(at, some);
      for (; doubtful != 0; doubtful &= doubtful - 1) {
        const auto n = static_cast<std::size_t>(__builtin_ctzll(doubtful));
        const PairState state = state_of(robots_, kinds_, robot, static_cast<std::size_t>(judged_[at + n]));
        near |= std::uint64_t{state == PairState::near} << n;
        overlaps |= state == PairState::overlapping;
      }
      meets |= near != 0;
      open |= near & ~clear_.take(at, some);
      for (; near != 0; near &= near - 1)
        other_[count_++] = judged_[at + static_cast<std::size_t>(__builtin_ctzll(near))];
    }
    const bool is_hindered = meets && (hinders || open != 0);
    if (is_hindered)
      put_in_order(robot, first, list, end - from);
    else
      count_ = first;
    return static_cast<std::uint8_t>((meets ? NearPairs::kMeets : 0U) | (is_hindered ? NearPairs::kHindered : 0U) |
                                     (overlaps ? NearPairs::kOverlaps : 0U));
  }

  /// A list that was cut.
  std::uint8_t believe(std::size_t robot, const std::int16_t* list, std::size_t listed) {
    for (std::size_t n = 0; n < listed && list[n] != 0; ++n, ++count_) {
      robot_[count_] = static_cast<std::int32_t>(robot);
      other_[count_] = static_cast<std::int32_t>(robot) + list[n];
    }
    return NearPairs::kMeets | NearPairs::kHindered;
  }

  std::size_t count() const { return count_; }

 private:
  /// By the others' places; those from `first` on, into the list too.
  void put_in_order(std::size_t robot, std::size_t first, std::int16_t* list, std::size_t listed) const {
    const auto own = static_cast<std::int32_t>(robot);
    for (std::size_t k = first; k < count_; ++k) {
      const std::int32_t other = other_[k];
      std::size_t at = k;
      for (; at > first && other_[at - 1] > other; --at) {
        other_[at] = other_[at - 1];
        if (list) list[at - first] = list[at - 1 - first];
      }
      other_[at] = other;
      robot_[k] = own;
      if (list) list[at - first] = static_cast<std::int16_t>(other - own);
    }
    if (list && count_ - first < listed) list[count_ - first] = 0;
  }

  const Robots& robots_;
  const std::vector<StepsOfKind>& kinds_;
  Bits near_, clear_, doubtful_;
  std::int32_t *robot_, *other_;
  const std::int32_t* judged_;
  std::size_t count_ = 0;
};

}  // namespace

std::int64_t longest_way(std::int32_t wish_x, std::int32_t wish_y) {
  const std::int64_t x = std::abs(wish_x), y = std::abs(wish_y);
  return std::max(x, y) + std::min(x, y) / 2 + 1 + kRoundingRoom;
}

PairState state_of(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t j) {
  const std::int64_t dx = std::int64_t{robots.x[i]} - robots.x[j], dy = std::int64_t{robots.y[i]} - robots.y[j];
  const std::int64_t contact = kinds[robots.kind(i)].radius + kinds[robots.kind(j)].radius;
  const std::int64_t reach =
      contact + longest_way(robots.wish_mx[i], robots.wish_my[i]) + longest_way(robots.wish_mx[j], robots.wish_my[j]);
  const std::int64_t squared = dx * dx + dy * dy, apart = std::max<std::int64_t>(1, contact - kRoundedContact);
  if (squared >= reach * reach) return PairState::far;
  return squared >= apart * apart ? PairState::near : PairState::overlapping;
}

namespace {

/// For so many pairs that are judged.
void make_room(std::size_t pairs, NearPairs& out) {
  const std::size_t room = pairs + 2 * kPack;
  if (out.judged_other.size() >= room) return;
  for (auto* column : {&out.judged_other, &out.own_x, &out.own_y, &out.own_wish_x, &out.own_wish_y})
    column->resize(2 * room);
  out.contact.resize(2 * room);
  for (auto* bits : {&out.near, &out.clear, &out.doubtful}) bits->resize(2 * room / 8 + sizeof(std::uint64_t));
}

}  // namespace

std::size_t look_round(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t count,
                       std::size_t more, NearPairs& out) {
  const Window at{robots.x[i], robots.x[i], robots.y[i], robots.y[i]};
  const Cells cells = robots.cells_of(grown(at, kinds[robots.kind(i)].reach));
  for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
    const Stretch stretch = robots.stretch(cells, row);
    for (std::size_t j = stretch.from; j < stretch.to; ++j) {
      if (j == i || state_of(robots, kinds, i, j) == PairState::far) continue;
      make_room(count + 1 + more, out);
      out.judged_other[count++] = static_cast<std::int32_t>(j);
    }
  }
  return count;
}

void find_near_pairs(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
                     const std::vector<AskedRobot>& asked, bool first_round, NearLists& lists, NearPairs& out) {
  out.end.resize(asked.size());
  out.state.resize(asked.size());
  out.judged_end.resize(asked.size());
  const std::size_t listed_most = kMostNeighbours * asked.size();
  make_room(listed_most, out);
  HWY_DYNAMIC_DISPATCH(judge_all)(robots, kinds, begin, asked, first_round, lists, out);
  const std::size_t most = kPack + listed_most + (asked.empty() ? 0 : out.judged_end.back());
  if (out.robot.size() < most) out.robot.resize(2 * most), out.other.resize(2 * most);
  PairTaker taker(robots, kinds, out);
  std::size_t from = 0;
  for (std::size_t k = 0; k < asked.size(); from = out.judged_end[k++]) {
    const std::size_t robot = asked[k].robot, listed = lists.count[robot - begin];
    std::int16_t* const list = lists.away.data() + asked[k].list;
    if (first_round || listed == NearLists::kUnknown) {
      out.state[k] =
          taker.take(robot, from, out.judged_end[k], !first_round, listed == NearLists::kUnknown ? nullptr : list);
    } else {
      out.state[k] = taker.believe(robot, list, listed);
    }
    out.end[k] = taker.count();
  }
  for (std::size_t k = taker.count(); k % kPack != 0; ++k) out.robot[k] = out.other[k] = 0;  // read, but not used
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
