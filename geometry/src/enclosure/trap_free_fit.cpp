// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest ellipse round some points at which a robot cannot come to rest: a search over orientation, offset and
// semi-minor axis.
#include <algorithm>
#include <cmath>
#include <limits>

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
  std::vector<Vec2> points;  ///< turned by -angle
  double middle = 0.0;       ///< of the y extent
  double half_height = 0.0;
};

Frame turn(const std::vector<Vec2>& points, double angle) {
  Frame f;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (Vec2 p : points) {
    f.points.push_back(rotated(p, -angle));
    low = std::min(low, f.points.back().y);
    high = std::max(high, f.points.back().y);
  }
  f.middle = 0.5 * (low + high);
  f.half_height = 0.5 * (high - low);
  return f;
}

struct Interval {
  double low, high;
};

/// The centres x for which all points lie in the ellipse with semi-axes (major, w_i from the minor axis).
Interval centres_for(const Frame& f, const std::vector<double>& width, double major) {
  Interval range{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < f.points.size(); ++i) {
    range.low = std::max(range.low, f.points[i].x - major * width[i]);
    range.high = std::min(range.high, f.points[i].x + major * width[i]);
  }
  return range;
}

/// The least semi-major axis and its centre, by bisection on the major axis; nothing if a point lies beyond the minor
/// one.
struct MajorFit {
  double major, centre;
};
std::optional<MajorFit> least_major(const Frame& f, double centre_y, double minor) {
  std::vector<double> width;
  double narrowest = 1.0;
  for (Vec2 p : f.points) {
    const double t = (p.y - centre_y) / minor;
    if (!(std::fabs(t) < 1.0)) return std::nullopt;
    width.push_back(std::sqrt(1.0 - t * t));
    narrowest = std::min(narrowest, width.back());
  }
  double extent = 0.0;
  for (Vec2 p : f.points) extent = std::max(extent, std::fabs(p.x - f.points.front().x));
  double low = 0.0;
  double high = extent / narrowest;
  constexpr int kBisections = 40;  // leaves 2^-40 of the extent, far below any margin
  for (int i = 0; i < kBisections; ++i) {
    const double mid = 0.5 * (low + high);
    const Interval range = centres_for(f, width, mid);
    (range.low <= range.high ? high : low) = mid;
  }
  const Interval range = centres_for(f, width, high);
  return MajorFit{high, 0.5 * (range.low + range.high)};
}

bool admissible(const Ellipse& e, const FitGoal& want) {
  const GrownShape kept_clear{e, {}, want.robot_radius + want.clear};
  if (locate(kept_clear, want.goal) != Place::outside || locate(kept_clear, want.start) != Place::outside) return false;
  return !want.slack || goal_outside_evolute(e, want.goal, *want.slack);
}

Scored score(const std::vector<Vec2>& points, const Candidate& c, const FitGoal& want) {
  Scored out;
  out.candidate = c;
  const Frame f = turn(points, c.angle);
  const double centre_y = f.middle + c.offset;
  const std::optional<MajorFit> fit = least_major(f, centre_y, c.minor);
  if (!fit) return out;
  const double a = fit->major + want.margin;
  const double b = c.minor + want.margin;
  const Vec2 centre = rotated({fit->centre, centre_y}, c.angle);
  const bool upright = a >= b;
  out.ellipse = ellipse_from_axes(centre, {std::max(a, b), std::min(a, b), upright ? c.angle : c.angle + 0.5 * kPi});
  if (a * b <= want.most_area && admissible(out.ellipse, want)) out.area = a * b;
  return out;
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

/// A first sweep: orientation x semi-minor axis x offset across.
Scored sweep(const std::vector<Vec2>& hull, const FitGoal& want, double size) {
  constexpr double kMinorShares[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.8};
  constexpr double kOffsetShares[] = {0.0, -0.25, 0.25, -0.5, 0.5, -0.9, 0.9};
  Scored best;
  for (double angle : coarse_angles(hull)) {
    const double half_height = turn(hull, angle).half_height;
    for (double minor_share : kMinorShares) {
      for (double offset_share : kOffsetShares) {
        const double room = minor_share * size;
        const Scored s = score(hull, {angle, offset_share * room, half_height + room}, want);
        if (s.area < best.area) best = s;
      }
    }
  }
  return best;
}

/// Then a pattern search from the best of it.
Scored refine(const std::vector<Vec2>& hull, const FitGoal& want, double size, Scored best) {
  double angle_step = kPi / 36.0;
  double length_step = 0.1 * size;
  constexpr int kRounds = 60;
  constexpr double kLeastStep = 1e-3;  // of the size: finer changes the area by less than a per mille
  for (int round = 0; round < kRounds && length_step > kLeastStep * size; ++round) {
    const Candidate c = best.candidate;
    const Candidate moves[] = {{c.angle + angle_step, c.offset, c.minor},
                               {c.angle - angle_step, c.offset, c.minor},
                               {c.angle, c.offset + length_step, c.minor},
                               {c.angle, c.offset - length_step, c.minor},
                               {c.angle, c.offset, c.minor + length_step},
                               {c.angle, c.offset, c.minor - length_step},
                               {c.angle, c.offset + length_step, c.minor + length_step},
                               {c.angle, c.offset - length_step, c.minor + length_step}};
    bool better = false;
    for (const Candidate& move : moves) {
      if (!(move.minor > 0.0)) continue;
      const Scored s = score(hull, move, want);
      if (s.area < best.area) {
        best = s;
        better = true;
      }
    }
    if (better) continue;
    angle_step *= 0.5;
    length_step *= 0.5;
  }
  return best;
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
std::optional<Ellipse> fit(const std::vector<Vec2>& hull, const FitGoal& want, double size) {
  const Vec2 origin = hull.front();
  const std::vector<Vec2> local = seen_from(origin, hull);
  const FitGoal local_want = seen_from(origin, want);
  const Scored coarse = sweep(local, local_want, size);
  if (!std::isfinite(coarse.area)) return std::nullopt;
  Ellipse e = refine(local, local_want, size, coarse).ellipse;
  e.center = e.center + origin;
  e = inflate_to_contain(e, hull);
  if (!admissible(e, want)) return std::nullopt;
  return e;
}

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
  if (auto e = fit(hull, full, size)) return FittedEllipse{*e, EnclosureGrade::trap_free};
  if (auto e = fit(hull, thin, size)) return FittedEllipse{*e, EnclosureGrade::trap_free_thin};
  if (auto e = fit(hull, bare, size)) return FittedEllipse{*e, EnclosureGrade::containing};
  return std::nullopt;
}

}  // namespace exactvo::geometry
