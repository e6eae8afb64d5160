// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/near_pairs.h"

#include <algorithm>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/near_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/to_front.h"

#ifndef EXACTVO_NEAR_PAIRS_ONCE
#define EXACTVO_NEAR_PAIRS_ONCE
namespace exactvo::formation::crowd {

/// Lattice steps by which a motion may be longer than the wish: what rounding to the lattice adds, and some.
inline constexpr std::int32_t kRoundingRoom = 4;

enum class PairState { far, near, overlapping };

/// By whole numbers.
PairState state_of(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i, std::size_t j);

/// Into `out` all robots that `i` could meet or that overlap it, in the order of their places; how many. Readable to
/// kPack beyond.
std::size_t look_round(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i,
                       Array<std::int32_t>& out);

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

HWY_INLINE std::uint32_t bits_of_mask(hn::Mask<Floats> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U;
}

/// longest_way.
HWY_INLINE F way_of(W wish_x, W wish_y) {
  const W x = hn::Abs(wish_x), y = hn::Abs(wish_y);
  const W bound = hn::Add(hn::Max(x, y), hn::ShiftRight<1>(hn::Min(x, y)));
  return hn::ConvertTo(Floats(), hn::Add(bound, hn::Set(Words(), 1 + kRoundingRoom)));
}

/// The pairs of one robot after the other.
template <bool kMixed>
class Judge {
 public:
  HWY_INLINE Judge(const Robots& robots, const std::vector<StepsOfKind>& kinds, NearPairs& out)
      : robots_(robots),
        kinds_(kinds),
        out_(out),
        both_radii_(hn::Set(Floats(), static_cast<float>(2 * kinds[0].radius))) {}

  HWY_INLINE void begin(std::size_t robot) {
    const Floats d;
    const Words words;
    robot_ = robot;
    x_ = hn::Set(words, robots_.x[robot]);
    y_ = hn::Set(words, robots_.y[robot]);
    const W wish_x = hn::Set(words, robots_.wish_mx[robot]), wish_y = hn::Set(words, robots_.wish_my[robot]);
    wish_x_ = hn::ConvertTo(d, wish_x);
    wish_y_ = hn::ConvertTo(d, wish_y);
    way_ = way_of(wish_x, wish_y);
    first_ = count_;
    hinders_ = 0;
    overlaps_ = false;
  }

  /// The first `count` of some others.
  HWY_INLINE void look(W others, std::size_t count) {
    const Floats d;
    const Words words;
    const F zero = hn::Zero(d);
    const auto there = hn::FirstN(words, count);
    const W j = hn::IfThenElseZero(there, others);
    const W wish_x = hn::GatherIndex(words, robots_.wish_mx.data(), j),
            wish_y = hn::GatherIndex(words, robots_.wish_my.data(), j);
    const F dx = hn::ConvertTo(d, hn::Sub(x_, hn::GatherIndex(words, robots_.x.data(), j)));
    const F dy = hn::ConvertTo(d, hn::Sub(y_, hn::GatherIndex(words, robots_.y.data(), j)));
    const F contact = kMixed ? contacts(j, count) : both_radii_;
    const F squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const F reach = hn::Add(contact, hn::Add(way_, way_of(wish_x, wish_y)));
    const F limit = hn::Mul(reach, reach);
    const F apart = hn::Max(hn::Set(d, 1.0F), hn::Sub(contact, hn::Set(d, static_cast<float>(kRoundedContact))));
    const auto is_other = hn::RebindMask(d, there);
    const auto perhaps = hn::And(is_other, hn::Lt(squared, hn::Mul(limit, hn::Set(d, kWider))));
    const auto surely = hn::And(hn::And(is_other, hn::Lt(squared, hn::Mul(limit, hn::Set(d, kNarrower)))),
                                hn::Gt(squared, hn::Mul(hn::Mul(apart, apart), hn::Set(d, kWider))));
    const F own = hn::Add(hn::Mul(dx, wish_x_), hn::Mul(dy, wish_y_));
    const F its = hn::Add(hn::Mul(dx, hn::ConvertTo(d, wish_x)), hn::Mul(dy, hn::ConvertTo(d, wish_y)));
    const F needs = hn::Add(hn::Max(zero, hn::Neg(own)), hn::Max(zero, its));
    const F distance = hn::Sqrt(squared);
    const F room = hn::Sub(hn::Sub(squared, hn::Mul(contact, distance)), needs);
    const F sum = hn::Add(distance, reach);
    const F left = hn::Mul(distance, hn::Add(hn::Mul(sum, hn::Set(d, kShareLeft)), hn::Set(d, kLeft)));
    const auto clear = hn::Ge(room, left);
    const std::uint32_t doubtful = bits_of_mask(hn::AndNot(surely, perhaps));
    if (doubtful != 0) return look_closely(j, bits_of_mask(surely), doubtful, bits_of_mask(clear));
    hinders_ |= static_cast<std::uint32_t>(!hn::AllFalse(d, hn::AndNot(clear, surely)));
    const auto near = hn::RebindMask(words, surely);
    hn::StoreU(ToFront<Words>(near)(j), words, out_.other.data() + count_);
    hn::StoreU(hn::Set(words, static_cast<std::int32_t>(robot_)), words, out_.robot.data() + count_);
    count_ += hn::CountTrue(words, near);
  }

