// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/near_pairs.h"

#include <algorithm>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/near_pairs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef EXACTVO_NEAR_PAIRS_ONCE
#define EXACTVO_NEAR_PAIRS_ONCE
namespace exactvo::formation::crowd {

/// Lattice steps by which a motion may be longer than the wish: what rounding to the lattice adds, and some.
inline constexpr std::int64_t kRoundingRoom = 4;

/// What a pair is, exactly.
enum class PairState { far, near, overlapping };

PairState state_of(const Robots& robots, const StepTable& table, std::size_t i, std::size_t j);

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

/// One robot, against as many others at a time as there are lanes.
class OneAgainstMany {
 public:
  /// Of some others, a bit each.
  struct Found {
    std::uint32_t near, open, clear;  ///< surely; perhaps; wishes surely allowed
  };

  HWY_INLINE OneAgainstMany(const Robots& robots, const float* radius, std::size_t robot, float own_radius)
      : robots_(robots), radius_(radius) {
    const Floats d;
    const Words words;
    const std::int32_t wish_x = robots.wish_mx[robot], wish_y = robots.wish_my[robot];
    x_ = hn::Set(words, robots.x[robot]);
    y_ = hn::Set(words, robots.y[robot]);
    wish_x_ = hn::Set(d, static_cast<float>(wish_x));
    wish_y_ = hn::Set(d, static_cast<float>(wish_y));
    way_ = hn::Set(d, static_cast<float>(longest_way(wish_x, wish_y)));
    own_radius_ = hn::Set(d, own_radius);
  }

  /// Those from `first` on, which are of the one kind if kMixed is false.
  template <bool kMixed>
  HWY_INLINE Found look(std::size_t first, std::size_t count) const {
    const Floats d;
    const Words words;
    const F zero = hn::Zero(d);
    F radius;
    if constexpr (kMixed) {
      const auto tag = hn::PromoteTo(words, hn::LoadU(hn::Rebind<std::uint16_t, Words>(), &robots_.tag[first]));
      radius = hn::GatherIndex(d, radius_, hn::And(tag, hn::Set(words, kKindBits)));
    } else {
      radius = hn::Set(d, radius_[0]);
    }
    const W wish_x = hn::LoadU(words, &robots_.wish_mx[first]), wish_y = hn::LoadU(words, &robots_.wish_my[first]);
    const W across = hn::Abs(wish_x), along = hn::Abs(wish_y);
    const W bound = hn::Add(hn::Max(across, along), hn::ShiftRight<1>(hn::Min(across, along)));
    const F way = hn::ConvertTo(d, hn::Add(bound, hn::Set(words, 1 + static_cast<std::int32_t>(kRoundingRoom))));
    const F dx = hn::ConvertTo(d, hn::Sub(x_, hn::LoadU(words, &robots_.x[first])));
    const F dy = hn::ConvertTo(d, hn::Sub(y_, hn::LoadU(words, &robots_.y[first])));
    const F squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const F contact = hn::Add(own_radius_, radius), ways = hn::Add(way_, way), reach = hn::Add(contact, ways);
    const F limit = hn::Mul(reach, reach);
    const auto there = hn::FirstN(d, count);
    const auto perhaps = hn::And(there, hn::Lt(squared, hn::Mul(limit, hn::Set(d, kWider))));
    Found found{0, bits_of_mask(perhaps), 0};
    if (found.open == 0) return found;
    const F apart = hn::Max(hn::Set(d, 1.0F), hn::Sub(contact, hn::Set(d, static_cast<float>(kRoundedContact))));
    const auto surely = hn::And(hn::Lt(squared, hn::Mul(limit, hn::Set(d, kNarrower))),
                                hn::Gt(squared, hn::Mul(hn::Mul(apart, apart), hn::Set(d, kWider))));
    found.near = bits_of_mask(hn::And(perhaps, surely));
    found.open &= ~found.near;
    const F own = hn::Add(hn::Mul(dx, wish_x_), hn::Mul(dy, wish_y_));
    const F its = hn::Add(hn::Mul(dx, hn::ConvertTo(d, wish_x)), hn::Mul(dy, hn::ConvertTo(d, wish_y)));
    const F needs = hn::Add(hn::Max(zero, hn::Neg(own)), hn::Max(zero, its));
    const F distance = hn::Sqrt(squared);
    const F room = hn::Sub(hn::Sub(squared, hn::Mul(contact, distance)), needs);
    const F sum = hn::Add(distance, reach);
    const F left = hn::Mul(distance, hn::Add(hn::Mul(sum, hn::Set(d, kShareLeft)), hn::Set(d, kLeft)));
    found.clear = bits_of_mask(hn::Ge(room, left));
    return found;
  }

