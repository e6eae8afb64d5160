// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/trap.h"

#include <algorithm>
#include <cmath>

#include "control/consensus.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/orca_obstacle.h"
#include "reach/reachability.h"
#include "scene/static_field.h"
#include "traps/boundary.h"
#include "traps/concave_vertex.h"

namespace exactvo::formation {
namespace {

using detail::is_over;
using detail::outward;
using geometry::ConvexShape;
using geometry::Ellipse;

bool clear_of(const ConvexShape& shape, double radius, Vec2 point) {
  return geometry::locate(geometry::GrownShape{shape, {}, radius}, point) == geometry::Place::outside;
}

Equilibrium equilibrium_at(const detail::Boundary& boundary, double turn, Vec2 goal) {
  const detail::BoundaryPoint p = boundary.at(turn);
  Equilibrium e;
  e.normal = p.normal;
  e.radius_of_curvature = p.radius_of_curvature;
  // Over the goal's foot: on a flat edge the support point is one of its ends.
  e.distance = dot(p.position - goal, p.normal);
  e.position = goal + e.distance * p.normal;
  e.stable = e.distance < e.radius_of_curvature;
  return e;
}

/// A robot slides from `turn` towards the goal: time until the goal is no longer behind the boundary.
std::optional<double> slide(const detail::Boundary& boundary, double turn, Vec2 goal, double speed) {
  // Steps of a small turn: the boundary's length is rho times the turn, walked at the tangential share of the speed.
  constexpr double kTurn = 1e-4;        // rad
  constexpr double kLeastShare = 1e-9;  // of the speed: slower is at rest
  double time = 0.0;
  double way = 0.0;
  for (double turned = 0.0; turned < 4.0; turned += kTurn) {
    const detail::BoundaryPoint p = boundary.at(turn);
    const Vec2 ahead = geometry::normalized(goal - p.position);
    if (dot(ahead, p.normal) >= 0.0) return time;
    const double share = dot(ahead, geometry::perp(p.normal));
    const double sense = share > 0.0 ? 1.0 : -1.0;
    if (std::fabs(share) < kLeastShare || way * sense < 0.0) return std::nullopt;  // at rest, or turned back
    way = sense;
    time += p.radius_of_curvature * kTurn / (speed * std::fabs(share));
    turn += sense * kTurn;
  }
  return std::nullopt;
}

/// Where the straight way from start to goal first meets the grown boundary, as a turn.
std::optional<double> first_hit(const detail::Boundary& boundary, Vec2 start, Vec2 goal) {
  constexpr int kSamples = 7200;
  const Vec2 way = goal - start;
  std::optional<double> hit;
  double nearest = geometry::kInfinity;
  for (int i = 0; i < kSamples; ++i) {
    const double turn = detail::kFullTurn * i / kSamples, next = detail::kFullTurn * (i + 1) / kSamples;
    const Vec2 a = boundary.at(turn).position, b = boundary.at(next).position;
    const double side_a = cross(way, a - start), side_b = cross(way, b - start);
    if ((side_a > 0.0) == (side_b > 0.0)) continue;
    const double share = side_a / (side_a - side_b);
    const double along = dot(a + share * (b - a) - start, way) / dot(way, way);
    if (along < 0.0 || along > 1.0 || along >= nearest) continue;
    nearest = along;
    hit = turn + share * (next - turn);
  }
  return hit;
}

// --- Edges as they stand, for the method that builds no enclosures ---

/// An edge with free space on its right, and the corner in which it ends.
struct Facade {
  std::size_t obstacle = 0;
  geometry::Segment edge;
  std::optional<Vec2> beyond;  ///< where the next edge ends, if it turns into the free space
};

std::vector<Facade> facades_of(const detail::Scene& scene) {
  std::vector<Facade> facades;
  for (std::size_t c = 0; c < scene.chains().size(); ++c) {
    const vo::OrcaChain& chain = scene.chains()[c];
    const std::size_t n = chain.vertices.size();
    const std::size_t obstacle = scene.bodies()[scene.edge(scene.first_edge(c))].owners.front();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t end = (i + 1) % n;
      facades.push_back({obstacle, {chain.vertices[i], chain.vertices[end]}, {}});
      if (!chain.convex[end]) facades.back().beyond = chain.vertices[(end + 1) % n];
    }
  }
  return facades;
}

/// A robot rests over the goal's foot, also where the goal lies in front of the edge by less than the robot's radius.
std::optional<Equilibrium> rest_on_edge(const Facade& f, double radius, Vec2 goal) {
  const Vec2 out = outward(f.edge);
  const double distance = -dot(goal - f.edge.a, out) + radius;
  if (!(distance > 0.0) || !is_over(f.edge, goal)) return std::nullopt;
  return Equilibrium{goal + distance * out, out, geometry::kInfinity, distance, true};
}

/// Where a robot touches an edge and the next one, and both with its rim. Nothing in a slit, nor past an edge's end.
std::optional<Vec2> touching_both(const geometry::Segment& edge, const geometry::Segment& next, double radius) {
  const Vec2 out = outward(edge), out_next = outward(next);
  const Vec2 at = edge.b + (radius / (1.0 + dot(out, out_next))) * (out + out_next);
  if (!is_finite(at) || !is_over(edge, at) || !is_over(next, at)) return std::nullopt;
  return at;
}

/// Whether a robot there keeps clear of every edge of the obstacle. It touches two: the rounding of `at`, some 2^-52 of
/// its coordinates, stays below the slack so long as these are less than 2^20 radii.
bool is_clear_of_all(const std::vector<Facade>& facades, std::size_t obstacle, double radius, Vec2 at) {
  constexpr double kSlack = 0x1p-30;  // of the radius
  return std::all_of(facades.begin(), facades.end(), [&](const Facade& f) {
    return f.obstacle != obstacle || clear_of(f.edge, (1.0 - kSlack) * radius, at);
  });
}

/// A robot that touches both edges rests where they leave it no way nearer to the goal: the way there is
/// -(s out + t out_next) with s, t >= 0, and not nothing.
std::optional<Equilibrium> rest_in_corner(const Facade& f, double radius, Vec2 goal) {
  if (!f.beyond) return std::nullopt;
  const geometry::Segment next_edge{f.edge.b, *f.beyond};
  const Vec2 out = outward(f.edge), next = outward(next_edge);
  const double turn = cross(out, next);  // < 0: the chain turns right
  if (!(turn < 0.0)) return std::nullopt;
  const auto at = touching_both(f.edge, next_edge, radius);
  if (!at) return std::nullopt;
  const Vec2 way = goal - *at;
  if (way == Vec2{} || cross(way, next) / turn > 0.0 || cross(out, way) / turn > 0.0) return std::nullopt;
  return Equilibrium{*at, geometry::normalized(out + next), geometry::kInfinity, norm(way), true};
}

TrapFinding examine(const Facade& f, std::size_t number, const std::vector<Facade>& all, const Robot& robot,
                    Vec2 goal) {
  TrapFinding finding;
  finding.goal = goal;
  finding.place = {{f.edge, {f.obstacle}, geometry::EnclosureGrade::tight}, number, f.edge};
  const double radius = obstacle_radius(robot);
  finding.start_clear = clear_of(f.edge, radius, robot.position);
  finding.goal_clear = clear_of(f.edge, radius, goal);
  // The rests on the edge and in the corner at its end.
  if (const auto rest = rest_on_edge(f, radius, goal)) finding.equilibria.push_back(*rest);
  const auto corner = rest_in_corner(f, radius, goal);
  if (corner && is_clear_of_all(all, f.obstacle, radius, corner->position)) finding.equilibria.push_back(*corner);
  finding.stall_possible = !finding.equilibria.empty();
  return finding;
}

// --- Enclosures ---

std::vector<Equilibrium> equilibria_of(const detail::Boundary& boundary, Vec2 goal) {
  std::vector<Equilibrium> found;
  for (double turn : boundary.facing_away(goal)) found.push_back(equilibrium_at(boundary, turn, goal));
  return found;
}

/// One robot among its enclosures.
class Examination {
 public:
  Examination(const Scenario& scenario, const std::vector<TrapPlace>& places, std::size_t robot, Vec2 goal)
      : scenario_(scenario), places_(places), robot_(robot), goal_(goal) {
    for (const TrapPlace& place : places) grown_.push_back({place.enclosure.shape, {}, radius_at(place)});
  }

