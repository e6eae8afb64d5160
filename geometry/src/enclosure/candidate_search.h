// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Candidates of the smallest ellipse at which a robot cannot come to rest (trap_free_fit.cpp): of a given orientation,
/// offset and semi-minor axis. `CandidateSearch` keeps the best. Most candidates are ruled out in doubles, with
/// allowances far above any rounding; what is kept was decided by the exact predicates.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

#include "enclosure/least_axis.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry::detail {

struct FitGoal {
  double robot_radius;
  Vec2 start, goal;
  double margin;
  std::optional<double> slack;  ///< none: the evolute condition is dropped
  double clear;
  double most_area = 0.0;       ///< m^2 / pi: a larger ellipse shuts more ways than it opens
  bool is_last_margin = false;  ///< no other margin will be tried
};

/// A candidate in a frame turned by `angle`: the centre lies `offset` across the middle of the points, `minor` is b -
/// margin.
struct Candidate {
  double angle = 0.0;
  double offset = 0.0;  ///< m
  double minor = 0.0;   ///< m
};

struct Scored {
  Candidate candidate;
  Ellipse ellipse;
  double area = std::numeric_limits<double>::infinity();
};

inline bool admissible(const Ellipse& e, const FitGoal& want) {
  const GrownShape kept_clear{e, {}, want.robot_radius + want.clear};
  if (locate(kept_clear, want.goal) != Place::outside || locate(kept_clear, want.start) != Place::outside) return false;
  return !want.slack || goal_outside_evolute(e, want.goal, *want.slack);
}

inline constexpr double kMinorShares[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8};
inline constexpr double kOffsetShares[] = {0.0, -0.25, 0.25, -0.5, 0.5, -0.9, 0.9};
inline constexpr std::size_t kMinors = std::size(kMinorShares), kOffsets = std::size(kOffsetShares);

/// What is known of a candidate whatever its margin and slack, where a fit keeps it.
struct Known {
  enum class State : unsigned char {
    nothing,
    estimated,  ///< `major` is known to kEstimate
    fitted,     ///< `major` is known
    hopeless    ///< no ellipse, or one that the start or the goal lies in
  };
  State& state;
  MajorFit& major;

  void set(State now, const MajorFit& then) const {
    state = now;
    major = then;
  }
};

/// Start and goal, drawn towards the points by a little less than they must stay clear: an ellipse that holds such a
/// place does not leave the end itself outside. NaN where nothing follows from it.
struct Ends {
  Vec2 start, goal;
  Vec2 whole_goal;  ///< where it is
};

/// The points in one orientation, and what it was last like there.
struct Orientation {
  TurnedPoints frame;
  Ends ends;                ///< in the frame
  Touching pair[kOffsets];  ///< what touched last at each offset

  void turn_to(double angle, const Turn& by, const std::vector<Vec2>& points, const Ends& from) {
    turn(points, angle, by, frame);
    ends = {by(from.start), by(from.goal), by(from.whole_goal)};
    for (Touching& p : pair) p = {frame.rightmost, frame.leftmost};
  }
};

/// Whether every ellipse of a candidate holds a place, or is too long: two of the points say so from both sides. One on
/// the right at x, whose half chord is a w, has the centre no farther left than x - a w; the place is within its own
/// half chord (a + margin) w' of that for all axes a from `shortest` to `longest` if it is for these two.
class Holds {
 public:
  Holds(const Orientation& o, const Candidate& c, double margin, const Touching& pair, const PairView& view,
        double longest)
      : f_(o.frame),
        pair_(pair),
        view_(view),
        centre_y_(f_.middle + c.offset),
        minor_(c.minor + margin),
        margin_(margin),
        longest_(longest) {
    shortest_ = std::max(f_.half_width, (1.0 - kDoubt) * view.least_major());
  }

  bool operator()(Vec2 place) const {
    const double t = (place.y - centre_y_) / minor_;
    if (!(t * t < 1.0 - kLeastWidth * kLeastWidth)) return false;
    const double w = std::sqrt(1.0 - t * t) - kDoubt;
    const double spare = margin_ * w - kDoubt * (shortest_ + std::fabs(place.x) + std::fabs(place.y));
    return reaches(place.x - f_.x[pair_.right] - spare, w - view_.right_width()) &&
           reaches(f_.x[pair_.left] - place.x - spare, w - view_.left_width());
  }

