// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The shortest ellipse round some points whose direction, minor axis and centre across it are given: a search in one
/// number, by bisection, in doubles. Most candidates of a fit are not worth it, and a pair of points shows that: with
/// semi-axes (a, b), a point at (x, y) from the middle allows centres within a w of x, w = sqrt(1 - (y/b)^2), so that
/// two points ask for a (w + w') >= x - x'. Where a pair is asked beside all points the answer is the same.

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

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
  bool operator!=(const Touching& other) const { return right != other.right || left != other.left; }
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

/// A pair's part of the points, for one centre across and minor axis.
class PairView {
 public:
  PairView(const TurnedPoints& f, double centre_y, double minor, const Touching& pair)
      : f_(f),
        pair_(pair),
        right_(width(f.y[pair.right], centre_y, minor)),
        left_(width(f.y[pair.left], centre_y, minor)) {}

  /// sqrt(1 - t^2); nothing comparable beyond the minor axis.
  static double width(double y, double centre_y, double minor) {
    const double t = (y - centre_y) / minor;
    return std::sqrt(1.0 - t * t);
  }

  double right_width() const { return right_; }
  double left_width() const { return left_; }
  /// m: no axis is shorter, up to rounding.
  double least_major() const { return (f_.x[pair_.right] - f_.x[pair_.left]) / (right_ + left_); }
  /// Whether the pair asks for more than that beyond the rounding of any answer.
  bool asks_for_more_than(double major) const {
    constexpr double kRounding = 1e-12;
    const double gap = (f_.x[pair_.right] - major * right_) - (f_.x[pair_.left] + major * left_);
    return gap > kRounding * f_.extent;
  }

 private:
  const TurnedPoints& f_;
  const Touching& pair_;
  double right_, left_;
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

/// The search for the least axis of one candidate, in two steps: most candidates are refused after the first. `pair` is
/// where to look first, and becomes the pair that touches. `width` is memory for the points' widths.
class LeastMajor {
 public:
  LeastMajor(const TurnedPoints& f, double centre_y, double minor, Touching& pair, std::vector<double>& width)
      : f_(f), centre_y_(centre_y), minor_(minor), pair_(pair), width_(width) {}

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
  Touching& pair_;
  std::vector<double>& width_;
  double high_ = 0.0;  ///< m, where the bisection begins
  double too_short_ = -1.0;
  double long_enough_ = std::numeric_limits<double>::infinity();
  MajorFit about_;
  double doubt_ = std::numeric_limits<double>::infinity();
};

}  // namespace exactvo::geometry::detail
