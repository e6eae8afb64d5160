// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest ellipse round some points at which a robot cannot come to rest: a search over orientation, offset and
// semi-minor axis.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "enclosure/inflate.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using detail::inflate_to_contain;

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

struct Frame {
  std::vector<double> x, y;  ///< of the points, turned by -angle
  double middle = 0.0;       ///< of the y extent
  double half_height = 0.0;
  double left = 0.0, right = 0.0;  ///< the x extent
};

void turn(const std::vector<Vec2>& points, double angle, Frame& f) {
  f.x.clear();
  f.y.clear();
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  f.left = low;
  f.right = high;
  for (Vec2 p : points) {
    const Vec2 q = rotated(p, -angle);
    f.x.push_back(q.x);
    f.y.push_back(q.y);
    low = std::min(low, q.y);
    high = std::max(high, q.y);
    f.left = std::min(f.left, q.x);
    f.right = std::max(f.right, q.x);
  }
  f.middle = 0.5 * (low + high);
  f.half_height = 0.5 * (high - low);
}

/// The centres x for which all points lie in the ellipse with semi-axes (major, w_i from the minor axis), and the
/// points that bound them.
struct Centres {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  std::size_t at_low = 0, at_high = 0;
  bool is_empty() const { return !(low <= high); }
};

Centres centres_for(const Frame& f, const std::vector<double>& width, double major) {
  Centres range;
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    const double low = f.x[i] - major * width[i], high = f.x[i] + major * width[i];
    if (low > range.low) range.low = low, range.at_low = i;
    if (high < range.high) range.high = high, range.at_high = i;
  }
  return range;
}

/// Whether there are any.
bool has_centre(const Frame& f, const std::vector<double>& width, double major) {
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    const double reach = major * width[i];
    low = std::max(low, f.x[i] - reach);
    high = std::min(high, f.x[i] + reach);
  }
  return low <= high;
}

/// Whether a major axis is long enough. It is so from some double on, rounding and all, since every operation of
/// `centres_for` is monotone in it: what is known of one axis answers for others.
class LongEnough {
 public:
  LongEnough(const Frame& f, const std::vector<double>& width) : f_(f), width_(width) {}

  bool operator()(double major) {
    if (major >= long_enough_) return true;
    if (major <= too_short_) return false;
    const bool is = has_centre(f_, width_, major);
    (is ? long_enough_ : too_short_) = major;
    return is;
  }

  /// Draws what is known together round the least one: the gap between two points' centres is linear in the axis, so
  /// Newton's method climbs to it from `at`, which is hardly longer, in a few steps.
  void approach(double at) {
    constexpr int kSteps = 8;
    constexpr double kRounding = 1e-14;  // relative: a few roundings beyond a root
    at = std::max({too_short_, at, 0.0});
    for (int i = 0; i < kSteps && at < long_enough_; ++i) {
      const Centres c = centres_for(f_, width_, at);
      if (!c.is_empty()) {
        long_enough_ = at;
        return;
      }
      too_short_ = std::max(too_short_, at);
      const double next = (f_.x[c.at_low] - f_.x[c.at_high]) / (width_[c.at_low] + width_[c.at_high]);
      at = std::max(next, at) * (1.0 + kRounding);
    }
  }

 private:
  const Frame& f_;
  const std::vector<double>& width_;
  double too_short_ = -1.0;
  double long_enough_ = std::numeric_limits<double>::infinity();
};

/// The least semi-major axis and its centre.
struct MajorFit {
  double major = 0.0, centre = 0.0;
};

enum class Fitted { yes, too_long, never };

