// SPDX-License-Identifier: GPL-3.0-or-later
// Which obstacles are in the way, and which of their enclosures must be one.
#include "exactvo/geometry/enclosure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/geometry/facades.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

/// Whether the two shapes, each grown by `radius`, may meet: no sampled direction separates them. Errs towards yes.
bool may_meet(const ConvexShape& a, const ConvexShape& b, double radius) {
  constexpr int kDirections = 180;
  const GrownShape grown_a{a, {}, radius};
  const GrownShape grown_b{b, {}, radius};
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * kPi * i / kDirections;
    const Vec2 n{std::cos(angle), std::sin(angle)};
    if (support(grown_a, n).h + support(grown_b, -n).h < 0.0) return false;
  }
  return true;
}

struct Cluster {
  std::vector<std::size_t> obstacles;  ///< ascending
  std::optional<FittedEllipse> fitted;
};

std::vector<Vec2> points_of(const std::vector<ObstacleParts>& obstacles, const std::vector<std::size_t>& which) {
  std::vector<Vec2> points;
  for (std::size_t i : which) {
    for (const Segment& s : obstacles[i].facades) {
      points.push_back(s.a);
      points.push_back(s.b);
    }
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
      : obstacles_(obstacles), robot_radius_(robot_radius), start_(start), goal_(goal), options_(options) {}

  /// Encloses what the straight way meets, then what the detours round those enclosures meet, until nothing new does.
  void run() {
    for (std::vector<std::size_t> met = newly_met(); !met.empty(); met = newly_met()) {
      for (std::size_t i : met) clusters_.push_back(cluster({i}));
      while (merge_one()) {
      }
    }
  }

  const std::vector<Cluster>& clusters() const { return clusters_; }
  bool in_the_way(std::size_t obstacle) const {
    return std::any_of(clusters_.begin(), clusters_.end(), [obstacle](const Cluster& c) {
      return std::binary_search(c.obstacles.begin(), c.obstacles.end(), obstacle);
    });
  }

 private:
  Cluster cluster(std::vector<std::size_t> which) const {
    Cluster c{std::move(which), {}};
    c.fitted = fit_trap_free(points_of(obstacles_, c.obstacles), robot_radius_, start_, goal_, options_);
    return c;
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
    const ConvexPolygon way = passage();
    // Each side of `may_meet` is grown by half of what the robot keeps clear of the obstacle itself.
    const double clearance = 0.5 * (robot_radius_ + options_.margin);
    std::vector<std::size_t> met;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
      if (in_the_way(i)) continue;
      const std::vector<ConvexShape>& pieces = obstacles_[i].pieces;
      if (std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) { return may_meet(piece, way, clearance); }))
        met.push_back(i);
    }
    return met;
  }

  bool was_refused(const std::vector<std::size_t>& which) const {
    return std::find(refused_.begin(), refused_.end(), which) != refused_.end();
  }

  /// Merges the first pair that meets and whose union can be enclosed; false when there is none left.
  bool merge_one() {
    for (std::size_t i = 0; i < clusters_.size(); ++i) {
      for (std::size_t j = i + 1; j < clusters_.size(); ++j) {
        if (!clusters_[i].fitted || !clusters_[j].fitted) continue;
        if (!may_meet(clusters_[i].fitted->ellipse, clusters_[j].fitted->ellipse, robot_radius_)) continue;
        std::vector<std::size_t> which = merged(clusters_[i].obstacles, clusters_[j].obstacles);
        if (was_refused(which)) continue;
        Cluster both = cluster(which);
        if (!both.fitted) {
          refused_.push_back(std::move(which));
          continue;
        }
        clusters_[i] = std::move(both);
        clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(j));
        return true;
      }
    }
    return false;
  }

  const std::vector<ObstacleParts>& obstacles_;
  double robot_radius_;
  Vec2 start_, goal_;
  const EnclosureOptions& options_;
  std::vector<Cluster> clusters_;
  std::vector<std::vector<std::size_t>> refused_;  ///< unions that can't be enclosed
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
