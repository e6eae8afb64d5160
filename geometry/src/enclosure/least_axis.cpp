// SPDX-License-Identifier: GPL-3.0-or-later
#include "enclosure/least_axis.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/support.h"

namespace exactvo::geometry::detail {
namespace {

constexpr double kBeyond = 1.0 + 1e-14;  // a few roundings beyond a root
constexpr int kBisections = 40;          // leaves 2^-40 of the extent, far below any margin
constexpr double kFinest = 0x1p-40;

/// The centres x for which all points lie in the ellipse, and the points that bound them.
struct Centres {
  double low = -kInfinity, high = kInfinity;
  Touching at;
  bool is_empty() const { return !(low <= high); }
};

Centres centres_for(const TurnedPoints& f, const std::vector<double>& width, double major) {
  Centres range;
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    const double low = f.x[i] - major * width[i], high = f.x[i] + major * width[i];
    if (low > range.low) range.low = low, range.at.right = i;
    if (high < range.high) range.high = high, range.at.left = i;
  }
  return range;
}

/// Half of each point's chord at its height, for a major axis of 1. False where one lies beyond the minor axis.
bool widths(const TurnedPoints& f, double centre_y, double minor, std::vector<double>& width) {
  width.resize(f.y.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < f.y.size(); ++i) {
    const double t = (f.y[i] - centre_y) / minor;
    farthest = std::max(farthest, std::fabs(t));
    width[i] = std::sqrt(1.0 - t * t);
  }
  return farthest < 1.0;
}

}  // namespace

Turn turn_by(double angle) {
  return {std::cos(-angle), std::sin(-angle)};
}

void turn(const std::vector<Vec2>& points, double angle, const Turn& by, TurnedPoints& f) {
  f.angle = angle;
  f.x.resize(points.size());
  f.y.resize(points.size());
  double low = kInfinity, high = -kInfinity;
  f.leftmost = f.rightmost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p = by(points[i]);
    f.x[i] = p.x;
    f.y[i] = p.y;
    low = std::min(low, f.y[i]);
    high = std::max(high, f.y[i]);
    if (f.x[i] < f.x[f.leftmost]) f.leftmost = i;
    if (f.x[i] > f.x[f.rightmost]) f.rightmost = i;
  }
  f.middle = 0.5 * (low + high);
  f.half_height = 0.5 * (high - low);
  const double left = f.x[f.leftmost], right = f.x[f.rightmost], first = f.x.front();
  f.extent = std::max(std::fabs(left - first), std::fabs(right - first));
  // Up to the rounding of coordinates.
  const double rounding = 8.0 * kUnitRoundoff * (std::fabs(left) + std::fabs(right));
  f.half_width = 0.5 * (right - left) - rounding;
}

// Whether a major axis is long enough is so from some double on, rounding and all, since every operation of
// `centres_for` is monotone in it: what is known of one axis answers for others.

/// The pair alone, in the same arithmetic: where it leaves no centre, all points don't.
bool LeastMajor::pair_is_apart(double major) const {
  return f_.x[pair_.right] - major * width_[pair_.right] > f_.x[pair_.left] + major * width_[pair_.left];
}

double LeastMajor::least_of_pair() const {
  return kBeyond * ((f_.x[pair_.right] - f_.x[pair_.left]) / (width_[pair_.right] + width_[pair_.left]));
}

/// Remembers what bounds.
bool LeastMajor::has_centre(double major) {
  const Centres c = centres_for(f_, width_, major);
  pair_ = c.at;
  if (c.is_empty()) return false;
  about_ = {major, 0.5 * (c.low + c.high)};
  return true;
}

bool LeastMajor::is_long_enough(double major) {
  if (major >= long_enough_) return true;
  if (major <= too_short_) return false;
  const bool is = !pair_is_apart(major) && has_centre(major);
  (is ? long_enough_ : too_short_) = major;
  return is;
}

/// Draws what is known together round the least one: the gap between two points' centres is linear in the axis, so
/// Newton's method climbs to it from `at`, which is hardly longer, in a few steps. It climbs over axes that two points
/// forbid, so that the first one that is long enough is the least but for rounding: that of the points' own extent, and
/// of what the bisection stops at.
void LeastMajor::approach(double at) {
  constexpr int kSteps = 8;
  constexpr double kRounding = 1e-13;
  at = std::max({too_short_, at, 0.0, least_of_pair()});
  for (int i = 0; i < kSteps && at < long_enough_; ++i) {
    if (has_centre(at)) {
      long_enough_ = at;
      const double chords = width_[pair_.right] + width_[pair_.left];
      doubt_ = kRounding * (1.0 + f_.extent / (at * chords)) + kFinest * high_ / at;
      return;
    }
    too_short_ = std::max(too_short_, at);
    at = kBeyond * std::max(least_of_pair(), at);
  }
}

AxisAnswer LeastMajor::bracket(const AreaLimit& limit) {
  if (!widths(f_, centre_y_, minor_, width_)) return AxisAnswer::never;
  const double narrowest = std::min(1.0, *std::min_element(width_.begin(), width_.end()));
  high_ = f_.extent / narrowest;
  const double longest = limit.longest();
  if (longest < high_ && limit.is_too_long(longest) && !is_long_enough(longest)) return AxisAnswer::too_long;
  approach(f_.half_width);
  return AxisAnswer::fits;
}

MajorFit LeastMajor::exact() {
  double low = 0.0, high = high_;
  for (int i = 0; i < kBisections; ++i) {
    const double mid = 0.5 * (low + high);
    (is_long_enough(mid) ? high : low) = mid;
  }
  const Centres range = centres_for(f_, width_, high);
  pair_ = range.at;
  return {high, 0.5 * (range.low + range.high)};
}

}  // namespace exactvo::geometry::detail
