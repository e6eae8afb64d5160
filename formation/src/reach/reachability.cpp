// SPDX-License-Identifier: GPL-3.0-or-later
#include "reach/reachability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <variant>

#include "exactvo/formation/constraint_name.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/round_polygon.h"
#include "scene/goals.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Blocked;
using geometry::RouteAnswer;
using geometry::Separated;

std::vector<geometry::Obstacle> shapes_of(const std::vector<SceneObstacle>& obstacles) {
  std::vector<geometry::Obstacle> all;
  for (const SceneObstacle& o : obstacles) all.push_back(o.shape);
  return all;
}

/// Where robots start and have to go.
geometry::Box places_of(const Scenario& scenario) {
  geometry::Box box;
  for (const Robot& r : scenario.robots) {
    box.add(r.position);
    for (const Vec2 p : r.goals) box.add(p);
  }
  if (!scenario.formation) return box;
  double offset = 0.0;
  for (const Vec2 o : scenario.formation->offsets) offset = std::max(offset, norm(o));
  for (const Vec2 p : scenario.formation->leader.path)
    box.add(geometry::Box{p, p}.grown(2.0 * offset));  // twice: recentring moves them
  return box;
}

geometry::Box box_of(const std::vector<SceneObstacle>& obstacles) {
  geometry::Box box;
  for (const SceneObstacle& o : obstacles)
    for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
  return box;
}

/// Starts, goals and their surroundings, where robots may be pushed.
geometry::RouteMapOptions options_for(const Terrain& terrain, geometry::Box box, double extra, bool routes) {
  box.add(terrain.places);
  geometry::RouteMapOptions options;
  options.chains_only = !routes;
  options.largest_radius = std::max(kLeastPlanned, terrain.largest_radius + extra);
  options.largest_distance = 2.0 * norm(box.high - box.low) + 100.0 * options.largest_radius;
  return options;
}

std::vector<Vec2> corners_of(const Separated& answer) {
  std::vector<Vec2> corners;
  for (const geometry::ChainPoint& p : answer.chain) corners.push_back(p.point.rounded);
  return corners;
}

/// The straight way from the goal to a free place x beyond the chain crosses the chain in some point z. That is at
/// least the radius from x where it lies on an edge. In a gap of width w, z is no farther than w / 2 from an end, and
/// at least the radius less that from x.
double distance_beyond(const Separated& answer, double radius, Vec2 goal) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < answer.chain.size(); ++k) {
    const geometry::Segment piece{answer.chain[k].point.rounded,
                                  answer.chain[(k + 1) % answer.chain.size()].point.rounded};
    const double gap = answer.chain[k].gap_follows ? norm(piece.b - piece.a) : 0.0;
    least = std::min(least, geometry::distance(piece, goal) + radius - 0.5 * gap);
  }
  return least;
}

constexpr double kBeyondReach = 1.0001;  // times the reach, for rounding

}  // namespace

std::string printed_place(Vec2 place) {
  return "(" + number_text(place.x, 6) + ", " + number_text(place.y, 6) + ")";
}

std::vector<Vec2> places_about(Vec2 place, double reach) {
  constexpr double kRings[] = {0.25, 0.5, 0.75, 0.99};  // of the reach; less than 1, for rounding
  constexpr int kDirections = 16;
  std::vector<Vec2> places;
  for (const double ring : kRings)
    for (int k = 0; k < kDirections; ++k)
      places.push_back(place + ring * reach * geometry::rotated({1.0, 0.0}, k * (2.0 * geometry::kPi) / kDirections));
  return places;
}

Terrain terrain_of(const Scenario& scenario) {
  double largest = 0.0;
  for (const Robot& robot : scenario.robots) largest = std::max({largest, robot.radius, obstacle_radius(robot)});
  return {scenario.obstacles, places_of(scenario), largest};
}

Reachability::Reachability(const Terrain& terrain, double most_extra, bool routes)
    : terrain_(terrain), walls_(box_of(terrain.obstacles)), most_extra_(most_extra), routes_(routes) {}

const geometry::RouteMap& Reachability::map() {
  if (!map_) map_.emplace(shapes_of(terrain_.obstacles), options_for(terrain_, walls_, most_extra_, routes_));
  return *map_;
}

