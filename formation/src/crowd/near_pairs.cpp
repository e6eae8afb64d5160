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

/// longest_way.
HWY_INLINE F way_of(W wish_x, W wish_y) {
  const W x = hn::Abs(wish_x), y = hn::Abs(wish_y);
  const W bound = hn::Add(hn::Max(x, y), hn::ShiftRight<1>(hn::Min(x, y)));
  return hn::ConvertTo(Floats(), hn::Add(bound, hn::Set(Words(), 1 + kRoundingRoom)));
}

/// Whether the first `count` pairs could meet surely, or perhaps, and whether (6) holds: a bit each. Arrays are read
/// and written to a multiple of kPack. `both_radii`: of any two robots, if there is one kind.
template <bool kMixed>
void judge_kinds(const Robots& robots, float both_radii, std::size_t count, NearPairs& pairs) {
  const Floats d;
  const Words words;
  const F zero = hn::Zero(d);
  const std::int32_t *x = robots.x.data(), *y = robots.y.data();
  const std::int32_t *wish_x = robots.wish_mx.data(), *wish_y = robots.wish_my.data();
  std::uint64_t near_bits = 0, clear_bits = 0, doubtful_bits = 0;
  const auto bits_of = [](hn::Mask<Floats> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Floats(), mask, bytes);
    return bytes[0] | static_cast<std::uint64_t>(bytes[1]) << 8U;
  };
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const W i = hn::LoadU(words, &pairs.all_robots[k]), j = hn::LoadU(words, &pairs.all_others[k]);
    const F contact = kMixed ? hn::LoadU(d, &pairs.contact[k]) : hn::Set(d, both_radii);
    const W own_x = hn::GatherIndex(words, wish_x, i), own_y = hn::GatherIndex(words, wish_y, i);
    const W its_x = hn::GatherIndex(words, wish_x, j), its_y = hn::GatherIndex(words, wish_y, j);
    const F dx = hn::ConvertTo(d, hn::Sub(hn::GatherIndex(words, x, i), hn::GatherIndex(words, x, j)));
    const F dy = hn::ConvertTo(d, hn::Sub(hn::GatherIndex(words, y, i), hn::GatherIndex(words, y, j)));
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
    near_bits |= bits_of(surely) << lane;
    doubtful_bits |= bits_of(hn::AndNot(surely, perhaps)) << lane;
    clear_bits |= bits_of(hn::Ge(room, left)) << lane;
    if (lane + hn::Lanes(d) < kPack && k + hn::Lanes(d) < count) continue;
    for (std::size_t byte = 0; byte < kPack / 8; ++byte) {
      const std::size_t at = k / kPack * (kPack / 8) + byte;
      pairs.near[at] = static_cast<std::uint8_t>(near_bits >> 8 * byte);
      pairs.clear[at] = static_cast<std::uint8_t>(clear_bits >> 8 * byte);
      pairs.doubtful[at] = static_cast<std::uint8_t>(doubtful_bits >> 8 * byte);
    }
    near_bits = clear_bits = doubtful_bits = 0;
  }
}

