// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/trap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "boundary.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/orca_obstacle.h"
#include "goals.h"
#include "remedies.h"
#include "static_field.h"

namespace exactvo::formation {
namespace {

using geometry::ConvexShape;
using geometry::dot;
using geometry::Ellipse;
using geometry::norm;

bool clear_of(const ConvexShape& shape, double radius, Vec2 point) {
  return geometry::locate(geometry::GrownShape{shape, {}, radius}, point) == geometry::Place::outside;
}

/// Whether the goal lies strictly behind a flat edge with its foot within it.
bool behind_a_flat_edge(const std::vector<Vec2>& vertices, Vec2 goal) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 a = vertices[i], along = vertices[(i + 1) % vertices.size()] - a;
    const double foot = dot(goal - a, along);
    if (cross(along, goal - a) > 0.0 && foot >= 0.0 && foot <= squared_norm(along)) return true;
  }
  return false;
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
  double nearest = std::numeric_limits<double>::infinity();
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

std::vector<Facade> facades_of(const Scenario& scenario) {
  std::vector<Facade> facades;
  for (std::size_t k = 0; k < scenario.obstacles.size(); ++k) {
    for (const vo::OrcaChain& chain : vo::orca_chains(scenario.obstacles[k].shape)) {
      const std::size_t n = chain.vertices.size();
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t end = (i + 1) % n;
        facades.push_back({k, {chain.vertices[i], chain.vertices[end]}, {}});
        if (!chain.convex[end]) facades.back().beyond = chain.vertices[(end + 1) % n];
      }
    }
  }
  return facades;
}

Vec2 free_side(Vec2 along) {
  return -geometry::perp(geometry::normalized(along));
}

/// A robot rests over the goal's foot, also where the goal lies in front of the edge by less than the robot's radius.
std::optional<Equilibrium> rest_on_edge(const Facade& f, double radius, Vec2 goal) {
  const Vec2 along = f.edge.b - f.edge.a, out = free_side(along);
  const double foot = dot(goal - f.edge.a, along), depth = -dot(goal - f.edge.a, out);
  const double distance = depth + radius;
  if (!(distance > 0.0) || foot < 0.0 || foot > squared_norm(along)) return std::nullopt;
  return Equilibrium{goal + distance * out, out, std::numeric_limits<double>::infinity(), distance, true};
}

/// Whether the point's foot lies on the edge, ends included.
bool is_over(const geometry::Segment& edge, Vec2 point) {
  const Vec2 along = edge.b - edge.a;
  const double foot = dot(point - edge.a, along);
  return foot >= 0.0 && foot <= squared_norm(along);
}

/// Where a robot touches an edge and the next one, and both with its rim. Nothing in a slit, nor past an edge's end.
std::optional<Vec2> touching_both(const geometry::Segment& edge, const geometry::Segment& next, double radius) {
  const Vec2 out = free_side(edge.b - edge.a), out_next = free_side(next.b - next.a);
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
  const Vec2 out = free_side(f.edge.b - f.edge.a), next = free_side(*f.beyond - f.edge.b);
  const double turn = cross(out, next);  // < 0: the chain turns right
  if (!(turn < 0.0)) return std::nullopt;
  const auto at = touching_both(f.edge, {f.edge.b, *f.beyond}, radius);
  if (!at) return std::nullopt;
  const Vec2 way = goal - *at;
  if (way == Vec2{} || cross(way, next) / turn > 0.0 || cross(out, way) / turn > 0.0) return std::nullopt;
  return Equilibrium{*at, geometry::normalized(out + next), std::numeric_limits<double>::infinity(), norm(way), true};
}

/// The rests on the edge and in the corner at its end.
std::vector<Equilibrium> rests_at(const Facade& f, const std::vector<Facade>& all, double radius, Vec2 goal) {
  std::vector<Equilibrium> rests;
  if (const auto rest = rest_on_edge(f, radius, goal)) rests.push_back(*rest);
  const auto corner = rest_in_corner(f, radius, goal);
  if (corner && is_clear_of_all(all, f.obstacle, radius, corner->position)) rests.push_back(*corner);
  return rests;
}

TrapFinding examine(const Facade& f, const std::vector<Facade>& all, const Robot& robot, Vec2 goal) {
  TrapFinding finding;
  finding.goal = goal;
  finding.enclosure = {f.edge, {f.obstacle}, geometry::EnclosureGrade::tight};
  finding.start_clear = clear_of(f.edge, robot.radius, robot.position);
  finding.goal_clear = clear_of(f.edge, robot.radius, goal);
  finding.equilibria = rests_at(f, all, robot.radius, goal);
  finding.stall_possible = !finding.equilibria.empty();
  return finding;
}

