// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/few_rows.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/few_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = hn::CappedTag<double, FewRows::kLanes>;
using N = hn::Vec<Numbers>;
using M = hn::Mask<Numbers>;

/// Where normals are nearer to parallel than this, the square of the sine, the linear program decides.
constexpr double kParallel = 0x1p-10;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

HWY_INLINE N number(double value) {
  return hn::Set(Numbers(), value);
}

/// Lattice steps.
struct Way {
  N x, y;
};

HWY_INLINE N dot(Way a, Way b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y));
}

HWY_INLINE Way choose(M first, Way a, Way b) {
  return {hn::IfThenElse(first, a.x, b.x), hn::IfThenElse(first, a.y, b.y)};
}

/// A row of each robot.
struct Row {
  Way normal;
  N inward;  ///< FewRows::least, moved inward by kHalfDiagonal
  N number, misses;
};

/// As many robots as there are lanes, from `lane` on.
class RobotLanes {
 public:
  RobotLanes(const FewRows& rows, std::size_t lane, std::size_t count)
      : rows_(rows), lane_(lane), count_(count), wish_{load(rows.wish_x), load(rows.wish_y)} {}

  HWY_INLINE void find(Few* found, Motion* m) {
    const N zero = number(0.0);
    Row first;
    const M has_wish = take_wish(first);
    const N share = hn::Div(first.misses, dot(first.normal, first.normal));
    Way way{hn::Add(wish_.x, hn::Mul(share, first.normal.x)), hn::Add(wish_.y, hn::Mul(share, first.normal.y))};
    const Row second = most_missing(way);
    const M meets = hn::And(hn::Ne(second.number, first.number), hn::Gt(second.misses, zero));
    M is_found = hn::Eq(zero, zero);
    if (!hn::AllFalse(Numbers(), meets)) {
      Way met;
      const M both_pull = meet(first, second, met);
      const Row third = most_missing(met);
      const M of_two = hn::Or(hn::Or(hn::Eq(third.number, first.number), hn::Eq(third.number, second.number)),
                              hn::Le(third.misses, zero));
      is_found = hn::Or(hn::Not(meets), hn::And(both_pull, of_two));
      way = choose(meets, met, way);
    }
    is_found = hn::And(is_found, hn::Le(dot(way, way), load(rows_.squared_disc)));
    const N whole_only = number(0x1.8p52);
    Way rounded{hn::Sub(hn::Add(way.x, whole_only), whole_only), hn::Sub(hn::Add(way.y, whole_only), whole_only)};
    rounded = choose(has_wish, wish_, rounded);
    const M is_allowed = hn::And(hn::Le(dot(rounded, rounded), load(rows_.squared_way)), allow(rounded));
    put(has_wish, hn::Or(has_wish, is_allowed), is_found, rounded, found, m);
  }

 private:
  HWY_INLINE N load(const double* of) const { return hn::Load(Numbers(), of + lane_); }
  HWY_INLINE Way normal(std::size_t k) const { return {load(rows_.x[k]), load(rows_.y[k])}; }

  static HWY_INLINE Row none() {
    return {{number(1.0), number(0.0)}, number(-kInfinity), number(-1.0), number(-kInfinity)};
  }

  /// The one that misses more; of those that miss as much, the one whose normal comes first: the order of rows depends
  /// on how robots are divided among threads.
  static HWY_INLINE void take(const Row& row, Row& most) {
    const M comes_first = hn::Or(hn::Lt(row.normal.x, most.normal.x),
                                 hn::And(hn::Eq(row.normal.x, most.normal.x), hn::Lt(row.normal.y, most.normal.y)));
    const M more = hn::Or(hn::Gt(row.misses, most.misses), hn::And(hn::Eq(row.misses, most.misses), comes_first));
    most.normal = choose(more, row.normal, most.normal);
    most.inward = hn::IfThenElse(more, row.inward, most.inward);
    most.number = hn::IfThenElse(more, row.number, most.number);
    most.misses = hn::IfThenElse(more, row.misses, most.misses);
  }

  /// Whether the wish is allowed, and the row that, moved inward, misses most of it.
  HWY_INLINE M take_wish(Row& first) {
    M all = hn::Eq(number(0.0), number(0.0));
    first = none();
    for (std::size_t k = 0; k < count_; ++k) {
      const Way n = normal(k);
      const N least = load(rows_.least[k]), at = dot(n, wish_);
      const N inward = hn::Add(least, hn::Mul(number(kHalfDiagonal), hn::Sqrt(dot(n, n))));
      all = hn::And(all, hn::Ge(at, least));
      hn::Store(inward, Numbers(), inward_[k]);
      take({n, inward, number(static_cast<double>(k)), hn::Sub(inward, at)}, first);
    }
    return all;
  }

