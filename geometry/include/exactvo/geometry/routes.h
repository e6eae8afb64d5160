// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// From A to B with proof: a route for a disc among polygons and walls, or a closed chain of obstacles and gaps that
/// proves the goal out of reach. docs/guide/routes.md has the theory with its proofs, and pictures.
///
///   RouteMap (obstacles)  ->  RoutePlan (radius)  ->  query(start, goal)  ->  Route | Separated | Blocked
///
/// The free space is closed: a centre is free where it is at least a radius away from every edge and inside no polygon.
/// A gap of exactly two radii is passed. The outside of all obstacles is free, and obstacles may cross, touch and
/// overlap. Radius 0 is a point: it comes as near to obstacles as it likes and touches them with its start and goal at
/// most, so that it passes where some disc does, however small.
///
/// Exact: which of the three answers is given, the points of a route and of a chain, and what `check` says of them
/// (route_certificate.h, which shares no code with this). Rounded: lengths. A route is short, not proven shortest: its
/// `lower_bound` says by how much at most it could be shortened.
///
/// The same obstacles, options and question give the same answer, bit for bit, on any number of threads. Options decide
/// how the plane outside of the obstacles is cut: with others the answer is of the same kind, a route and its bound may
/// differ.
///
/// See also: route_certificate.h (checks answers), datasets/obstacle_file.h (obstacles from files).

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// An edge of an obstacle: `edges_of(obstacles[obstacle])[edge]`.
struct EdgeName {
  std::size_t obstacle = 0;  ///< index into the obstacles
  std::size_t edge = 0;      ///< index into its `edges_of`
};

/// A point with rational coordinates, in metres.
struct ExactPoint {
  Vec2 rounded;   ///< one of the two doubles next to it, or the point itself
  std::string x;  ///< "numerator/denominator"; empty where `rounded.x` is exact
  std::string y;  ///< as `x`, for the other coordinate
};

/// A proven route: every piece between two points keeps a radius away from every obstacle.
struct Route {
  std::vector<ExactPoint> points;  ///< start and goal included; a start that is the goal gives one
  double length = 0.0;             ///< m, rounded
  double lower_bound = 0.0;        ///< m; no route is shorter, up to rounding
};

/// A point of the chain, and how it goes on to the next one.
struct ChainPoint {
  ExactPoint point;          ///< on an edge, proven by `check`
  EdgeName on;               ///< an edge that the point lies on
  bool gap_follows = false;  ///< true: straight across a gap narrower than two radii; false: along the edge `on`
};

/// No route: the closed chain separates start from goal. Each of its pieces lies on an obstacle's edge or bridges a gap
/// narrower than two radii, so that no centre gets across it, and its winding numbers around start and goal differ by
/// an odd number.
struct Separated {
  std::vector<ChainPoint> chain;  ///< closed: the last point goes on to the first
};

/// No route: an end of it is not free.
struct Blocked {
  /// An end of a route. The start is named where neither is free.
  enum class End {
    start,  ///< where the route begins
    goal    ///< where it ends
  };
  End end = End::start;  ///< which end
  bool inside = false;   ///< inside the polygon obstacles[by.obstacle]; else nearer than a radius to the edge, or on it
  EdgeName by;           ///< the obstacle or edge that is in the way; `edge` without meaning where `inside`
};

/// The answer to a question: a proof either way.
using RouteAnswer = std::variant<Route, Separated, Blocked>;

/// How far the map reaches beyond its obstacles. Its scale is the longer side of the obstacles' box (of one point 2^-20
/// of its coordinates, of none 1 m).
struct RouteMapOptions {
  double largest_radius = 0.0;    ///< m, >= 0: radii up to this can be planned for; twice the scale always
  double largest_distance = 0.0;  ///< m, >= 0: starts and goals may lie this far outside of the obstacles' box; four
                                  ///< times the scale always
  /// The map answers only whether there is a route, and with chains: no routes, no widest radius, no radius above
  /// `largest_radius`. It is made in half the time.
  bool chains_only = false;
};

/// A way exists, and no route along it could be proven: a defect of the library, never "unreachable". It may happen
/// where coordinates of one map differ by more than their 16 digits.
struct RouteNotProven : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Obstacles prepared for every radius. Immutable; copies share.
class RouteMap {
 public:
  /// REQUIRES: valid obstacles (`validity.h`) with finite coordinates within 2^100 m; they may cross each other.
  explicit RouteMap(const std::vector<Obstacle>& obstacles, const RouteMapOptions& options = {});

  /// Vertices after all crossings have been cut.
  std::size_t vertex_count() const;
  /// The convex cells that the free plane is cut into: O(vertices), in practice three to ten times as many.
  std::size_t cell_count() const;
  double largest_radius() const;  ///< m
  /// Whether a start or goal may lie there.
  bool covers(Vec2 point) const;

  /// The largest double for which a disc of that radius has a route, in metres; 0 if none has. Exact: `RoutePlan` finds
  /// a route for it, and for the next double a chain, or that an end is blocked. `largest_radius` where even that fits.
  /// O(n log n) for the first question, then O(log n) and the time to look up what is near. REQUIRES: `covers` both;
  /// the map was not made with `RouteMapOptions::chains_only`.
  double widest_radius(Vec2 start, Vec2 goal) const;

  struct Parts;
  const Parts& parts() const { return *parts_; }  ///< for RoutePlan

 private:
  std::shared_ptr<const Parts> parts_;
};

/// A map seen by a disc of one radius. Immutable; copies share; queries from many threads at once.
class RoutePlan {
 public:
  /// REQUIRES: 2^-100 m <= radius <= map.largest_radius(), or radius 0.
  RoutePlan(const RouteMap& map, double radius);

  /// m, as it was given.
  double radius() const;

  /// REQUIRES: both within the map (`covers`); no route where the map was made with `RouteMapOptions::chains_only`.
  /// Throws RouteNotProven.
  RouteAnswer query(Vec2 start, Vec2 goal) const;

  /// Whether there is a route: what `query` decides, without the route. Exact. REQUIRES: both within the map.
  bool is_reachable(Vec2 start, Vec2 goal) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace exactvo::geometry