void judge(const Robots& robots, bool mixed, float both_radii, std::size_t count, NearPairs& pairs) {
  mixed ? judge_kinds<true>(robots, both_radii, count, pairs) : judge_kinds<false>(robots, both_radii, count, pairs);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(judge);

namespace {

/// Pairs of a robot whose bits are taken at once.
constexpr std::size_t kBits = 32;

enum class PairState { far, near, overlapping };

PairState state_of(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t j) {
  const std::int64_t dx = std::int64_t{robots.x[i]} - robots.x[j], dy = std::int64_t{robots.y[i]} - robots.y[j];
  const std::int64_t contact = kinds[robots.kind(i)].radius + kinds[robots.kind(j)].radius;
  const std::int64_t reach =
      contact + longest_way(robots.wish_mx[i], robots.wish_my[i]) + longest_way(robots.wish_mx[j], robots.wish_my[j]);
  const std::int64_t squared = dx * dx + dy * dy, apart = std::max<std::int64_t>(1, contact - kRoundedContact);
  if (squared >= reach * reach) return PairState::far;
  return squared >= apart * apart ? PairState::near : PairState::overlapping;
}

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

/// The pairs of robots, of which those that could meet are looked for.
class PairFinder {
 public:
  PairFinder(const Robots& robots, const std::vector<StepsOfKind>& kinds, NearPairs& out)
      : robots_(robots), kinds_(kinds), out_(out) {}

  void list(const NearLists& lists, std::size_t begin, const std::vector<AskedRobot>& asked) {
    const std::size_t listed_most = kMostNeighbours * asked.size() + kPack;
    make_room(listed_most);
    const std::uint8_t* const counts = lists.count.data();
    std::size_t* const ends = out_.all_end.data();
    std::int32_t *own = out_.all_robots.data(), *its = out_.all_others.data();
    std::size_t count = 0;
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const std::size_t robot = asked[k].robot, listed = counts[robot - begin];
      if (listed == NearLists::kUnknown) {
        look_round(robot, count, listed_most);
        own = out_.all_robots.data(), its = out_.all_others.data();
      } else {
        const std::int16_t* const away = lists.away.data() + asked[k].list;
        const auto i = static_cast<std::int32_t>(robot);
        for (std::size_t n = 0; n < listed; ++n, ++count) {
          own[count] = i;
          its[count] = i + away[n];
        }
      }
      ends[k] = count;
    }
    for (std::size_t k = count; k % kPack != 0; ++k) own[k] = its[k] = 0;
    put_contacts(count);
  }

  void judge_all() const {
    const std::size_t count = out_.all_end.back(), bytes = (count / kPack + 1) * (kPack / 8) + sizeof(std::uint64_t);
    for (auto* bits : {&out_.near, &out_.clear, &out_.doubtful})
      if (bits->size() < bytes) bits->resize(bytes);
    HWY_DYNAMIC_DISPATCH(judge)(robots_, kinds_.size() > 1, both_radii(0, 0), count, out_);
  }

  void take(const std::vector<AskedRobot>& asked, bool from_rest) const {
    const std::size_t most = out_.all_end.back() + kPack;
    if (out_.robot.size() < most) out_.robot.resize(2 * most), out_.other.resize(2 * most);
    std::int32_t *const robots = out_.robot.data(), *const others = out_.other.data();
    const std::int32_t* const its = out_.all_others.data();
    const std::size_t* const all_ends = out_.all_end.data();
    std::size_t* const ends = out_.end.data();
    std::uint8_t* const states = out_.state.data();
    const Bits near_bits(out_.near), clear_bits(out_.clear), doubtful_bits(out_.doubtful);
    std::size_t from = 0, count = 0;
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const std::size_t first = count;
      std::uint64_t hinders = 0;
      bool overlaps = false;
      for (const std::size_t end = all_ends[k]; from < end;) {
        const std::size_t some = std::min(kBits, end - from);
        std::uint64_t near = near_bits.take(from, some), doubtful = doubtful_bits.take(from, some);
        for (; doubtful != 0; doubtful &= doubtful - 1) {
          const auto n = static_cast<std::size_t>(__builtin_ctzll(doubtful));
          const PairState state = state_of(robots_, kinds_, asked[k].robot, other(from + n));
          near |= std::uint64_t{state == PairState::near} << n;
          overlaps |= state == PairState::overlapping;
        }
        hinders |= near & ~clear_bits.take(from, some);
        for (; near != 0; near &= near - 1) {
          robots[count] = static_cast<std::int32_t>(asked[k].robot);
          others[count++] = its[from + static_cast<std::size_t>(__builtin_ctzll(near))];
        }
        from += some;
      }
      const bool meets = count > first, is_hindered = from_rest ? hinders != 0 : meets;
      if (!is_hindered) count = first;
      ends[k] = count;
      states[k] =
          static_cast<std::uint8_t>((meets ? NearPairs::kMeets : 0U) | (is_hindered ? NearPairs::kHindered : 0U) |
                                    (overlaps ? NearPairs::kOverlaps : 0U));
    }
  }

 private:
  std::size_t other(std::size_t k) const { return static_cast<std::size_t>(out_.all_others[k]); }

  void make_room(std::size_t pairs) {
    if (out_.all_others.size() >= pairs) return;
    out_.all_robots.resize(2 * pairs);
    out_.all_others.resize(2 * pairs);
  }

  /// All robots that could be met, and those that overlap it. Leaves room for `more`.
  void look_round(std::size_t i, std::size_t& count, std::size_t more) {
    const Window at{robots_.x[i], robots_.x[i], robots_.y[i], robots_.y[i]};
    const Cells cells = robots_.cells_of(grown(at, kinds_[robots_.kind(i)].reach));
    for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
      const Stretch stretch = robots_.stretch(cells, row);
      for (std::size_t j = stretch.from; j < stretch.to; ++j) {
        if (j == i || state_of(robots_, kinds_, i, j) == PairState::far) continue;
        make_room(count + 1 + more);
        out_.all_robots[count] = static_cast<std::int32_t>(i);
        out_.all_others[count++] = static_cast<std::int32_t>(j);
      }
    }
  }

  void put_contacts(std::size_t count) const {
    if (kinds_.size() == 1) return;
    if (out_.contact.size() < count + kPack) out_.contact.resize(2 * count + kPack);
    for (std::size_t k = 0; k < count; ++k)
      out_.contact[k] = both_radii(robots_.kind(static_cast<std::size_t>(out_.all_robots[k])), robots_.kind(other(k)));
  }

  float both_radii(std::size_t a, std::size_t b) const {
    return static_cast<float>(kinds_[a].radius + kinds_[b].radius);
  }

  const Robots& robots_;
  const std::vector<StepsOfKind>& kinds_;
  NearPairs& out_;
};

}  // namespace

std::int64_t longest_way(std::int32_t wish_x, std::int32_t wish_y) {
  const std::int64_t x = std::abs(wish_x), y = std::abs(wish_y);
  return std::max(x, y) + std::min(x, y) / 2 + 1 + kRoundingRoom;
}

void find_near_pairs(const Robots& robots, const std::vector<StepsOfKind>& kinds, const NearLists& lists,
                     std::size_t begin, const std::vector<AskedRobot>& asked, bool from_rest, NearPairs& out) {
  out.end.resize(asked.size());
  out.all_end.resize(asked.size());
  out.state.resize(asked.size());
  if (asked.empty()) return;
  PairFinder pairs(robots, kinds, out);
  pairs.list(lists, begin, asked);
  pairs.judge_all();
  pairs.take(asked, from_rest);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