const geometry::RoutePlan& Reachability::plan(double radius) {
  const double r = std::max(radius, kLeastPlanned);
  return plans_.try_emplace(r, map(), r).first->second;
}

std::optional<Vec2> Reachability::reachable_place(double radius, Vec2 from, const Destination& to) {
  // Outside of the box of all obstacles one can go round it: no map is needed.
  const auto is_outside = [&](Vec2 p) {
    return terrain_.places.contains(p) && geometry::distance_below(walls_, p) > std::max(radius, kLeastPlanned);
  };
  if (terrain_.obstacles.empty() || (is_outside(from) && is_outside(to.place))) return to.place;
  if (!map().covers(from) || !map().covers(to.place)) return std::nullopt;
  const geometry::RoutePlan& of_robot = plan(radius);
  if (of_robot.is_reachable(from, to.place)) return to.place;
  if (to.reach == 0.0 || !of_robot.is_reachable(from, from)) return std::nullopt;
  for (const Vec2 place : places_about(to.place, to.reach))
    if (map().covers(place) && of_robot.is_reachable(from, place)) return place;
  return std::nullopt;
}

bool Reachability::is_proven_out_of_reach(double radius, Vec2 from, const Destination& to) {
  if (terrain_.obstacles.empty() || !map().covers(from) || !map().covers(to.place)) return false;
  const geometry::RoutePlan& of_robot = plan(radius);
  if (!of_robot.is_reachable(from, from) || of_robot.is_reachable(from, to.place)) return false;
  if (to.reach == 0.0 || at_least(radius, from, to.place) > kBeyondReach * to.reach) return true;
  // A robot that is free at a place p within reach: from p to the destination nothing comes nearer than its radius
  // less the reach. A robot so much smaller would have a route.
  const double less = std::nextafter(radius - to.reach, 0.0);
  return less > kLeastPlanned && !plan(less).is_reachable(from, to.place);
}

/// Math: the polygon lies in the disc grown by the excess e. So a disc of radius r that is free beside the discs is
/// free beside their polygons with the radius r - e. A chain without a disc on it needs no such argument.
bool Reachability::is_open_past_discs(double radius, Vec2 from, const Destination& to) {
  const double excess = excess_of_discs();
  if (excess == 0.0 || !map().covers(from) || !map().covers(to.place)) return false;
  const std::optional<Separated> separated = shut_off(radius, from, to.place);
  const auto is_on_disc = [&](const geometry::ChainPoint& p) {
    return terrain_.obstacles[p.on.obstacle].disc.has_value();
  };
  if (separated && std::none_of(separated->chain.begin(), separated->chain.end(), is_on_disc) &&
      (to.reach == 0.0 || distance_beyond(*separated, radius, to.place) > kBeyondReach * to.reach))
    return false;
  const double less = std::nextafter(radius - excess, 0.0);
  return !(less > kLeastPlanned) || !is_proven_out_of_reach(less, from, to);
}

/// m: how far corners of the polygons lie beyond the rims at most.
double Reachability::excess_of_discs() const {
  double excess = 0.0;
  for (const SceneObstacle& o : terrain_.obstacles)
    if (o.disc)
      excess =
          std::max(excess, geometry::kRoundExcess * o.disc->radius + 0x1p-45 * (norm(o.disc->center) + o.disc->radius));
  return excess;
}

double Reachability::at_least(double radius, Vec2 from, Vec2 goal) {
  if (!map().covers(from) || !map().covers(goal) || !plan(radius).is_reachable(from, from)) return 0.0;
  const double nearest_edge = distance_to_edges(goal, radius);
  // A polygon's boundary lies between what is inside of it and every free place.
  double bound = std::max(0.0, radius - nearest_edge);
  for (const SceneObstacle& o : terrain_.obstacles) {
    const auto* polygon = std::get_if<geometry::Polygon>(&o.shape);
    if (polygon && geometry::contains(*polygon, goal))
      bound = std::max(bound, radius - geometry::signed_distance(o.shape, goal));
  }
  const std::optional<Separated> separated = shut_off(radius, from, goal);
  return separated ? std::max(bound, distance_beyond(*separated, radius, goal)) : bound;
}

bool Reachability::is_shut_off(double radius, Vec2 from, Vec2 goal) {
  return map().covers(from) && map().covers(goal) && shut_off(radius, from, goal).has_value();
}

