// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two discs in a straight strip between two walls (docs/guide/liveness.md, lemma 6): where the strip is too narrow for
/// them side by side, their order along it never changes.
///
///     A ---------------------------    along the wall A; at any time both discs are between A and B, so that their
///        (1)     -->      (2)          middles are less than the width minus both radii apart across it. Level with
///     B ---------------------------    each other they would overlap if that is less than the sum of the radii.
///
/// Certified: nothing is found where rounding leaves it open.

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/edges_by_place.h"

namespace exactvo::formation::detail {

/// A robot in a strip.
struct DiscWithGoal {
  Vec2 start;          ///< m
  Vec2 goal;           ///< m
  double reach = 0.0;  ///< m, of places that count as the goal
};

/// The width, m, rounded up, of a strip narrower than `side_by_side` m in which the order of the discs cannot change
/// and would have to. Level with each other they take 2 (r1 + r2); more is asked for where they have to keep something
/// from the walls and each other. `squares`: lower left corners of squares of that side, m, that cover every place that
/// the middle of either disc can get to. Of each square some point is a radius from every wall. Only walls near the
/// first disc are looked at: others are not those of a strip so narrow. `looks`: at walls and squares, how many are
/// allowed and then how many are left; nothing is found once there are none. REQUIRES: the side is at most half of the
/// smaller radius.
std::optional<double> strip_that_keeps_order(const DiscWithGoal& first, const DiscWithGoal& second, double side_by_side,
                                             const std::vector<Vec2>& squares, double side, const EdgesByPlace& walls,
                                             std::size_t& looks);

}  // namespace exactvo::formation::detail
