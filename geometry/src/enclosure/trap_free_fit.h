// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// `fit_trap_free` for a caller that fits many.
///
/// Candidates of the smallest ellipse at which a robot cannot come to rest (trap_free_fit.cpp): of a given orientation,
/// offset and semi-minor axis. `CandidateSearch` keeps the best. Most candidates are ruled out in doubles, with
/// allowances far above any rounding; what is kept was decided by the exact predicates.
///
/// The shortest ellipse round some points whose direction, minor axis and centre across it are given: a search in one
/// number, by bisection, in doubles. Most candidates of a fit are not worth it, and a pair of points shows that: with
/// semi-axes (a, b), a point at (x, y) from the middle allows centres within a w of x, w = sqrt(1 - (y/b)^2), so that
/// two points ask for a (w + w') >= x - x'. Where a pair is asked beside all points the answer is the same.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry::detail {

/// Points turned by -angle, so that the major axis lies along x.
struct TurnedPoints {
  double angle = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x, y;
  double middle = 0.0;                      ///< of the y extent
  double half_height = 0.0;                 ///< of the y extent
  double extent = 0.0;                      ///< the farthest x from the first point's
  double half_width = 0.0;                  ///< of the x extent, rounded down: no ellipse is shorter
  std::size_t leftmost = 0, rightmost = 0;  ///< points
};

/// The cosine and the sine of -angle: what turns points into a frame.
struct Turn {
  double cosine = 1.0, sine = 0.0;
  Vec2 operator()(Vec2 p) const { return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y}; }
};
Turn turn_by(double angle);

void turn(const std::vector<Vec2>& points, double angle, const Turn& by, TurnedPoints& f);

/// Two points that bound the centre: the one on the right from below, the one on the left from above. At the least axis
/// those that touch.
struct Touching {
  std::size_t right = 0, left = 0;
};

/// Which semi-major axes are too long: by the area of the ellipse grown by a margin.
struct AreaLimit {
  double minor = 0.0;     ///< m, semi-minor axis with the margin
  double margin = 0.0;    ///< m
  double most = 0.0;      ///< m^2 / pi
  double best = 0.0;      ///< m^2 / pi: of what is known already
  bool or_equal = false;  ///< as good as the best will do

  double area(double major) const { return (major + margin) * minor; }
  /// Monotone in the axis, rounding and all.
  bool is_too_long(double major) const {
    const double a = area(major);
    return !(a <= most && (a < best || (or_equal && a == best)));
  }
  /// m: a little longer than every axis that is not too long.
  double longest() const {
    constexpr double kRounding = 1.0 + 1e-14;
    return kRounding * ((most < best ? most : best) / minor) - margin;
  }
};

/// The least semi-major axis and its centre.
struct MajorFit {
  double major = 0.0, centre = 0.0;
};

enum class AxisAnswer {
  fits,
  too_long,  ///< the answer is
  never      ///< a point lies beyond the minor axis
};

/// The search for the least axis of one candidate. `width` is memory for the points' widths.
class LeastMajor {
 public:
  LeastMajor(const TurnedPoints& f, double centre_y, double minor, std::vector<double>& width)
      : f_(f), centre_y_(centre_y), minor_(minor), pair_{f.rightmost, f.leftmost}, width_(width) {}

  /// Whether it fits, and about how.
  AxisAnswer bracket(const AreaLimit& limit);
  /// After `fits`: about what `exact` is. Axis and centre are off by `doubt()` of the axis at most.
  MajorFit about() const { return about_; }
  double doubt() const { return doubt_; }
  /// After `fits`: the axis by bisection.
  MajorFit exact();

 private:
  bool pair_is_apart(double major) const;
  double least_of_pair() const;
  bool has_centre(double major);
  bool is_long_enough(double major);
  void approach(double at);

  const TurnedPoints& f_;
  double centre_y_, minor_;
  Touching pair_;  ///< what bounded the centre last
  std::vector<double>& width_;
  double high_ = 0.0;  ///< m, where the bisection begins
  double too_short_ = -1.0;
  double long_enough_ = std::numeric_limits<double>::infinity();
  MajorFit about_;  ///< of the axis that was long enough last
  double doubt_ = std::numeric_limits<double>::infinity();
};

struct FitGoal {
  double robot_radius;
  Vec2 start, goal;
  double margin;
  std::optional<double> slack;  ///< none: the evolute condition is dropped
  double clear;
  double most_area = 0.0;  ///< m^2 / pi: a larger ellipse shuts more ways than it opens
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
    hopeless    ///< no ellipse
  };
  State& state;
  MajorFit& major;
};

