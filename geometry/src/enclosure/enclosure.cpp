// SPDX-License-Identifier: GPL-3.0-or-later
// Which obstacles are in the way, and which of their enclosures must be one.
#include "exactvo/geometry/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "enclosure/trap_free_fit.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/facades.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

using detail::TrapFreeFit;

constexpr int kDirections = 180;

/// Unit vectors all round.
const std::array<Vec2, kDirections>& directions() {
  static const std::array<Vec2, kDirections> all = [] {
    std::array<Vec2, kDirections> n;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * kPi * i / kDirections;
      n[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return n;
  }();
  return all;
}

/// A shape grown by `radius`, its box, and how far it reaches against every direction.
struct Silhouette {
  Box box;  ///< of the shape alone
  double radius = 0.0;
  GrownShape grown;
  std::array<double, kDirections> against{};

  Silhouette(const ConvexShape& shape, double r) : box(box_of(shape)), radius(r), grown{shape, {}, r} {
    for (std::size_t i = 0; i < against.size(); ++i) against[i] = support(grown, -directions()[i]).h;
  }
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
/// `separating` is where to begin to look, and becomes the direction that was found.
bool may_meet(const GrownShape& a, const Silhouette& b, std::size_t& separating) {
  for (std::size_t k = 0; k < kDirections; ++k) {
    const std::size_t i = (separating + k) % kDirections;
    if (support(a, directions()[i]).h + b.against[i] < 0.0) {
      separating = i;
      return false;
    }
  }
  return true;
}

struct Cluster {
  std::vector<std::size_t> obstacles;  ///< ascending
  std::vector<Vec2> hull;              ///< of their points
  std::optional<FittedEllipse> fitted;
  std::optional<Silhouette> grown;  ///< of the ellipse, by the robot
  std::size_t number = 0;           ///< in the order of making
  std::vector<bool> settled;        ///< by number: with whom it neither meets nor can be enclosed

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
    Cluster c{std::move(which), std::move(hull), {}, {}, made_++, {}};
    c.fitted = fit_(c.hull, robot_radius_, start_, goal_, options_);
    if (c.fitted) c.grown.emplace(c.fitted->ellipse, robot_radius_);
    return c;
  }

  Cluster union_of(const Cluster& a, const Cluster& b) {
    std::vector<Vec2> corners = a.hull;
    corners.insert(corners.end(), b.hull.begin(), b.hull.end());
    return cluster(merged(a.obstacles, b.obstacles), convex_hull(corners).vertices);
  }

  /// The hull of start, goal and every enclosure grown by the robot: where the robot may pass.
  ConvexPolygon passage() const {
    constexpr int kSamples = 32;
    std::vector<Vec2> points{start_, goal_};
    for (const Cluster& c : clusters_) {
      if (!c.fitted) continue;
      for (int i = 0; i < kSamples; ++i) {
        const double angle = 2.0 * kPi * i / kSamples;
        points.push_back(support_point({c.fitted->ellipse, {}, robot_radius_}, {std::cos(angle), std::sin(angle)}));
      }
    }
    return convex_hull(points);
  }

  std::vector<std::size_t> newly_met() const {
    // Each side of `may_meet` is grown by half of what the robot keeps clear of the obstacle itself.
    const double clearance = 0.5 * (robot_radius_ + options_.margin);
    const Silhouette way(passage(), clearance);
    std::size_t separating = 0;
    const auto meets_way = [&](const ConvexShape& piece) {
      if (boxes_are_apart(box_of(piece), way.box, 2.0 * clearance)) return false;
      return may_meet({piece, {}, clearance}, way, separating);
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
    std::size_t separating = 0;
    return may_meet(a.grown->grown, *b.grown, separating);
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
  TrapFreeFit fit_;
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

}  // namespace exactvo::geometry