 private:
  /// Far above any rounding here, far below what an end is drawn in by.
  static constexpr double kDoubt = 1e-8;
  /// Where the chord is a smaller share of the axis, the rounding of its height is seen in it.
  static constexpr double kLeastWidth = 0.01;

  bool reaches(double beyond, double wider) const { return beyond <= (wider > 0.0 ? shortest_ : longest_) * wider; }

  const TurnedPoints& f_;
  const Touching& pair_;
  const PairView& view_;
  double centre_y_, minor_, margin_;
  double shortest_ = 0.0, longest_;  ///< m: between these the major axis is, or it is too long
};

/// Whether an ellipse holds a place beyond doubt, in its frame.
inline bool surely_holds(Vec2 centre, double major, double minor, Vec2 place) {
  constexpr double kDoubt = 1e-6;
  const double x = (place.x - centre.x) / major, y = (place.y - centre.y) / minor;
  return x * x + y * y < 1.0 - kDoubt;
}

/// Shares of an axis, by which estimates may be off, and what is allowed for that and for all rounding.
inline constexpr double kEstimate = 1e-9;
inline constexpr double kAllowance = 1e-7;

/// Whether a place lies inside the evolute beyond doubt, in the ellipse's frame. With A = a^2 x^2, B = b^2 y^2 and C =
/// factor (a^2 - b^2)^2 it does where (A + B - C)^3 + 27 A B C < 0 (predicates.cpp), so that larger A and B and a
/// smaller C err towards no.
inline bool surely_inside_evolute(Vec2 centre, double a, double b, Vec2 place, double slack) {
  const double most = a + b;
  const double x = (1.0 + kAllowance) * a * (std::fabs(place.x - centre.x) + kAllowance * most);
  const double y = (1.0 + kAllowance) * b * (std::fabs(place.y - centre.y) + kAllowance * most);
  const double spread = std::fabs(a - b) * most - kAllowance * most * most;
  if (!(spread > 0.0)) return false;
  const double factor = (1.0 + slack) * (1.0 + slack) * (1.0 + slack);
  const double A = x * x, B = y * y, C = (1.0 - kAllowance) * factor * spread * spread;
  const double beyond = C - A - B;
  return beyond > 0.0 && beyond * beyond * beyond > 27.0 * A * B * C;
}

/// Tries candidates on one set of points; keeps the smallest that will do.
class CandidateSearch {
 public:
  /// `least_width`: of the length of an ellipse.
  CandidateSearch(const FitGoal& want, std::vector<double>& width, double least_width)
      : want_(want), width_(width), least_width_(least_width) {}

  /// Whether the ellipse of a candidate of that minor axis is larger than the best, whatever else it is.
  bool is_too_large(const TurnedPoints& f, double minor, bool or_equal) const {
    return limit(minor, or_equal).is_too_long(f.half_width);
  }

  /// Whether every ellipse of a row of candidates, of that minor axis and whatever offset, is: with a pair of points
  /// d apart in height the sum of their half chords is largest midway between them, 2 sqrt(1 - (d / 2b)^2).
  bool is_row_too_large(const Orientation& o, double minor, bool or_equal) const {
    constexpr double kRounding = 4e-12;
    const TurnedPoints& f = o.frame;
    const AreaLimit area = limit(minor, or_equal);
    const double longest = area.longest();
    const auto asks_for_more = [&](const Touching& pair) {
      const double t = 0.5 * (f.y[pair.right] - f.y[pair.left]) / minor;
      return f.x[pair.right] - f.x[pair.left] > 2.0 * longest * std::sqrt(1.0 - t * t) + kRounding * f.extent;
    };
    return area.is_too_long(longest) && (asks_for_more(o.pair[0]) || asks_for_more(recent_));
  }