/// By bisection. `never` where a point lies beyond the minor axis; `too_long` where the answer is seen to be: a
/// condition that holds for every axis longer than one for which it holds, from about `longest` m on.
template <class TooLong>
Fitted least_major(const Frame& f, double centre_y, double minor, double longest, const TooLong& too_long,
                   std::vector<double>& width, MajorFit& out) {
  // No ellipse is shorter than half of what it encloses, up to the rounding of coordinates.
  const double rounding = 8.0 * kUnitRoundoff * (std::fabs(f.left) + std::fabs(f.right));
  const double half = 0.5 * (f.right - f.left) - rounding;
  if (too_long(half)) return Fitted::too_long;
  width.clear();
  double narrowest = 1.0;
  for (const double y : f.y) {
    const double t = (y - centre_y) / minor;
    if (!(std::fabs(t) < 1.0)) return Fitted::never;
    width.push_back(std::sqrt(1.0 - t * t));
    narrowest = std::min(narrowest, width.back());
  }
  double extent = 0.0;
  for (const double x : f.x) extent = std::max(extent, std::fabs(x - f.x.front()));
  double low = 0.0;
  double high = extent / narrowest;
  LongEnough long_enough(f, width);
  if (longest < high && too_long(longest) && !long_enough(longest)) return Fitted::too_long;
  long_enough.approach(half);
  constexpr int kBisections = 40;  // leaves 2^-40 of the extent, far below any margin
  for (int i = 0; i < kBisections; ++i) {
    const double mid = 0.5 * (low + high);
    (long_enough(mid) ? high : low) = mid;
  }
  const Centres range = centres_for(f, width, high);
  out = {high, 0.5 * (range.low + range.high)};
  return Fitted::yes;
}

bool admissible(const Ellipse& e, const FitGoal& want) {
  const GrownShape kept_clear{e, {}, want.robot_radius + want.clear};
  if (locate(kept_clear, want.goal) != Place::outside || locate(kept_clear, want.start) != Place::outside) return false;
  return !want.slack || goal_outside_evolute(e, want.goal, *want.slack);
}

std::vector<double> coarse_angles(const std::vector<Vec2>& hull) {
  constexpr int kAngles = 18;
  std::vector<double> angles;
  for (int i = 0; i < kAngles; ++i) angles.push_back(kPi * i / kAngles);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 e = hull[(i + 1) % hull.size()] - hull[i];
    if (e != Vec2{}) angles.push_back(std::atan2(e.y, e.x));
  }
  return angles;
}

constexpr double kMinorShares[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8};
constexpr double kOffsetShares[] = {0.0, -0.25, 0.25, -0.5, 0.5, -0.9, 0.9};

/// The candidates of the coarse search round some points: orientation x semi-minor axis x offset across. With what is
/// known of each whatever its margin and goal.
class CoarseGrid {
 public:
  struct Item {
    Candidate candidate;
    std::optional<Fitted> fitted;  ///< `yes` or `never`; nothing where it was not asked yet
    MajorFit major;
  };

  CoarseGrid(const std::vector<Vec2>& points, double size) {
    for (const double angle : coarse_angles(points)) {
      turn(points, angle, frames_.emplace_back());
      for (const double minor_share : kMinorShares) {
        for (const double offset_share : kOffsetShares) {
          const double room = minor_share * size;
          items_.push_back({{angle, offset_share * room, frames_.back().half_height + room}, {}, {}});
        }
      }
    }
  }

  std::size_t size() const { return items_.size(); }
  Item& operator[](std::size_t i) { return items_[i]; }
  const Frame& frame(std::size_t i) const { return frames_[i / kAnAngle]; }
  /// Those in the middle are near the best ones.
  static bool is_central(std::size_t i) { return i % std::size(kOffsetShares) == 0; }

 private:
  static constexpr std::size_t kAnAngle = std::size(kMinorShares) * std::size(kOffsetShares);
  std::vector<Item> items_;
  std::vector<Frame> frames_;
};

/// Tries candidates on one set of points; keeps the smallest that will do.
class Search {
 public:
  Search(const std::vector<Vec2>& points, const FitGoal& want) : points_(points), want_(want) {}

