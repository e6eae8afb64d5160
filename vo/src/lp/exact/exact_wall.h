// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is left of a line inside others, and the point of it where soft lines are violated least. Exact.

#include <vector>

#include "lp/exact/exact_abscissa.h"
#include "lp/exact/exact_search.h"

namespace exactvo::lp {

inline constexpr std::size_t kNoOwner = static_cast<std::size_t>(-1);
inline constexpr std::size_t kDiscOwner = static_cast<std::size_t>(-2);

/// A line of the working set, and where it stands in the region.
struct Held {
  ExactLine line;
  std::size_t position = kNoOwner;
};

/// The part of a carrier that is left, and which line or disc cut it off.
struct Stretch {
  Abscissa low = end(-1), high = end(1);
  std::size_t low_owner = kNoOwner, high_owner = kNoOwner;
  bool empty = false;  ///< then the owners are what contradicts the carrier
};

Stretch inside_disc(const Carrier& carrier);
void clip(Stretch& stretch, const Carrier& carrier, const ExactLine& other, std::size_t owner);

/// Where the aim would like to be on the carrier: an end, or a foot.
Abscissa wish(const Carrier& carrier, const Aim& aim);
Abscissa clamped(const Carrier& carrier, const Stretch& stretch, const Abscissa& s);
bool at_disc(const Carrier& carrier, const Abscissa& s);

/// The soft line `other` as a half-plane on the plane of `top`: where other is violated no more than top.
ExactLine below(const ExactLine& top, const ExactLine& other);

/// Least height of soft lines along a carrier within hard ones: an end, a crossing of two heights, or where the heights
/// are flat the aim's wish.
class WallSearch {
 public:
  WallSearch(Carrier carrier, Aim aim);
  void add_soft(const ExactLine& line, std::size_t position);
  void add_hard(const ExactLine& line, std::size_t position);
  bool run();  ///< false where the hard lines leave nothing
  ExactPoint point() const { return point_at(carrier_, best_); }
  std::size_t top() const { return soft_[highest_].position; }
  bool on_disc() const { return at_disc(carrier_, best_); }

 private:
  void consider(const Abscissa& s);
  void consider_crossings();
  std::size_t highest_at(const Abscissa& s) const;
  bool nearer_wish(const Abscissa& s) const;

  Carrier carrier_;
  Aim aim_;
  Abscissa wish_;
  Stretch stretch_;
  std::vector<Held> soft_;
  Abscissa best_;
  bool found_ = false;
  std::size_t highest_ = 0;
};

}  // namespace exactvo::lp