  void run(std::vector<TrapFinding>& out) const {
    for (const TrapPlace& place : places_) out.push_back(alone(place));
    for (std::size_t i = 0; i < places_.size(); ++i)
      for (std::size_t j = i + 1; j < places_.size(); ++j)
        if (detail::boxes_meet(grown_[i], grown_[j])) add_pair(i, j, out);
  }

 private:
  const Robot& robot() const { return scenario_.robots[robot_]; }
  /// m, beside obstacles.
  double radius() const { return obstacle_radius(robot()); }

  /// m; how near the robot comes to the shape: a bare piece is kept off by the margin that an ellipse has inside.
  double radius_at(const TrapPlace& place) const {
    const bool tight = place.enclosure.grade == geometry::EnclosureGrade::tight;
    return radius() + (tight ? scenario_.margins.obstacle : 0.0);
  }

  TrapFinding about(const TrapPlace& place) const {
    TrapFinding f;
    f.robot = robot_;
    f.goal = goal_;
    f.place = place;
    f.start_clear = clear_of(place.enclosure.shape, radius(), robot().position);
    f.goal_clear = clear_of(place.enclosure.shape, radius(), goal_);
    return f;
  }

  /// Inside the grown enclosure by more than the robot may stay away from its goal.
  bool goal_is_shut_in(const ConvexShape& shape) const {
    return !clear_of(shape, radius(), goal_) &&
           detail::distance_to({shape, {}, radius()}, goal_) < -scenario_.arrival_tolerance;
  }

