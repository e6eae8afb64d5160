// SPDX-License-Identifier: GPL-3.0-or-later
// Which obstacles are in the way, and which of their enclosures must be one.
#include "exactvo/geometry/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "enclosure/ellipse_solver.h"
#include "enclosure/trap_free_fit.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/facades.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

/// Unit vectors all round.
template <std::size_t kCount>
std::array<Vec2, kCount> unit_vectors() {
  std::array<Vec2, kCount> n;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(kCount);
    n[i] = {std::cos(angle), std::sin(angle)};
  }
  return n;
}

constexpr std::size_t kDirections = 180;

const std::array<Vec2, kDirections>& directions() {
  static const std::array<Vec2, kDirections> all = unit_vectors<kDirections>();
  return all;
}

/// Where to begin to look for a direction that separates what lies apart by that.
std::size_t direction_near(Vec2 apart) {
  const double turns = std::atan2(apart.y, apart.x) / (2.0 * kPi);
  const double number = std::floor((turns < 0.0 ? turns + 1.0 : turns) * static_cast<double>(kDirections) + 0.5);
  return static_cast<std::size_t>(number) % kDirections;
}

/// How far a shape reaches in every direction, each looked at when it is asked for.
class Reach {
 public:
  Reach() { known_.fill(std::numeric_limits<double>::quiet_NaN()); }
  double operator()(const GrownShape& shape, std::size_t i, double sign) {
    if (std::isnan(known_[i])) known_[i] = support(shape, sign * directions()[i]).h;
    return known_[i];
  }

 private:
  std::array<double, kDirections> known_;
};

/// A shape grown by `radius`, its box, and how far it reaches along and against every direction.
struct Silhouette {
  Box box;  ///< of the shape alone
  double radius = 0.0;
  GrownShape grown;

  Silhouette(const ConvexShape& shape, double r) : box(box_of(shape)), radius(r), grown{shape, {}, r} {}

  double along(std::size_t i) const { return along_(grown, i, 1.0); }
  double against(std::size_t i) const { return against_(grown, i, -1.0); }

 private:
  mutable Reach along_, against_;
};

/// Whether one of the directions along the axes, which are among those below, separates the grown shapes beyond doubt.
bool boxes_are_apart(const Box& a, const Box& b, double radii) {
  const auto apart = [radii](double high, double low) {
    constexpr double kRounding = 1e-9;
    return low - high > radii + kRounding * (1.0 + radii + std::fabs(low) + std::fabs(high));
  };
  return apart(a.high.x, b.low.x) || apart(b.high.x, a.low.x) || apart(a.high.y, b.low.y) || apart(b.high.y, a.low.y);
}

/// Whether the two shapes, each grown by its radius, may meet: no sampled direction separates them. Errs towards yes.
/// `along` gives the reach of the one; `towards` is the direction to the other, about: they are looked at from there
/// on, to both sides in turn.
template <class Along>
bool may_meet(const Along& along, const Silhouette& b, std::size_t towards) {
  static_assert(kDirections % 2 == 0);
  const auto separates = [&](std::size_t i) { return along(i) + b.against(i) < 0.0; };
  for (std::size_t k = 0; k < kDirections / 2; ++k)
    if (separates((towards + k) % kDirections) || separates((towards + kDirections - 1 - k) % kDirections))
      return false;
  return true;
}

// No direction separates shapes with a point in common, and where each is grown by a radius far above rounding, none
// does in doubles either.

bool is_far_above_rounding(double radius, const Box& a, const Box& b) {
  constexpr double kRounding = 1e-12;
  double largest = 0.0;
  for (const Vec2 p : {a.low, a.high, b.low, b.high}) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return radius > kRounding * largest;
}

