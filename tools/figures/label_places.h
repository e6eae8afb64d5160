// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where a short label (a time of about six characters) can be written beside a disc: clear of lines and of other
/// labels. For drawing only.

#include <optional>

#include "figures/outlines.h"

namespace exactvo::tools {

class LabelPlaces {
 public:
  /// `scale`: px a metre.
  LabelPlaces(const Box& view, double scale) : view_(view), scale_(scale) {}

  /// No label may lie on this curve.
  void keep_off(const Points& curve, bool closed);

  /// The middle of a label for the disc at `p`, m, which is taken from then on. Nothing where there is no room near by;
  /// where one must be written, the place with the most room.
  std::optional<Vec2> place_beside(Vec2 p, double radius, bool must);

  /// The same beside or inside an object `2 * half_width` wide, centred at `p`.
  std::optional<Vec2> place_at_side(Vec2 p, double half_width, bool must);

 private:
  double room_round(Vec2 p) const;
  std::optional<Vec2> best_of(const Points& places, bool must);

  Box view_;
  double scale_;
  Points lines_;   ///< m: points of the curves, a few pixels apart
  Points labels_;  ///< m: middles of the labels
};

}  // namespace exactvo::tools