  /// The smallest of the grid, of equals the first. Central ones are tried first, so that most others are seen at once
  /// to be larger.
  void sweep(CoarseGrid& grid) {
    std::size_t best = grid.size();
    for (const bool central : {true, false}) {
      for (std::size_t i = 0; i < grid.size(); ++i) {
        if (CoarseGrid::is_central(i) != central) continue;
        or_equal_ = i < best;
        if (improves(grid[i], grid.frame(i))) best = i;
      }
    }
    or_equal_ = false;
  }

  /// Whether it is smaller than the best so far and will do: then it is the best.
  bool improves(const Candidate& c) {
    if (!turned_ || c.angle != angle_) turn(points_, c.angle, frame_);
    turned_ = true;
    angle_ = c.angle;
    CoarseGrid::Item item{c, {}, {}};
    return improves(item, frame_);
  }

  const Scored& best() const { return best_; }

 private:
  bool improves(CoarseGrid::Item& item, const Frame& f) {
    if (item.fitted == Fitted::never) return false;
    const Candidate& c = item.candidate;
    const double centre_y = f.middle + c.offset;
    const double b = c.minor + want_.margin;
    const auto too_long = [&](double major) {
      const double area = (major + want_.margin) * b;
      return !(area <= want_.most_area && (area < best_.area || (or_equal_ && area == best_.area)));
    };
    if (!item.fitted) {
      constexpr double kRounding = 1.0 + 1e-14;
      const double longest = kRounding * (std::min(want_.most_area, best_.area) / b) - want_.margin;
      const Fitted fitted = least_major(f, centre_y, c.minor, longest, too_long, width_, item.major);
      if (fitted != Fitted::too_long) item.fitted = fitted;
      if (fitted != Fitted::yes) return false;
    }
    if (too_long(item.major.major)) return false;
    const double a = item.major.major + want_.margin;
    const Vec2 centre = rotated({item.major.centre, centre_y}, c.angle);
    const bool upright = a >= b;
    const Ellipse ellipse =
        ellipse_from_axes(centre, {std::max(a, b), std::min(a, b), upright ? c.angle : c.angle + 0.5 * kPi});
    if (!admissible(ellipse, want_)) return false;
    best_ = {c, ellipse, a * b};
    return true;
  }

  const std::vector<Vec2>& points_;
  const FitGoal& want_;
  Scored best_;
  bool or_equal_ = false;  ///< an ellipse as large as the best takes its place
  Frame frame_;
  double angle_ = 0.0;
  bool turned_ = false;
  std::vector<double> width_;
};

/// A pattern search from the best of a coarse one.
void refine(double size, Search& search) {
  double angle_step = kPi / 36.0;
  double length_step = 0.1 * size;
  constexpr int kRounds = 60;
  constexpr double kLeastStep = 1e-3;  // of the size: finer changes the area by less than a per mille
  for (int round = 0; round < kRounds && length_step > kLeastStep * size; ++round) {
    const Candidate c = search.best().candidate;
    const Candidate moves[] = {{c.angle + angle_step, c.offset, c.minor},
                               {c.angle - angle_step, c.offset, c.minor},
                               {c.angle, c.offset + length_step, c.minor},
                               {c.angle, c.offset - length_step, c.minor},
                               {c.angle, c.offset, c.minor + length_step},
                               {c.angle, c.offset, c.minor - length_step},
                               {c.angle, c.offset + length_step, c.minor + length_step},
                               {c.angle, c.offset - length_step, c.minor + length_step}};
    bool better = false;
    for (const Candidate& move : moves)
      if (move.minor > 0.0 && search.improves(move)) better = true;
    if (better) continue;
    angle_step *= 0.5;
    length_step *= 0.5;
  }
}

/// Whether `end` lies so near the hull that no ellipse round it with a margin can be clear of it.
bool is_too_near(const std::vector<Vec2>& hull, const FitGoal& want, double size, Vec2 end) {
  constexpr double kRounding = 1e-9;  // of the sizes, far above any rounding of the fit, far below a margin
  if (want.margin < kRounding * size) return false;
  const double reach = (1.0 - kRounding) * (want.robot_radius + want.clear) - kRounding * size;
  return locate({ConvexPolygon{hull}, {}, std::max(reach, 0.0)}, end) != Place::outside;
}

