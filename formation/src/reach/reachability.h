// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which places robots can reach among the static obstacles of a scene, and why not the others. Exact for a place
/// (geometry/routes.h). A place counts as reached within a disc about it: that some place in the disc can be reached is
/// exact too; that none can is proven by `is_proven_out_of_reach`, or left open. A disc counts as the polygon round it,
/// which is wider by up to kRoundExcess of its radius (geometry/round_polygon.h): that a place can be reached holds of
/// the disc; that none can holds of it unless `is_open_past_discs`. Moving obstacles and other robots are not
/// considered, nor the margins that a method keeps.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/routes.h"
#include "scene/edges_by_place.h"
#include "scene/number_text.h"

namespace exactvo::formation::detail {

/// A place, and how near to it a robot has reached it.
struct Destination {
  Vec2 place;          ///< m
  double reach = 0.0;  ///< m, >= 0
};

/// "(1.5, -2)", m.
std::string printed_place(Vec2 place);

/// 64 places on four rings about a place, less than `reach` m from it, the nearest first.
std::vector<Vec2> places_about(Vec2 place, double reach);

/// m: of a plan.
inline constexpr double kLeastPlanned = 0x1p-100;

/// What routes are planned in. The obstacles must outlive what is made of it.
struct Terrain {
  const std::vector<SceneObstacle>& obstacles;
  geometry::Box places;         ///< m: where robots start and have to go
  double largest_radius = 0.0;  ///< m, of the robots
};
/// That of a scenario's robots among its static obstacles.
Terrain terrain_of(const Scenario& scenario);

class Reachability {
 public:
  /// `most_extra`: what a robot may be asked to keep beside its radius, m, >= 0. `routes`: whether the map and plans
  /// will be asked for routes too; without, they are made sooner.
  explicit Reachability(const Terrain& terrain, double most_extra = 0.0, bool routes = true);

  /// Made at the first question and kept: of many scenes nobody asks for it.
  const geometry::RouteMap& map();

  /// Made at the first question and kept. REQUIRES: no more than the largest radius of the robots and `most_extra`.
  const geometry::RoutePlan& plan(double radius);

  /// The destination, or of 64 places within its reach the first that a disc of `radius` can get to.
  std::optional<Vec2> reachable_place(double radius, Vec2 from, const Destination& to);

  /// Whether no place within reach of the destination can be reached: proven of the polygons, up to a rounding that
  /// leaves it open.
  bool is_proven_out_of_reach(double radius, Vec2 from, const Destination& to);

  /// Whether what is out of reach past the polygons round discs may be in reach past the discs: a disc takes part, and
  /// a robot smaller by what the polygons are wider is not proven to have no route. Certified where false.
  bool is_open_past_discs(double radius, Vec2 from, const Destination& to);

  /// m, >= 0: no place that a disc can reach is nearer to the goal; proven up to rounding. 0 where the disc is not free
  /// at `from`. REQUIRES: the goal cannot be reached; radius no more than the largest of the robots and `most_extra`.
  double at_least(double radius, Vec2 from, Vec2 goal);

  /// Whether a closed chain separates the two for a disc of `radius`, or for one as large as the goal leaves room for.
  bool is_shut_off(double radius, Vec2 from, Vec2 goal);

  /// "obstacles 'a' and 'b' enclose the start, with gaps of at most 0.9 m for a robot 1 m wide"; the goal is called
  /// `goal`. A goal that leaves the robot no room and is shut off for a smaller one as well is said to be enclosed. The
  /// words say where it is no proof, as the goal `is_open_past_discs`.
  /// REQUIRES: the destination's place itself cannot be reached.
  std::string why_not(double radius, Vec2 from, const Destination& to, const std::string& goal);

  /// The closed chain that separates the two for a disc of `radius`; empty where none does.
  std::vector<geometry::ChainPoint> chain(double radius, Vec2 from, Vec2 goal);

  /// The edges of all obstacles; made at the first call and kept.
  const EdgesByPlace& edges();
  const std::vector<SceneObstacle>& obstacles() const { return terrain_.obstacles; }

 private:
  double excess_of_discs() const;
  std::string why_not_past_polygons(double radius, Vec2 from, const Destination& to, const std::string& goal);
  std::optional<geometry::Separated> shut_off(double radius, Vec2 from, Vec2 goal);
  double distance_to_edges(Vec2 place, double most);
  std::string words_of(const geometry::Separated& answer, double radius, const std::string& goal, Vec2 place) const;

  Terrain terrain_;
  geometry::Box walls_;  ///< round all obstacles
  double most_extra_;    ///< m
  bool routes_;
  std::optional<geometry::RouteMap> map_;
  std::map<double, geometry::RoutePlan> plans_;  ///< by radius
  std::optional<EdgesByPlace> edges_;
};

}  // namespace exactvo::formation::detail