  TrapFinding alone(const TrapPlace& place) const {
    const ConvexShape& shape = place.enclosure.shape;
    TrapFinding f = about(place);
    f.stall_possible = stall_possible(shape, goal_) || goal_is_shut_in(shape);
    if (const Ellipse* e = std::get_if<Ellipse>(&shape)) f.margin = evolute_margin(*e, goal_);
    const detail::Boundary boundary(shape, radius());
    f.equilibria = equilibria_of(boundary, goal_);
    if (!f.goal_clear || !f.start_clear || !boundary.smooth()) return f;
    if (const auto hit = first_hit(boundary, robot().position, goal_))
      f.slide_time = slide(boundary, *hit, goal_, robot().max_speed);
    return f;
  }

  void add_pair(std::size_t i, std::size_t j, std::vector<TrapFinding>& out) const {
    const std::vector<detail::Crossing> vertices = detail::crossings(grown_[i], grown_[j]);
    if (vertices.empty()) return;
    TrapFinding f = about(places_[i]);
    const TrapFinding other = about(places_[j]);
    f.overlapping = places_[j];
    f.start_clear = f.start_clear && other.start_clear;
    f.goal_clear = f.goal_clear && other.goal_clear;
    for (const detail::Crossing& vertex : vertices) {
      const auto rest = detail::rest_at(vertex, goal_);
      if (!rest || rest->equilibrium.distance <= scenario_.arrival_tolerance) continue;
      if (is_covered(rest->equilibrium.position, i, j)) continue;
      f.equilibria.push_back(rest->equilibrium);
      f.margin = std::min(f.margin.value_or(0.0), -rest->depth);
    }
    f.stall_possible = !f.equilibria.empty();
    out.push_back(std::move(f));
  }

  /// Whether a third enclosure keeps the robot from getting there. One that it starts in gives way to its pieces.
  bool is_covered(Vec2 place, std::size_t i, std::size_t j) const {
    constexpr double kDeep = 1e-6;  // m, beyond rounding
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (k == i || k == j || clear_of(places_[k].enclosure.shape, radius(), place)) continue;
      if (clear_of(places_[k].enclosure.shape, radius(), robot().position) &&
          detail::distance_to(grown_[k], place) < -kDeep)
        return true;
    }
    return false;
  }

  const Scenario& scenario_;
  const std::vector<TrapPlace>& places_;
  std::size_t robot_;
  Vec2 goal_;
  std::vector<geometry::GrownShape> grown_;
};