/// Whether a segment and a convex polygon (counterclockwise) have a point in common, up to rounding.
bool meets_polygon(Vec2 a, Vec2 b, const std::vector<Vec2>& polygon) {
  double from = 0.0, to = 1.0;  // of the segment, inside the edges so far
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], edge = polygon[(i + 1) % polygon.size()] - p;
    const double at_a = cross(edge, a - p), at_b = cross(edge, b - p);  // >= 0: inside
    if (at_a < 0.0 && at_b < 0.0) return false;
    if (at_a < 0.0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0.0) to = std::min(to, at_a / (at_a - at_b));
  }
  return from <= to && polygon.size() > 2;
}

bool outline_meets_polygon(const ConvexShape& shape, const std::vector<Vec2>& polygon) {
  if (const auto* s = std::get_if<Segment>(&shape)) return meets_polygon(s->a, s->b, polygon);
  const auto* outline = std::get_if<ConvexPolygon>(&shape);
  if (!outline) return false;
  const std::vector<Vec2>& v = outline->vertices;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (meets_polygon(v[i], v[(i + 1) % v.size()], polygon)) return true;
  return false;
}

/// The share of the way along u at which it leaves an ellipse that it begins in the middle of.
double share_inside(const Ellipse& e, Vec2 u) {
  const double x = u.x / e.l11, y = (u.y - e.l21 * x) / e.l22;
  return 1.0 / std::sqrt(x * x + y * y);
}

/// Whether the line between the middles runs inside the one, then inside the other.
bool ellipses_surely_overlap(const Ellipse& a, const Ellipse& b) {
  constexpr double kRounding = 1e-9;
  const Vec2 u = b.center - a.center;
  return share_inside(a, u) + share_inside(b, u) > 1.0 + kRounding;
}

struct Cluster {
  std::vector<std::size_t> obstacles;  ///< ascending
  std::vector<Vec2> hull;              ///< of their points
  std::optional<FittedEllipse> fitted;
  std::unique_ptr<Silhouette> grown;  ///< of the ellipse, by the robot
  std::vector<Vec2> rim;              ///< points on that
  std::size_t number = 0;             ///< in the order of making
  std::vector<bool> settled;          ///< by number: with whom it neither meets nor can be enclosed

  bool is_settled_with(const Cluster& later) const { return later.number < settled.size() && settled[later.number]; }
  void settle_with(const Cluster& later) {
    if (later.number >= settled.size()) settled.resize(later.number + 1);
    settled[later.number] = true;
  }
};

std::vector<Vec2> ends_of(const std::vector<Segment>& facades) {
  std::vector<Vec2> points;
  for (const Segment& s : facades) {
    points.push_back(s.a);
    points.push_back(s.b);
  }
  return points;
}

