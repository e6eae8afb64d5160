// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Pairs of robots that are near each other, without looking at every pair of a large crowd.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "exactvo/geometry/box_grid.h"

namespace exactvo::formation::detail {

/// Two robots can hold each other up if their gap is less than this many times `margins.robot`: with a wide margin a
/// robot stops at that distance.
inline constexpr double kNearMargins = 1.5;

/// Up to this many places all pairs are looked at: a grid costs more.
inline constexpr std::size_t kFewPlaces = 48;

/// Calls visit(i, j), i < j, for all pairs of places at most `reach` (m) apart and for some that are farther, in the
/// order of i, then of j. Quadratic where there are few places, one of them is not finite, or the reach is not.
template <class Visit>
void for_each_near_pair(const std::vector<geometry::Vec2>& places, double reach, const Visit& visit) {
  constexpr double kRounding = 1.0 + 0x1p-40;  // of the distance that the caller compares with
  const std::size_t n = places.size();
  if (n <= kFewPlaces || !std::isfinite(reach) ||
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

/// The same for places that move from call to call: pairs are looked up farther than asked, and again only when that
/// room is used up.
class NearPairsOfMoving {
 public:
  /// `room`: m, how much farther pairs are looked up.
  template <class Visit>
  void for_each(const std::vector<geometry::Vec2>& places, double reach, double room, const Visit& visit) {
    if (places.size() <= kFewPlaces || !std::isfinite(reach + room)) return for_each_near_pair(places, reach, visit);
    const bool are_too_many = reach_ > 2.0 * (reach + room);  // after a step that asked farther
    if (are_too_many || !suffice(places, reach)) look_up(places, reach + room);
    for (const auto& [i, j] : pairs_) visit(i, j);
  }

 private:
  bool suffice(const std::vector<geometry::Vec2>& places, double reach) const {
    constexpr double kRounding = 1.0 - 0x1p-30;
    const double most = 0.5 * (kRounding * reach_ - reach);
    if (places.size() != places_.size() || !(most >= 0.0)) return false;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (!(squared_norm(places[i] - places_[i]) <= kRounding * most * most)) return false;
    return true;
  }

  void look_up(const std::vector<geometry::Vec2>& places, double reach) {
    places_ = places;
    reach_ = reach;
    pairs_.clear();
    for_each_near_pair(places, reach, [this](std::size_t i, std::size_t j) {
      pairs_.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    });
  }

  std::vector<geometry::Vec2> places_;  ///< m, when the pairs were looked up
  double reach_ = -1.0;                 ///< m, of the pairs
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace exactvo::formation::detail