  /// `list`: of the robot; null if it has none.
  HWY_INLINE void end(std::size_t k, bool first_round, std::int16_t* list, std::size_t listed) {
    const bool meets = count_ > first_, is_hindered = first_round ? hinders_ != 0 : meets;
    if (!is_hindered)
      count_ = first_;
    else
      put_in_order();
    if (is_hindered && list != nullptr) cut(list, listed);
    put(k, meets, is_hindered);
  }

  /// A robot whose list was cut.
  HWY_INLINE void believe(std::size_t k, std::size_t robot, const std::int16_t* list, std::size_t listed) {
    const std::size_t first = count_;
    for (std::size_t n = 0; n < listed && list[n] != 0; ++n, ++count_) {
      out_.robot[count_] = static_cast<std::int32_t>(robot);
      out_.other[count_] = static_cast<std::int32_t>(robot) + list[n];
    }
    overlaps_ = false;
    put(k, count_ > first, count_ > first);
  }

  /// For so many more pairs.
  HWY_INLINE void make_room(std::size_t pairs) const {
    const std::size_t room = count_ + pairs + kPack;
    if (out_.other.size() < room) out_.other.resize(2 * room), out_.robot.resize(2 * room);
  }

 private:
  HWY_INLINE void put(std::size_t k, bool meets, bool is_hindered) const {
    out_.end[k] = count_;
    out_.state[k] =
        static_cast<std::uint8_t>((meets ? NearPairs::kMeets : 0U) | (is_hindered ? NearPairs::kHindered : 0U) |
                                  (overlaps_ ? NearPairs::kOverlaps : 0U));
  }

  /// By the others' places.
  HWY_INLINE void put_in_order() const {
    std::int32_t* const others = out_.other.data();
    for (std::size_t k = first_ + 1; k < count_; ++k) {
      const std::int32_t other = others[k];
      std::size_t at = k;
      for (; at > first_ && others[at - 1] > other; --at) others[at] = others[at - 1];
      others[at] = other;
    }
  }

  HWY_INLINE void cut(std::int16_t* list, std::size_t listed) const {
    for (std::size_t n = first_; n < count_; ++n)
      list[n - first_] = static_cast<std::int16_t>(out_.other[n] - static_cast<std::int32_t>(robot_));
    if (count_ - first_ < listed) list[count_ - first_] = 0;
  }

  /// Where float cannot tell whether a pair could meet.
  HWY_NOINLINE void look_closely(W others, std::uint32_t near, std::uint32_t doubtful, std::uint32_t clear) {
    alignas(64) std::int32_t j[kPack];
    hn::Store(others, Words(), j);
    for (; doubtful != 0; doubtful &= doubtful - 1) {
      const int lane = __builtin_ctz(doubtful);
      const PairState state = state_of(robots_, kinds_, robot_, static_cast<std::size_t>(j[lane]));
      near |= std::uint32_t{state == PairState::near} << lane;
      overlaps_ |= state == PairState::overlapping;
    }
    hinders_ |= near & ~clear;
    for (; near != 0; near &= near - 1) {
      out_.robot[count_] = static_cast<std::int32_t>(robot_);
      out_.other[count_++] = j[__builtin_ctz(near)];
    }
  }