std::vector<std::size_t> merged(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  std::vector<std::size_t> out;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

/// Clusters of obstacles that lie in the way, merged where their enclosures meet.
class Clustering {
 public:
  Clustering(const std::vector<ObstacleParts>& obstacles, double robot_radius, Vec2 start, Vec2 goal,
             const EnclosureOptions& options)
      : obstacles_(obstacles), robot_radius_(robot_radius), start_(start), goal_(goal), options_(options) {
    boxes_.reserve(obstacles.size());
    for (const ObstacleParts& parts : obstacles) {
      Box& box = boxes_.emplace_back();
      for (const ConvexShape& piece : parts.pieces) box.add(box_of(piece));
    }
    taken_.resize(obstacles.size());
  }

  /// Encloses what the straight way meets, then what the detours round those enclosures meet, until nothing new does.
  void run() {
    for (std::vector<std::size_t> met = newly_met(); !met.empty(); met = newly_met()) {
      for (std::size_t i : met) {
        clusters_.push_back(cluster({i}, convex_hull(ends_of(obstacles_[i].facades)).vertices));
        taken_[i] = true;
      }
      while (merge_one()) {
      }
    }
  }

  const std::vector<Cluster>& clusters() const { return clusters_; }
  bool in_the_way(std::size_t obstacle) const { return taken_[obstacle]; }

 private:
  Cluster cluster(std::vector<std::size_t> which, std::vector<Vec2> hull) {
    Cluster c{std::move(which), std::move(hull), {}, {}, {}, made_++, {}};
    c.fitted = detail::fit_trap_free(memory_, c.hull, robot_radius_, start_, goal_, options_);
    if (c.fitted) c.grown = std::make_unique<Silhouette>(c.fitted->ellipse, robot_radius_);
    return c;
  }

  static const std::vector<Vec2>& rim_of(Cluster& c) {
    static const std::array<Vec2, 32> kAround = unit_vectors<32>();
    if (c.rim.empty())
      for (const Vec2 n : kAround) c.rim.push_back(support_point(c.grown->grown, n));
    return c.rim;
  }

  Cluster union_of(const Cluster& a, const Cluster& b) {
    std::vector<Vec2> corners = a.hull;
    corners.insert(corners.end(), b.hull.begin(), b.hull.end());
    return cluster(merged(a.obstacles, b.obstacles), convex_hull(corners).vertices);
  }

  /// The hull of start, goal and every enclosure grown by the robot: where the robot may pass.
  ConvexPolygon passage() {
    std::vector<Vec2> points{start_, goal_};
    for (Cluster& c : clusters_)
      if (c.fitted) points.insert(points.end(), rim_of(c).begin(), rim_of(c).end());
    return convex_hull(points);
  }

  std::vector<std::size_t> newly_met() {
    if (std::find(taken_.begin(), taken_.end(), false) == taken_.end()) return {};
    // Each side of `may_meet` is grown by half of what the robot keeps clear of the obstacle itself.
    const double clearance = 0.5 * (robot_radius_ + options_.margin);
    const Silhouette way(passage(), clearance);
    const auto meets_way = [&](const ConvexShape& piece) {
      const Box box = box_of(piece);
      if (boxes_are_apart(box, way.box, 2.0 * clearance)) return false;
      if (is_far_above_rounding(clearance, box, way.box) &&
          outline_meets_polygon(piece, std::get<ConvexPolygon>(way.grown.shape).vertices))
        return true;
      const GrownShape grown{piece, {}, clearance};
      const Vec2 middle = 0.5 * (box.low + box.high);
      const std::size_t towards = direction_near(nearest_point({start_, goal_}, middle) - middle);
      return may_meet([&](std::size_t i) { return support(grown, directions()[i]).h; }, way, towards);
    };
    std::vector<std::size_t> met;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
      if (taken_[i] || boxes_are_apart(boxes_[i], way.box, 2.0 * clearance)) continue;
      const std::vector<ConvexShape>& pieces = obstacles_[i].pieces;
      if (std::any_of(pieces.begin(), pieces.end(), meets_way)) met.push_back(i);
    }
    return met;
  }

  bool ellipses_may_meet(const Cluster& a, const Cluster& b) const {
    if (boxes_are_apart(a.grown->box, b.grown->box, 2.0 * robot_radius_)) return false;
    const Ellipse &one = a.fitted->ellipse, &other = b.fitted->ellipse;
    if (is_far_above_rounding(robot_radius_, a.grown->box, b.grown->box) && ellipses_surely_overlap(one, other))
      return true;
    const std::size_t towards = direction_near(other.center - one.center);
    return may_meet([&](std::size_t i) { return a.grown->along(i); }, *b.grown, towards);
  }

  /// Merges the first pair that meets and whose union can be enclosed; false when there is none left. Clusters only
  /// grow, so that what is settled of a pair stays so.
  bool merge_one() {
    for (std::size_t i = 0; i < clusters_.size(); ++i) {
      for (std::size_t j = i + 1; j < clusters_.size(); ++j) {
        if (!clusters_[i].fitted || !clusters_[j].fitted) continue;
        if (clusters_[i].is_settled_with(clusters_[j])) continue;
        if (ellipses_may_meet(clusters_[i], clusters_[j])) {
          Cluster both = union_of(clusters_[i], clusters_[j]);
          if (both.fitted) {
            clusters_[i] = std::move(both);
            clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(j));
            return true;
          }
        }
        clusters_[i].settle_with(clusters_[j]);
      }
    }
    return false;
  }

  const std::vector<ObstacleParts>& obstacles_;
  double robot_radius_;
  Vec2 start_, goal_;
  const EnclosureOptions& options_;
  std::vector<Box> boxes_;   ///< of the obstacles
  std::vector<bool> taken_;  ///< whether an obstacle is in a cluster
  std::vector<Cluster> clusters_;
  detail::FitMemory memory_;
  std::size_t made_ = 0;  ///< clusters
};

