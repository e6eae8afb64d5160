// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where an optimum lies, from nothing but the lines that bind there. Heuristic: what it gives is proven elsewhere.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exactvo/geometry/infinity.h"
#include "exactvo/vo/lp/problem.h"
#include "lp/lanes/layout.h"
#include "lp/problem/region.h"

namespace exactvo::lp {

/// A line that binds, as the kernel reads it.
struct BindingLine {
  Vec2 normal;
  double offset;
  std::size_t number;  ///< in the order of the kernel's lines
  bool is_exact;       ///< a side of the box, which answers are cut off at
};

/// The optimum as what binds gives it, one or two lines and the disc, with the same bits whichever way a search found
/// them. `Slide` of lanes/single.cpp computes it likewise where it has followed the right line anyway.
class Vertex {
 public:
  Vertex(Objective objective, Vec2 preferred, double disc, double largest, double slack_units)
      : objective_(objective),
        preferred_(preferred),
        disc_(disc * (1.0 - slack_units * kDiscUnits * kUnitRoundoff)),
        slack_(slack_units * kSlackUnits * kUnitRoundoff * largest),
        noise_(slack_units * kNoiseUnits * kUnitRoundoff * largest) {}

  /// The optimum of the disc alone.
  Vec2 on_disc() const { return disc_ * normalized(preferred_); }

  /// Whether `a` is followed and not `b`: the line that is violated more at `preferred`.
  bool follows(const BindingLine& a, const BindingLine& b) const {
    const auto by = [&](const BindingLine& line) {
      return without_last_digits((line.offset - dot(line.normal, preferred_)) - (noise_ - slack_));
    };
    const double by_a = by(a), by_b = by(b);
    return by_a != by_b ? by_a > by_b : a.number > b.number;
  }

  /// False where it does not meet the disc; of two, where what binds does not meet.
  bool of_one(const BindingLine& line, Vec2& v) const {
    return best_between(line, -geometry::kInfinity, geometry::kInfinity, v);
  }

  bool of_two(const BindingLine& line, const BindingLine& other, Vec2& v) const {
    const double inward = other.is_exact ? 0.0 : slack_ - 0.5 * noise_, offset = other.offset + inward;
    const double slope = cross(line.normal, other.normal) + kParallel<double>;
    const double along = dot(line.normal, other.normal);
    const double cut = (offset * squared_norm(line.normal) - along * moved(line)) / slope;
    return slope < 0.0 ? best_between(line, -geometry::kInfinity, cut, v)
                       : best_between(line, cut, geometry::kInfinity, v);
  }

 private:
  double moved(const BindingLine& line) const { return line.is_exact ? line.offset : line.offset + slack_; }

  /// On the line, in units of its normal turned, over the square of its length.
  bool best_between(const BindingLine& line, double low, double high, Vec2& v) const {
    const Vec2 n = line.normal;
    const double offset = moved(line), squared = squared_norm(n), inverse = 1.0 / squared;
    if (std::isfinite(disc_)) {
      const double reach = std::sqrt(disc_ * disc_ * squared - offset * offset);
      if (!(reach >= 0.0)) return false;
      low = std::max(low, -reach);
      high = std::min(high, reach);
    }
    if (!(low <= high)) return false;
    const double where = std::min(std::max(wish_on(n), low), high);
    v = {(n.x * offset - where * n.y) * inverse, (n.y * offset + where * n.x) * inverse};
    return true;
  }

  /// At the foot of `preferred`, or at one of the ends.
  double wish_on(Vec2 normal) const {
    const double along = cross(normal, preferred_);
    if (objective_ == Objective::nearest) return along;
    return along == 0.0 ? 0.0 : std::copysign(geometry::kInfinity, along);
  }

  Objective objective_;
  Vec2 preferred_;
  double disc_, slack_, noise_;
};

}  // namespace exactvo::lp
