// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where a short label (a time of about six characters) can be written beside a disc: clear of lines and of other
/// labels. For drawing only.

#include <cmath>
#include <optional>
#include <vector>

#include "figures/outlines.h"

namespace exactvo::tools {

class LabelPlaces {
 public:
  /// `scale`: px a metre.
  LabelPlaces(const Box& view, double scale);

  /// No label may lie on this curve.
  void keep_off(const Points& curve, bool closed);

  /// The middle of a label for the disc at `p`, m, which is taken from then on. Nothing where there is no room near by;
  /// where one must be written, the place with the most room.
  std::optional<Vec2> place_beside(Vec2 p, double radius, bool must);

  /// The same beside or inside an object centred at `p`; `half`: m, half of its width and of its height.
  std::optional<Vec2> place_at_side(Vec2 p, Vec2 half, bool must);

 private:
  void add_point(Vec2 p);
  double room_round(Vec2 p, double floor) const;
  std::optional<Vec2> best_of(const Points& places, bool must);
  /// The column or row of a coordinate, px from the view's corner; also of those outside.
  static long cell_of(double px, double size) { return static_cast<long>(std::floor(px / size)); }

  Box view_;
  double scale_;
  long columns_, rows_;
  std::vector<Points> lines_;  ///< m: points of the curves, a few pixels apart, by cells of the view, row by row
  Points labels_;              ///< m: middles of the labels
};

}  // namespace exactvo::tools