 private:
  const Robots& robots_;
  const float* radius_;
  W x_, y_;
  F wish_x_, wish_y_, way_, own_radius_;
};

template <bool kMixed>
void find_in(const Robots& robots, const StepTable& table, const std::vector<std::int32_t>& asked, bool from_rest,
             NearPairs& out) {
  const std::size_t lanes = hn::Lanes(Words());
  std::size_t count = 0;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const auto i = static_cast<std::size_t>(asked[k]);
    const std::size_t kind = kMixed ? robots.kind(i) : 0, first = count;
    const OneAgainstMany one(robots, table.radius.data(), i, table.radius[kind]);
    const Window at{robots.x[i], robots.x[i], robots.y[i], robots.y[i]};
    const Cells cells = robots.cells_of(grown(at, table.kinds[kind].reach));
    std::uint32_t hinders = 0, overlaps = 0;
    for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
      const Stretch stretch = robots.stretch(cells, row);
      const std::size_t room = count + (stretch.to - stretch.from);
      if (out.other.size() < room) out.other.resize(2 * room);
      for (std::size_t j = stretch.from; j < stretch.to; j += lanes) {
        auto found = one.look<kMixed>(j, std::min(lanes, stretch.to - j));
        if (i - j < lanes) found.open &= ~(1U << (i - j));
        for (; found.open != 0; found.open &= found.open - 1) {
          const auto lane = static_cast<std::size_t>(__builtin_ctz(found.open));
          const PairState state = state_of(robots, table, i, j + lane);
          found.near |= std::uint32_t{state == PairState::near} << lane;
          overlaps |= std::uint32_t{state == PairState::overlapping};
        }
        hinders |= found.near & ~found.clear;
        for (; found.near != 0; found.near &= found.near - 1)
          out.other[count++] = static_cast<std::int32_t>(j) + __builtin_ctz(found.near);
      }
    }
    const bool meets = count > first, is_hindered = from_rest ? hinders != 0 : meets;
    if (!is_hindered) count = first;
    out.end[k] = count;
    out.state[k] =
        static_cast<std::uint8_t>((meets ? NearPairs::kMeets : 0U) | (is_hindered ? NearPairs::kHindered : 0U) |
                                  (overlaps != 0 ? NearPairs::kOverlaps : 0U));
  }
}

void find(const Robots& robots, const StepTable& table, const std::vector<std::int32_t>& asked, bool from_rest,
          NearPairs& out) {
  table.kinds.size() > 1 ? find_in<true>(robots, table, asked, from_rest, out)
                         : find_in<false>(robots, table, asked, from_rest, out);
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

PairState state_of(const Robots& robots, const StepTable& table, std::size_t i, std::size_t j) {
  const std::int64_t dx = std::int64_t{robots.x[i]} - robots.x[j], dy = std::int64_t{robots.y[i]} - robots.y[j];
  const auto& kinds = table.kinds;
  const std::int64_t contact = kinds[robots.kind(i)].radius + kinds[robots.kind(j)].radius;
  const std::int64_t reach =
      contact + longest_way(robots.wish_mx[i], robots.wish_my[i]) + longest_way(robots.wish_mx[j], robots.wish_my[j]);
  const std::int64_t squared = dx * dx + dy * dy, apart = std::max<std::int64_t>(1, contact - kRoundedContact);
  if (squared >= reach * reach) return PairState::far;
  return squared >= apart * apart ? PairState::near : PairState::overlapping;
}

void find_near_pairs(const Robots& robots, const StepTable& table, const std::vector<std::int32_t>& asked,
                     bool from_rest, NearPairs& out) {
  out.end.resize(asked.size());
  out.state.resize(asked.size());
  HWY_DYNAMIC_DISPATCH(find)(robots, table, asked, from_rest, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