/// What the enclosures of a robot are fitted for at the start: its first goal, or its slot at the leader's end.
Vec2 first_goal(const Scenario& scenario, const SimulationOptions& options, std::size_t robot) {
  if (!scenario.formation) return scenario.robots[robot].goals.front();
  return scenario.formation->leader.path.back() + detail::offsets_in_use(scenario, options)[robot];
}

/// The enclosures of one robot with their numbers, and of the method ivo-edge the facades they stand on.
std::vector<TrapPlace> places_of(const detail::StaticField& field, const detail::Scene& scene, Method method) {
  std::vector<TrapPlace> places;
  for (const geometry::Enclosure& e : field.enclosures()) places.push_back({e, places.size(), std::nullopt});
  if (method != Method::ivo_edge) return places;
  std::size_t number = 0;
  for (const geometry::ObstacleParts& parts : scene.parts())
    for (const geometry::Segment& facade : parts.facades) places.at(number++).facade = facade;
  return places;
}

/// Marks where the robots cannot be. Places are rounded: a disc smaller by `kRounded` has room at the rounded place
/// where the robot has room at the exact one.
void mark_out_of_reach(const Scenario& scenario, std::vector<TrapFinding>& findings) {
  constexpr double kRounded = 1e-3;  // of the radius: far above the rounding of a place
  detail::Reachability reach(detail::terrain_of(scenario), 0.0, false);
  for (TrapFinding& f : findings) {
    const Robot& robot = scenario.robots[f.robot];
    const double radius = (1.0 - kRounded) * obstacle_radius(robot);
    for (Equilibrium& e : f.equilibria)
      e.reachable = !reach.map().covers(robot.position) || !reach.map().covers(e.position) ||
                    reach.plan(radius).is_reachable(robot.position, e.position);
  }
}

}  // namespace

double Equilibrium::rate_at(double max_speed) const {
  return max_speed * (1.0 / radius_of_curvature - 1.0 / distance);
}

std::vector<Equilibrium> equilibria(const ConvexShape& shape, double robot_radius, Vec2 goal) {
  EXACTVO_REQUIRE(clear_of(shape, robot_radius, goal), geometry::to_string(shape));
  return equilibria_of(detail::Boundary(shape, robot_radius), goal);
}

bool stall_possible(const ConvexShape& shape, Vec2 goal) {
  if (const Ellipse* e = std::get_if<Ellipse>(&shape)) return !geometry::goal_outside_evolute(*e, goal);
  // The evolute of a circle is its centre.
  if (const geometry::Disc* d = std::get_if<geometry::Disc>(&shape)) return goal == d->center;
  return !detail::Boundary(shape, 0.0).flat_equilibria(goal).empty();
}

double evolute_margin(const Ellipse& ellipse, Vec2 goal) {
  const geometry::EllipseAxes axes = geometry::axes_of(ellipse);
  const Vec2 g = geometry::rotated(goal - ellipse.center, -axes.angle);
  const double focal = (axes.a - axes.b) * (axes.a + axes.b);
  if (!(focal > 0.0)) return geometry::kInfinity;
  const auto power = [](double x) { return std::cbrt(x * x); };
  return (power(axes.a * g.x) + power(axes.b * g.y)) / power(focal) - 1.0;
}

std::vector<TrapFinding> trap_test(const Scenario& scenario, const SimulationOptions& options) {
  EXACTVO_REQUIRE(validate(scenario).empty(), validate(scenario).front().pointer);
  detail::Scene scene(scenario, options);
  const detail::DecisionRules rules = detail::rules_of(scenario, options);
  const std::vector<Facade> facades = facades_of(scene);
  std::vector<TrapFinding> findings;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const Robot& robot = scenario.robots[i];
    const Vec2 goal = first_goal(scenario, options, i);
    const detail::StaticField field(scene, rules, obstacle_radius(robot), robot.position, goal,
                                    detail::HorizonRule::clamped);
    for (std::size_t k = 0; k < facades.size(); ++k) {
      findings.push_back(examine(facades[k], k, facades, robot, goal));
      findings.back().robot = i;
    }
    const std::vector<TrapPlace> places = places_of(field, scene, options.method);
    Examination(scenario, places, i, goal).run(findings);
  }
  mark_out_of_reach(scenario, findings);
  return findings;
}

}  // namespace exactvo::formation