/// Start and goal, drawn towards the points by a little less than they must stay clear: an ellipse that holds such a
/// place does not leave the end itself outside. NaN where nothing follows from it.
struct Ends {
  Vec2 start, goal;
  Vec2 whole_goal;  ///< where it is
};

struct Orientation {
  TurnedPoints frame;
  Ends ends;  ///< in the frame

  void turn_to(double angle, const Turn& by, const std::vector<Vec2>& points, const Ends& from) {
    turn(points, angle, by, frame);
    ends = {by(from.start), by(from.goal), by(from.whole_goal)};
  }
};

/// Whether an ellipse holds a place beyond doubt, in its frame.
inline bool surely_holds(Vec2 centre, double major, double minor, Vec2 place) {
  constexpr double kDoubt = 1e-6;
  const double x = (place.x - centre.x) / major, y = (place.y - centre.y) / minor;
  return x * x + y * y < 1.0 - kDoubt;
}

/// Shares of an axis: by which estimates may be off, and what is allowed for that and for all rounding.
inline constexpr double kEstimate = 1e-9, kAllowance = 1e-7;

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

  /// The same by two points, d apart in height: whatever the offset, the sum of their half chords is no more than it is
  /// midway between them, 2 sqrt(1 - (d / 2b)^2).
  bool is_row_too_large(const TurnedPoints& f, double minor, bool or_equal) const {
    constexpr double kRounding = 4e-12;
    const AreaLimit area = limit(minor, or_equal);
    const double longest = area.longest(), t = 0.5 * (f.y[f.rightmost] - f.y[f.leftmost]) / minor;
    const double most = 2.0 * longest * std::sqrt(1.0 - t * t);
    return area.is_too_long(longest) && f.x[f.rightmost] - f.x[f.leftmost] > most + kRounding * f.extent;
  }

  /// Whether it is smaller than the best so far (`or_equal`: or as large) and will do: then it is the best.
  bool improves(const Orientation& o, const Candidate& c, bool or_equal, const Known& known) {
    if (known.state == Known::State::hopeless) return false;
    const AreaLimit area = limit(c.minor, or_equal);
    if (known.state == Known::State::estimated && is_surely_refused(o, c, area, known.major)) return false;
    if (known.state != Known::State::fitted && !is_fitted(o, c, area, known)) return false;
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

  /// The same from an estimate.
  bool is_surely_refused(const Orientation& o, const Candidate& c, const AreaLimit& area, const MajorFit& major) const {
    return area.is_too_long((1.0 - 2.0 * kEstimate) * major.major) || is_refused(o, c, area, major);
  }

  bool is_fitted(const Orientation& o, const Candidate& c, const AreaLimit& area, const Known& known) {
    if (area.is_too_long(o.frame.half_width)) return false;
    LeastMajor least(o.frame, o.frame.middle + c.offset, c.minor, width_);
    const AxisAnswer answer = least.bracket(area);
    if (answer == AxisAnswer::never) known.state = Known::State::hopeless;
    if (answer != AxisAnswer::fits) return false;
    if (least.doubt() <= kEstimate) {
      known.state = Known::State::estimated;
      known.major = least.about();
      if (is_surely_refused(o, c, area, known.major)) return false;
    }
    known.state = Known::State::fitted;
    known.major = least.exact();
    return true;
  }

  const FitGoal& want_;
  std::vector<double>& width_;
  double least_width_;
  Scored best_;
};

/// What a fit leaves to the next: memory.
struct FitMemory {
  std::vector<Vec2> points;    ///< the hull's corners from the first of them
  std::vector<double> angles;  ///< of the coarse search
  std::vector<Orientation> orientations;
  // One for each candidate: orientation x semi-minor axis x offset across.
  std::vector<Known::State> state;
  std::vector<MajorFit> major;  ///< read where the state says so
  Orientation here, aside;      ///< of the pattern search
  std::vector<double> width;
};

/// As `fit_trap_free` of enclosure.h. REQUIRES: the corners of a convex hull, as `convex_hull` gives them.
std::optional<FittedEllipse> fit_trap_free(FitMemory& memory, const std::vector<Vec2>& hull, double robot_radius,
                                           Vec2 start, Vec2 goal, const EnclosureOptions& options);

}  // namespace exactvo::geometry::detail