void add_tight(const std::vector<ObstacleParts>& obstacles, std::size_t i, std::vector<Enclosure>& out) {
  for (const ConvexShape& piece : obstacles[i].pieces) out.push_back({piece, {i}, EnclosureGrade::tight});
}

}  // namespace

ObstacleParts parts_of(const Obstacle& obstacle) {
  ObstacleParts parts;
  parts.facades = divide_into_facades(obstacle).facades;
  const Polygon* polygon = std::get_if<Polygon>(&obstacle);
  if (polygon && polygon->holes.empty()) {
    for (ConvexPolygon& piece : convex_pieces(polygon->outer)) parts.pieces.emplace_back(std::move(piece));
  } else {
    parts.pieces.assign(parts.facades.begin(), parts.facades.end());
  }
  return parts;
}

std::vector<Enclosure> enclose(const std::vector<ObstacleParts>& obstacles, double robot_radius, Vec2 start, Vec2 goal,
                               const EnclosureOptions& options) {
  Clustering clustering(obstacles, robot_radius, start, goal, options);
  clustering.run();
  std::vector<Enclosure> out;
  std::size_t most = clustering.clusters().size();
  for (const ObstacleParts& parts : obstacles) most += parts.pieces.size();
  out.reserve(most);
  for (const Cluster& c : clustering.clusters()) {
    if (c.fitted) {
      out.push_back({c.fitted->ellipse, c.obstacles, c.fitted->grade});
    } else {
      for (std::size_t i : c.obstacles) add_tight(obstacles, i, out);
    }
  }
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    if (!clustering.in_the_way(i)) add_tight(obstacles, i, out);
  return out;
}

// The ellipse of one facade, in closed form (paper, equation (8)).
Ellipse facade_ellipse(const Segment& facade, const FacadeEllipseOptions& options) {
  EXACTVO_REQUIRE(is_finite(facade.a) && is_finite(facade.b), to_string(ConvexShape{facade}));
  EXACTVO_REQUIRE(options.fixed_minor > 0.0 || options.minor_to_major > 0.0, std::to_string(options.minor_to_major));
  const Vec2 along = facade.b - facade.a;
  const double half = 0.5 * norm(along);
  const double a = half + options.margin;
  const double b = options.fixed_minor > 0.0 ? std::min(options.fixed_minor, a) : options.minor_to_major * a;
  const Ellipse e = ellipse_from_axes(facade.a + 0.5 * along, {a, b, std::atan2(along.y, along.x)});
  const std::optional<Ellipse> whole = detail::inflate_to_contain(e, {facade.a, facade.b});
  EXACTVO_REQUIRE(whole.has_value(), to_string(ConvexShape{e}));
  return *whole;
}

double clearance_of_equation_8(const Segment& facade, const Ellipse& enclosure, double robot_radius) {
  const EllipseAxes axes = axes_of(enclosure);
  const double half = 0.5 * norm(facade.b - facade.a);
  const double a = axes.a, b = axes.b;
  const bool rounded_end = half >= a - b * b / a;
  const double depth = rounded_end ? a - half : b * std::sqrt(1.0 - half * half / (a * a - b * b));
  return robot_radius + depth;
}

}  // namespace exactvo::geometry