// --- Enclosures ---

TrapFinding examine(const geometry::Enclosure& enclosure, const Robot& robot, Vec2 goal) {
  TrapFinding f;
  f.goal = goal;
  f.enclosure = enclosure;
  f.start_clear = clear_of(enclosure.shape, robot.radius, robot.position);
  f.goal_clear = clear_of(enclosure.shape, robot.radius, goal);
  f.stall_possible = stall_possible(enclosure.shape, goal);
  if (const Ellipse* e = std::get_if<Ellipse>(&enclosure.shape)) f.margin = evolute_margin(*e, goal);
  if (!f.goal_clear) return f;
  f.equilibria = equilibria(enclosure.shape, robot.radius, goal);
  const detail::Boundary boundary(enclosure.shape, robot.radius);
  if (!f.start_clear || !boundary.smooth()) return f;
  if (const auto hit = first_hit(boundary, robot.position, goal))
    f.slide_time = slide(boundary, *hit, goal, robot.max_speed);
  return f;
}

}  // namespace

double Equilibrium::rate_at(double max_speed) const {
  return max_speed * (1.0 / radius_of_curvature - 1.0 / distance);
}

std::vector<Equilibrium> equilibria(const ConvexShape& shape, double robot_radius, Vec2 goal) {
  EXACTVO_REQUIRE(clear_of(shape, robot_radius, goal), geometry::to_string(shape));
  const detail::Boundary boundary(shape, robot_radius);
  std::vector<Equilibrium> found;
  for (double turn : boundary.facing_away(goal)) found.push_back(equilibrium_at(boundary, turn, goal));
  return found;
}

double escape_time(const Equilibrium& e, double max_speed, double s0, double s1) {
  EXACTVO_REQUIRE(s0 > 0.0 && s0 <= s1, std::to_string(s0) + ", " + std::to_string(s1));
  EXACTVO_REQUIRE(e.rate_at(max_speed) > 0.0, std::to_string(e.rate_at(max_speed)));
  return std::log(s1 / s0) / e.rate_at(max_speed);
}

bool stall_possible(const ConvexShape& shape, Vec2 goal) {
  if (const Ellipse* e = std::get_if<Ellipse>(&shape)) return !geometry::goal_outside_evolute(*e, goal);
  // The evolute of a circle is its centre.
  if (const geometry::Disc* d = std::get_if<geometry::Disc>(&shape)) return goal == d->center;
  if (const geometry::Segment* s = std::get_if<geometry::Segment>(&shape))
    return behind_a_flat_edge({s->a, s->b}, goal);
  return behind_a_flat_edge(std::get<geometry::ConvexPolygon>(shape).vertices, goal);
}

double evolute_margin(const Ellipse& ellipse, Vec2 goal) {
  const geometry::EllipseAxes axes = geometry::axes_of(ellipse);
  const Vec2 g = geometry::rotated(goal - ellipse.center, -axes.angle);
  const double focal = (axes.a - axes.b) * (axes.a + axes.b);
  if (!(focal > 0.0)) return std::numeric_limits<double>::infinity();
  const auto power = [](double x) { return std::cbrt(x * x); };
  return (power(axes.a * g.x) + power(axes.b * g.y)) / power(focal) - 1.0;
}

std::vector<TrapFinding> trap_test(const Scenario& scenario, const SimulationOptions& options) {
  EXACTVO_REQUIRE(validate(scenario).empty(), validate(scenario).front().pointer);
  detail::Scene scene(scenario, options);
  const std::vector<Facade> facades = options.method == Method::orca ? facades_of(scenario) : std::vector<Facade>{};
  std::vector<TrapFinding> findings;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const Robot& robot = scenario.robots[i];
    const Vec2 goal = detail::first_goal(scenario, options, i);
    const detail::StaticField field(scene, scenario, options, robot.radius, robot.position, goal,
                                    detail::HorizonRule::clamped);
    for (const Facade& facade : facades) {
      findings.push_back(examine(facade, facades, robot, goal));
      findings.back().robot = i;
    }
    for (const geometry::Enclosure& enclosure : field.enclosures()) {
      findings.push_back(examine(enclosure, robot, goal));
      findings.back().robot = i;
    }
  }
  return findings;
}

}  // namespace exactvo::formation
