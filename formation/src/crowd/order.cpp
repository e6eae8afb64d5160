// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/order.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/order.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "crowd/layout.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using OrderWords = hn::CappedTag<std::int32_t, kPack>;
using OrderNumbers = hn::CappedTag<double, kPack>;

/// Reads whole registers: the last one again from its beginning where values are not a multiple.
Extent extent_in(const std::int32_t* values, std::size_t count) {
  const OrderWords d;
  const std::size_t lanes = hn::Lanes(d);
  auto low = hn::Set(d, values[0]), high = low;
  if (count < lanes) {
    for (std::size_t k = 1; k < count; ++k) {
      low = hn::Min(low, hn::Set(d, values[k]));
      high = hn::Max(high, hn::Set(d, values[k]));
    }
    return {hn::GetLane(low), hn::GetLane(high)};
  }
  for (std::size_t k = 0; k < count; k += lanes) {
    const auto some = hn::LoadU(d, values + std::min(k, count - lanes));
    low = hn::Min(low, some);
    high = hn::Max(high, some);
  }
  return {hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
}

/// Every number is whole and below 2^53: nothing is rounded but x * per_column and y * per_row. Writes whole registers.
void cells_of(const CellRule& rule, const std::int32_t* x, const std::int32_t* y, std::size_t count,
              std::int32_t* cells) {
  const OrderNumbers d;
  const hn::Rebind<std::int32_t, OrderNumbers> words;
  const auto per_column = hn::Set(d, rule.per_column), per_row = hn::Set(d, rule.per_row);
  const auto first_column = hn::Set(d, rule.first_column), first_row = hn::Set(d, rule.first_row);
  const auto columns = hn::Set(d, rule.columns);
  const auto some = [&](std::size_t k) {
    const auto at_x = hn::Floor(hn::Mul(hn::PromoteTo(d, hn::LoadU(words, x + k)), per_column));
    const auto at_y = hn::Floor(hn::Mul(hn::PromoteTo(d, hn::LoadU(words, y + k)), per_row));
    const auto before = hn::Mul(hn::Sub(at_y, first_row), columns);
    return hn::DemoteTo(words, hn::Add(before, hn::Sub(at_x, first_column)));
  };
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d)) hn::StoreU(some(k), words, cells + k);
  if (k == count) return;
  alignas(64) std::int32_t last[kPack];
  hn::Store(some(k), words, last);
  std::copy(last, last + (count - k), cells + k);
}

/// Reads no value beyond the last: another thread may write there.
std::uint64_t not_above(const std::int32_t* values, std::size_t count) {
  const OrderWords d;
  std::uint64_t found = 0;
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d)) {
    std::uint8_t bytes[8] = {};
    const auto above = hn::Gt(hn::LoadU(d, values + k), hn::LoadU(d, values + k - 1));
    hn::StoreMaskBits(d, hn::Not(above), bytes);
    found |= (static_cast<std::uint64_t>(bytes[0]) | static_cast<std::uint64_t>(bytes[1]) << 8U) << k;
  }
  for (; k < count; ++k) found |= std::uint64_t{values[k] <= values[k - 1]} << k;
  return found;
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(extent_in);
HWY_EXPORT(cells_of);
HWY_EXPORT(not_above);

Extent extent_of(const std::int32_t* values, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(extent_in)(values, count);
}

void number_cells(const CellRule& rule, const std::int32_t* x, const std::int32_t* y, std::size_t count,
                  std::int32_t* cells) {
  HWY_DYNAMIC_DISPATCH(cells_of)(rule, x, y, count, cells);
}

std::uint64_t not_above_the_last(const std::int32_t* values, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(not_above)(values, count);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
