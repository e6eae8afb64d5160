// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the figures share: colours, and boxes that views are made of.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "exactvo/geometry/vec2.h"

namespace exactvo::tools {

using geometry::Vec2;

/// Colours that colour-blind readers can tell apart (Okabe and Ito, 2008; the yellow, too pale on white, left out).
inline const char* series_colour(std::size_t i) {
  static constexpr std::array<const char*, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                          "#E69F00", "#56B4E9", "#555555"};
  return kColours[i % kColours.size()];
}

/// With series_colour: 28 line styles before one comes again. Empty for a solid line.
inline const char* series_dash(std::size_t i) {
  static constexpr std::array<const char*, 4> kDashes = {"", " dt (12,4)", " dt (3,3)", " dt (12,3,3,3)"};
  return kDashes[i / 7 % kDashes.size()];
}

inline constexpr const char* kCollisionColour = "#e00000";
inline constexpr const char* kSeparatorColour = "#b2182b";  ///< what separates a goal out of reach
inline constexpr const char* kRouteColour = "#0072B2";
inline constexpr const char* kGoalColour = "#CC79A7";
inline constexpr const char* kObstacleFill = "#c9ccd2";
inline constexpr const char* kObstacleLine = "#3f444d";

/// An axis-parallel box; empty until something is put in.
struct Box {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x); }
  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  void add(const Box& other) {
    if (other.empty()) return;
    add(other.low);
    add(other.high);
  }
  double width() const { return empty() ? 0.0 : high.x - low.x; }
  double height() const { return empty() ? 0.0 : high.y - low.y; }
  double diagonal() const { return std::hypot(width(), height()); }
  Box grown(double by) const { return empty() ? *this : Box{{low.x - by, low.y - by}, {high.x + by, high.y + by}}; }
  bool contains(Vec2 p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
};

}  // namespace exactvo::tools