  HWY_INLINE Row most_missing(Way m) const {
    Row most = none();
    for (std::size_t k = 0; k < count_; ++k) {
      const Way n = normal(k);
      const N inward = hn::Load(Numbers(), inward_[k]);
      take({n, inward, number(static_cast<double>(k)), hn::Sub(inward, dot(n, m))}, most);
    }
    return most;
  }

  /// On both boundaries, and whether both pull the wish there.
  HWY_INLINE M meet(const Row& a, const Row& b, Way& found) const {
    const N aa = dot(a.normal, a.normal), bb = dot(b.normal, b.normal), ab = dot(a.normal, b.normal);
    const N cross = hn::Sub(hn::Mul(a.normal.x, b.normal.y), hn::Mul(a.normal.y, b.normal.x));
    const N squared = hn::Mul(cross, cross), zero = number(0.0);
    const N of_b = hn::Sub(b.inward, dot(b.normal, wish_));
    const N pull_a = hn::Div(hn::Sub(hn::Mul(a.misses, bb), hn::Mul(of_b, ab)), squared);
    const N pull_b = hn::Div(hn::Sub(hn::Mul(of_b, aa), hn::Mul(a.misses, ab)), squared);
    found.x = hn::Add(wish_.x, hn::Add(hn::Mul(pull_a, a.normal.x), hn::Mul(pull_b, b.normal.x)));
    found.y = hn::Add(wish_.y, hn::Add(hn::Mul(pull_a, a.normal.y), hn::Mul(pull_b, b.normal.y)));
    const M turns = hn::Ge(squared, hn::Mul(hn::Mul(number(kParallel), aa), bb));
    return hn::And(turns, hn::And(hn::Ge(pull_a, zero), hn::Ge(pull_b, zero)));
  }

  HWY_INLINE M allow(Way m) const {
    M all = hn::Eq(number(0.0), number(0.0));
    for (std::size_t k = 0; k < count_; ++k) all = hn::And(all, hn::Ge(dot(normal(k), m), load(rows_.least[k])));
    return all;
  }

  HWY_INLINE void put(M has_wish, M is_allowed, M is_found, Way way, Few* found, Motion* m) const {
    const Numbers d;
    HWY_ALIGN double x[FewRows::kLanes], y[FewRows::kLanes];
    hn::Store(way.x, d, x);
    hn::Store(way.y, d, y);
    const auto bits = [&](M mask) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, mask, bytes);
      return bytes[0];
    };
    const unsigned allowed = bits(is_allowed), known = bits(hn::Or(has_wish, is_found));
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
      const bool is_known = (known >> k & 1U) != 0;
      found[lane_ + k] = !is_known ? Few::not_found : (allowed >> k & 1U) != 0 ? Few::allowed : Few::not_allowed;
      if (is_known) m[lane_ + k] = {static_cast<std::int32_t>(x[k]), static_cast<std::int32_t>(y[k])};
    }
  }

  const FewRows& rows_;
  std::size_t lane_, count_;
  Way wish_;
  alignas(64) double inward_[FewRows::kMost][FewRows::kLanes];  ///< Row::inward
};

void search_rows(FewRows& rows, Few* found, Motion* m) {
  const std::size_t lanes = hn::Lanes(Numbers());
  for (std::size_t lane = 0; lane < rows.robots; lane += lanes) {
    for (std::size_t k = std::max(rows.robots, lane); k < lane + lanes; ++k)  // no robot
      rows.wish_x[k] = rows.wish_y[k] = rows.squared_disc[k] = rows.squared_way[k] = 0.0;
    const std::size_t most = *std::max_element(rows.count + lane, rows.count + lane + lanes);
    for (std::size_t k = lane; k < lane + lanes; ++k)
      for (std::size_t row = rows.count[k]; row < most; ++row) {  // always holds
        rows.x[row][k] = 1.0, rows.y[row][k] = 0.0;
        rows.least[row][k] = -kInfinity;
      }
    RobotLanes(rows, lane, most).find(found, m);
    std::fill(rows.count + lane, rows.count + lane + lanes, 0);
  }
  rows.robots = 0;
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(search_rows);

void nearest_of_few(FewRows& rows, Few* found, Motion* m) {
  HWY_DYNAMIC_DISPATCH(search_rows)(rows, found, m);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