  F contacts(W others, std::size_t count) const {
    alignas(64) std::int32_t j[kPack];
    alignas(64) float both[kPack] = {};
    hn::Store(others, Words(), j);
    const std::int64_t own = kinds_[robots_.kind(robot_)].radius;
    for (std::size_t lane = 0; lane < std::min(count, hn::Lanes(Words())); ++lane)
      both[lane] = static_cast<float>(own + kinds_[robots_.kind(static_cast<std::size_t>(j[lane]))].radius);
    return hn::Load(Floats(), both);
  }

  const Robots& robots_;
  const std::vector<StepsOfKind>& kinds_;
  NearPairs& out_;
  F both_radii_;
  W x_, y_;
  F wish_x_, wish_y_, way_;
  std::size_t robot_ = 0, first_ = 0, count_ = 0;
  std::uint32_t hinders_ = 0;  ///< not 0: a pair whose wishes are not surely allowed
  bool overlaps_ = false;
};

template <bool kMixed>
void find_in(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
             const std::vector<AskedRobot>& asked, bool first_round, NearLists& lists, NearPairs& out) {
  const Words words;
  const std::size_t lanes = hn::Lanes(words);
  Judge<kMixed> judge(robots, kinds, out);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const std::size_t robot = asked[k].robot, listed = lists.count[robot - begin];
    std::int16_t* const away = lists.away.data() + asked[k].list;
    judge.make_room(kMostNeighbours);
    if (listed == NearLists::kUnknown) {
      const std::size_t count = look_round(robots, kinds, robot, out.round);
      judge.make_room(count);
      judge.begin(robot);
      for (std::size_t n = 0; n < count; n += lanes) judge.look(hn::LoadU(words, &out.round[n]), count - n);
      judge.end(k, first_round, nullptr, 0);
    } else if (!first_round || listed == 0) {
      judge.believe(k, robot, away, listed);
    } else {
      const W own = hn::Set(words, static_cast<std::int32_t>(robot));
      judge.begin(robot);
      for (std::size_t n = 0; n < listed; n += lanes) {
        const auto by = hn::PromoteTo(words, hn::LoadU(hn::Rebind<std::int16_t, Words>(), away + n));
        judge.look(hn::Add(own, by), listed - n);
      }
      judge.end(k, first_round, away, listed);
    }
  }
}

void find(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
          const std::vector<AskedRobot>& asked, bool first_round, NearLists& lists, NearPairs& out) {
  kinds.size() > 1 ? find_in<true>(robots, kinds, begin, asked, first_round, lists, out)
                   : find_in<false>(robots, kinds, begin, asked, first_round, lists, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(find);

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

std::size_t look_round(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t i,
                       Array<std::int32_t>& out) {
  const Window at{robots.x[i], robots.x[i], robots.y[i], robots.y[i]};
  const Cells cells = robots.cells_of(grown(at, kinds[robots.kind(i)].reach));
  std::size_t count = 0;
  for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
    const Stretch stretch = robots.stretch(cells, row);
    const std::size_t room = count + (stretch.to - stretch.from) + kPack;
    if (out.size() < room) out.resize(2 * room);
    for (std::size_t j = stretch.from; j < stretch.to; ++j)
      if (j != i && state_of(robots, kinds, i, j) != PairState::far) out[count++] = static_cast<std::int32_t>(j);
  }
  if (out.size() < count + kPack) out.resize(count + 2 * kPack);
  return count;
}

void find_near_pairs(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
                     const std::vector<AskedRobot>& asked, bool first_round, NearLists& lists, NearPairs& out) {
  out.end.resize(asked.size());
  out.state.resize(asked.size());
  HWY_DYNAMIC_DISPATCH(find)(robots, kinds, begin, asked, first_round, lists, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