  /// Whether it is smaller than the best so far (`or_equal`: or as large) and will do: then it is the best. `pair` is
  /// where to look first, and is kept up.
  bool improves(const Orientation& o, const Candidate& c, bool or_equal, const Known& known, Touching& pair) {
    if (known.state == Known::State::hopeless) return false;
    const AreaLimit area = limit(c.minor, or_equal);
    if (known.state == Known::State::estimated && is_surely_refused(o, c, area, known.major)) return false;
    if (known.state != Known::State::fitted && !is_fitted(o, c, area, known, pair)) return false;
    if (area.is_too_long(known.major.major) || is_refused(o, c, area, known.major)) return false;
    const double a = known.major.major + want_.margin, b = area.minor;
    if (std::min(a, b) < least_width_ * std::max(a, b)) return false;
    const Vec2 centre = rotated({known.major.centre, o.frame.middle + c.offset}, c.angle);
    const bool upright = a >= b;
    const Ellipse ellipse =
        ellipse_from_axes(centre, {std::max(a, b), std::min(a, b), upright ? c.angle : c.angle + 0.5 * kPi});
    if (!admissible(ellipse, want_)) return false;
    best_ = {c, ellipse, a * b};
    return true;
  }

  const Scored& best() const { return best_; }

 private:
  AreaLimit limit(double minor, bool or_equal) const {
    return {minor + want_.margin, want_.margin, want_.most_area, best_.area, or_equal};
  }

  /// Whether the ends are beyond doubt where they may not be. A glance in doubles, for most candidates.
  bool is_refused(const Orientation& o, const Candidate& c, const AreaLimit& area, const MajorFit& major) const {
    const double a = major.major + want_.margin, b = area.minor;
    const Vec2 centre{major.centre, o.frame.middle + c.offset};
    return (want_.slack && surely_inside_evolute(centre, a, b, o.ends.whole_goal, *want_.slack)) ||
           surely_holds(centre, a, b, o.ends.start) || surely_holds(centre, a, b, o.ends.goal);
  }
  /// The same of an estimate.
  bool is_surely_refused(const Orientation& o, const Candidate& c, const AreaLimit& area, const MajorFit& major) const {
    return area.is_too_long((1.0 - 2.0 * kEstimate) * major.major) || is_refused(o, c, area, major);
  }

  /// Two points tell of most candidates that they are too long or hold an end.
  bool is_ruled_out(const Orientation& o, const Candidate& c, const AreaLimit& area, const Touching& pair,
                    const Known& known) const {
    const PairView view(o.frame, o.frame.middle + c.offset, c.minor, pair);
    if (const double longest = area.longest(); view.asks_for_more_than(longest) && area.is_too_long(longest))
      return true;
    const double longest_of_any = want_.most_area / c.minor;
    const Holds holds(o, c, want_.margin, pair, view, longest_of_any);
    if (!holds(o.ends.start) && !holds(o.ends.goal)) return false;
    if (want_.is_last_margin) known.state = Known::State::hopeless;
    return true;
  }

  bool is_fitted(const Orientation& o, const Candidate& c, const AreaLimit& area, const Known& known, Touching& pair) {
    const TurnedPoints& f = o.frame;
    if (area.is_too_long(f.half_width) || is_ruled_out(o, c, area, pair, known)) return false;
    if (recent_ != pair && is_ruled_out(o, c, area, recent_, known)) {
      pair = recent_;
      return false;
    }
    LeastMajor least(f, f.middle + c.offset, c.minor, pair, width_);
    const AxisAnswer answer = least.bracket(area);
    recent_ = pair;
    if (answer == AxisAnswer::never) known.state = Known::State::hopeless;
    if (answer != AxisAnswer::fits) return false;
    if (least.doubt() <= kEstimate) {
      known.set(Known::State::estimated, least.about());
      if (is_surely_refused(o, c, area, known.major)) return false;
    }
    known.set(Known::State::fitted, least.exact());
    recent_ = pair;
    return true;
  }

  const FitGoal& want_;
  std::vector<double>& width_;
  double least_width_;
  Scored best_;
  Touching recent_;  ///< what touched last
};

}  // namespace exactvo::geometry::detail