std::vector<Vec2> seen_from(Vec2 origin, std::vector<Vec2> points) {
  for (Vec2& p : points) p = p - origin;
  return points;
}

FitGoal seen_from(Vec2 origin, FitGoal want) {
  want.start = want.start - origin;
  want.goal = want.goal - origin;
  return want;
}

/// Searched for from the first corner: of ellipses as good as each other the same one is taken wherever the scene lies.
class LocalFit {
 public:
  LocalFit(const std::vector<Vec2>& hull, double size)
      : hull_(hull), local_(seen_from(hull.front(), hull)), size_(size) {}

  std::optional<Ellipse> operator()(const FitGoal& want) {
    const FitGoal local_want = seen_from(hull_.front(), want);
    if (is_too_near(local_, local_want, size_, local_want.start) ||
        is_too_near(local_, local_want, size_, local_want.goal))
      return std::nullopt;
    if (!grid_) grid_.emplace(local_, size_);
    Search search(local_, local_want);
    search.sweep(*grid_);
    if (!std::isfinite(search.best().area)) return std::nullopt;
    refine(size_, search);
    Ellipse e = search.best().ellipse;
    e.center = e.center + hull_.front();
    e = inflate_to_contain(e, hull_);
    if (!admissible(e, want)) return std::nullopt;
    return e;
  }

 private:
  const std::vector<Vec2>& hull_;
  std::vector<Vec2> local_;
  double size_;
  std::optional<CoarseGrid> grid_;
};

/// The area of hull (+) D(0, r): A + P r + pi r^2.
double grown_area(const std::vector<Vec2>& hull, double r) {
  double twice_area = 0.0;
  double perimeter = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 a = hull[i];
    const Vec2 b = hull[(i + 1) % hull.size()];
    twice_area += cross(a - hull[0], b - hull[0]);
    perimeter += norm(b - a);
  }
  return 0.5 * twice_area + perimeter * r + kPi * r * r;
}

double size_of(const std::vector<Vec2>& points) {
  double size = 0.0;
  for (Vec2 p : points) size = std::max(size, norm(p - points.front()));
  constexpr double kLeastSize = 0.1;  // m: a point still needs an ellipse with some extent
  return std::max(size, kLeastSize);
}

}  // namespace

const char* name(EnclosureGrade grade) {
  switch (grade) {
    case EnclosureGrade::trap_free:
      return "trap-free";
    case EnclosureGrade::trap_free_thin:
      return "trap-free-thin";
    case EnclosureGrade::containing:
      return "containing";
    case EnclosureGrade::tight:
      return "tight";
  }
  return "tight";
}

std::optional<FittedEllipse> fit_trap_free(const std::vector<Vec2>& points, double robot_radius, Vec2 start, Vec2 goal,
                                           const EnclosureOptions& options) {
  EXACTVO_REQUIRE(!points.empty(), "no points");
  const std::vector<Vec2> hull = convex_hull(points).vertices;
  const double size = size_of(hull);
  const double most = options.most_inflation * grown_area(hull, robot_radius + options.margin) / kPi;
  const double clear = options.clear_of_ends;
  const FitGoal full{robot_radius, start, goal, options.margin, options.slack, clear, most};
  const FitGoal thin{robot_radius, start, goal, options.least_margin, options.least_slack, clear, most};
  const FitGoal bare{robot_radius, start, goal, options.least_margin, std::nullopt, clear, most};
  LocalFit fit(hull, size);
  if (auto e = fit(full)) return FittedEllipse{*e, EnclosureGrade::trap_free};
  if (auto e = fit(thin)) return FittedEllipse{*e, EnclosureGrade::trap_free_thin};
  if (auto e = fit(bare)) return FittedEllipse{*e, EnclosureGrade::containing};
  return std::nullopt;
}

}  // namespace exactvo::geometry