/// What a smaller disc cannot pass, the disc cannot pass either.
std::optional<Separated> Reachability::shut_off(double radius, Vec2 from, Vec2 goal) {
  constexpr double kFits = 0.999;  // of the room at the goal, for rounding
  const auto separated_for = [&](const geometry::RoutePlan& disc) -> std::optional<Separated> {
    if (disc.is_reachable(from, goal)) return std::nullopt;
    RouteAnswer answer = disc.query(from, goal);
    auto* separated = std::get_if<Separated>(&answer);
    return separated ? std::optional(std::move(*separated)) : std::nullopt;
  };
  std::optional<Separated> found = separated_for(plan(radius));
  const double smaller = kFits * distance_to_edges(goal, radius);
  if (found || !(smaller >= kLeastPlanned) || !plan(radius).is_reachable(from, from)) return found;
  return separated_for(geometry::RoutePlan(map(), std::min(smaller, radius)));
}

/// m, no farther than `most`; `most` where there is none.
double Reachability::distance_to_edges(Vec2 place, double most) {
  double least = most;
  edges().grid().for_each_within(
      place, most, [&](std::size_t k) { least = std::min(least, geometry::distance(edges()[k], place)); });
  return least;
}

const EdgesByPlace& Reachability::edges() {
  if (!edges_) edges_.emplace(terrain_.obstacles);
  return *edges_;
}

std::string Reachability::why_not(double radius, Vec2 from, const Destination& to, const std::string& goal) {
  std::string text = why_not_past_polygons(radius, from, to, goal);
  if (is_open_past_discs(radius, from, to))
    text += "; this is no proof, as discs count as the polygons round them, up to " +
            number_text(excess_of_discs(), 3) + " m wider";
  return text;
}

std::string Reachability::why_not_past_polygons(double radius, Vec2 from, const Destination& to,
                                                const std::string& goal) {
  if (!map().covers(from) || !map().covers(to.place)) return goal + " is too far from all obstacles";
  if (const std::optional<Separated> separated = shut_off(radius, from, to.place))
    return words_of(*separated, radius, goal, to.place);
  const auto blocked = std::get<Blocked>(plan(radius).query(from, to.place));
  const bool of_start = blocked.end == Blocked::End::start;
  const SceneObstacle& by = terrain_.obstacles[blocked.by.obstacle];
  const std::string what = of_start ? "the robot" : goal;
  const bool is_inside = blocked.inside || geometry::signed_distance(by.shape, of_start ? from : to.place) < 0.0;
  return what + (is_inside ? " lies inside" : " is nearer than the robot's radius to") + " obstacle '" + by.id + "'";
}

std::vector<geometry::ChainPoint> Reachability::chain(double radius, Vec2 from, Vec2 goal) {
  if (!map().covers(from) || !map().covers(goal)) return {};
  const RouteAnswer answer = plan(radius).query(from, goal);
  const auto* separated = std::get_if<Separated>(&answer);
  return separated ? separated->chain : std::vector<geometry::ChainPoint>{};
}

std::string Reachability::words_of(const Separated& answer, double radius, const std::string& goal, Vec2 place) const {
  const std::vector<Vec2> corners = corners_of(answer);
  std::set<std::size_t> obstacles;
  std::size_t gaps = 0;
  double widest = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    obstacles.insert(answer.chain[k].on.obstacle);
    if (!answer.chain[k].gap_follows) continue;
    ++gaps;
    widest = std::max(widest, norm(corners[(k + 1) % corners.size()] - corners[k]));
  }
  std::vector<std::string> ids;
  for (const std::size_t o : obstacles) ids.push_back("'" + terrain_.obstacles[o].id + "'");
  const bool one = ids.size() == 1;
  std::string text = (one ? "obstacle " : "obstacles ") + abridged(ids) + (one ? " encloses " : " enclose ") +
                     (geometry::contains(geometry::Polygon{corners, {}}, place) ? goal : "the start");
  if (gaps == 0) return text;
  const auto [width, needed] = geometry::told_apart(widest, 2.0 * radius);
  return text + (gaps == 1 ? ", with a gap of " : ", with " + std::to_string(gaps) + " gaps of at most ") + width +
         " m for a robot " + needed + " m wide";
}

}  // namespace exactvo::formation::detail
