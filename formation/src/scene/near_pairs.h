// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Pairs of robots that are near each other, without looking at every pair of a large crowd.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "exactvo/geometry/box_grid.h"

namespace exactvo::formation::detail {

/// Two robots can hold each other up if their gap is less than this many times `margins.robot`: with a wide margin a
/// robot stops at that distance.
inline constexpr double kNearMargins = 1.5;

/// Calls visit(i, j), i < j, for all pairs of places at most `reach` (m) apart and for some that are farther, in the
/// order of i, then of j. Quadratic where there are few places, one of them is not finite, or the reach is not.
template <class Visit>
void for_each_near_pair(const std::vector<geometry::Vec2>& places, double reach, const Visit& visit) {
  constexpr std::size_t kFew = 48;             // a grid costs more than their pairs
  constexpr double kRounding = 1.0 + 0x1p-40;  // of the distance that the caller compares with
  const std::size_t n = places.size();
  if (n <= kFew || !std::isfinite(reach) ||
      !std::all_of(places.begin(), places.end(), [](geometry::Vec2 p) { return is_finite(p); })) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) visit(i, j);
    return;
  }
  std::vector<geometry::Box> boxes;
  boxes.reserve(n);
  for (const geometry::Vec2 p : places) boxes.push_back({p, p});
  const geometry::BoxGrid by_place(std::move(boxes));
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < n; ++i) {
    near.clear();
    by_place.for_each_within(places[i], kRounding * reach, [&](std::size_t j) {
      if (j > i) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    for (const std::size_t j : near) visit(i, j);
  }
}

}  // namespace exactvo::formation::detail
