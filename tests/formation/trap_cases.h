// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random (wall, enclosure, goal) cases, and pairs of walls whose enclosures overlap: the trap test against the
/// simulation of what it predicts.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/stuck.h"
#include "exactvo/formation/trap.h"
#include "exactvo/geometry/predicates.h"
#include "support/seeded_random.h"

namespace exactvo::test {

using geometry::Vec2;

struct TrapCase {
  formation::Scenario scenario;  ///< one wall, one robot, started straight behind the likeliest trap
  formation::SimulationOptions options;
  geometry::Ellipse ellipse;
  Vec2 goal;
  double margin = 0.0;  ///< of the evolute condition
};

inline constexpr double kBand = 0.05;  ///< round equality: too slow to call
inline constexpr double kRobot = 0.5;  ///< m
inline constexpr double kSpeed = 3.0;  ///< m/s

inline geometry::GrownShape grown(const geometry::Ellipse& e) {
  return {e, {}, kRobot + 0.05};
}

/// A start on the normal of the equilibrium that is the deepest trap, a little aside of it; nothing where there is no
/// equilibrium at all.
inline bool place_start(TrapCase& c, double aside) {
  const formation::Equilibrium* worst = nullptr;
  const auto all = formation::equilibria(c.ellipse, kRobot, c.goal);
  for (const formation::Equilibrium& e : all)
    if (!worst || e.radius_of_curvature / e.distance > worst->radius_of_curvature / worst->distance) worst = &e;
  if (!worst) return false;
  formation::Robot robot;
  robot.id = "R1";
  robot.radius = kRobot;
  robot.max_speed = kSpeed;
  robot.goals = {c.goal};
  robot.position = worst->position + 1.0 * worst->normal + aside * geometry::perp(worst->normal);
  c.scenario.robots = {robot};
  // Long enough to slide off from where the tie-break leaves it, and on to the goal.
  constexpr double kWay = 60.0, kFoldings = 25.0;  // s; e-foldings
  c.scenario.time_limit = worst->stable ? kWay : kWay + kFoldings / worst->rate_at(kSpeed);
  return true;
}

/// Draws until the goal is clear, lies outside the band and has an equilibrium before it.
inline TrapCase random_trap_case(SeededRandom& random) {
  for (;;) {
    TrapCase c;
    const double half = random.uniform(1.0, 5.0);
    const Vec2 middle = random.in_box(3.0), along = half * random.direction();
    const geometry::Segment wall{middle - along, middle + along};
    c.options.method = formation::Method::ivo_edge;
    c.options.facade_minor_to_major = random.uniform(0.1, 0.95);
    c.scenario.name = "trap case";
    c.scenario.obstacles = {{"wall", geometry::Polyline{{wall.a, wall.b}}}};
    c.ellipse = geometry::facade_ellipse(wall, {c.options.facade_minor_to_major, 0.0, c.scenario.margins.obstacle});
    // Within the reach of the evolute's cusps along the minor axis and a little beyond.
    const geometry::EllipseAxes axes = geometry::axes_of(c.ellipse);
    const Vec2 minor = geometry::rotated({0.0, 1.0}, axes.angle), major = geometry::rotated({1.0, 0.0}, axes.angle);
    const double cusp = (axes.a * axes.a - axes.b * axes.b) / axes.b;
    c.goal = middle + random.uniform(0.0, 1.3 * cusp + 2.0) * minor + random.uniform(-0.8, 0.8) * axes.a * major;
    if (geometry::locate(grown(c.ellipse), c.goal) != geometry::Place::outside) continue;
    c.margin = formation::evolute_margin(c.ellipse, c.goal);
    if (std::fabs(c.margin) < kBand) continue;
    if (place_start(c, 0.01)) return c;
  }
}

inline bool arrives(const TrapCase& c) {
  const formation::Recording r = formation::simulate(c.scenario, c.options);
  return norm(r.steps.back().robots[0].position - c.goal) <= c.scenario.arrival_tolerance;
}

/// The test is right where it predicts what the simulation does.
inline bool agrees(const TrapCase& c) {
  return formation::stall_possible(c.ellipse, c.goal) == !arrives(c);
}

// --- Two enclosures that overlap ---

/// m; how far the place is from the nearest one at which a robot is said to rest.
inline double distance_to_rests(const std::vector<formation::TrapFinding>& findings, Vec2 place) {
  double least = std::numeric_limits<double>::infinity();
  for (const formation::TrapFinding& f : findings)
    for (const formation::Equilibrium& e : f.equilibria)
      if (e.stable) least = std::min(least, norm(e.position - place));
  return least;
}

inline formation::SimulationOptions pair_options() {
  formation::SimulationOptions options;
  options.method = formation::Method::ivo_edge;
  return options;
}

/// Whether start and goal are clear of every enclosure and the goal lies outside the band round each evolute.
inline bool is_clear_cut(const std::vector<formation::TrapFinding>& findings) {
  return std::all_of(findings.begin(), findings.end(), [](const formation::TrapFinding& f) {
    return f.start_clear && f.goal_clear && (f.overlapping || !f.margin || std::fabs(*f.margin) >= kBand);
  });
}

/// A robot and two facades whose grown ellipses overlap; nothing where the drawing gives none that can be judged.
inline std::optional<formation::Scenario> random_pair(SeededRandom& random) {
  formation::Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  formation::Robot robot;
  robot.id = "R1";
  robot.goals = {random.in_box(8.0)};
  robot.position = -1.0 * robot.goals[0] + random.in_box(3.0);
  s.robots = {robot};
  s.time_limit = 60.0;
  for (const char* id : {"a", "b"}) {
    const Vec2 middle = random.in_box(2.5), half = random.uniform(0.8, 3.0) * random.direction();
    s.obstacles.push_back({id, geometry::Polyline{{middle - half, middle + half}}});
  }
  if (!formation::validate(s).empty()) return std::nullopt;
  const auto findings = formation::trap_test(s, pair_options());
  if (findings.size() < 3 || !is_clear_cut(findings)) return std::nullopt;
  return s;
}

inline std::string report_of(const formation::Scenario& s, const formation::Recording& run) {
  const auto reports = formation::explain_stuck(s, run);
  return reports.empty() ? "arrived" : reports[0].text;
}

/// The case, losslessly: "start (x, y) goal (x, y) a (x, y)-(x, y) b (x, y)-(x, y)".
inline std::string words_of(const formation::Scenario& s) {
  const auto point = [](Vec2 p) {
    char text[80];
    std::snprintf(text, sizeof text, "(%a, %a)", p.x, p.y);
    return std::string(text);
  };
  std::string words = "start " + point(s.robots[0].position) + " goal " + point(s.robots[0].goals[0]);
  for (const formation::SceneObstacle& o : s.obstacles) {
    const std::vector<Vec2> ends = geometry::vertices_of(o.shape);
    words += " " + o.id + " " + point(ends.front()) + "-" + point(ends.back());
  }
  return words;
}

/// What a run showed, beside what was said of it.
struct PairOutcome {
  bool arrived = false;
  bool foretold = false;  ///< it rests where something was said to be
  bool between = false;   ///< at a vertex
  std::string words;
  bool agrees() const { return arrived || foretold; }
};

inline PairOutcome outcome_of(const formation::Scenario& s) {
  constexpr double kSame = 0.1;  // m
  const auto findings = formation::trap_test(s, pair_options());
  const formation::Recording run = formation::simulate(s, pair_options());
  const Vec2 end = run.steps.back().robots[0].position;
  PairOutcome o;
  o.arrived = norm(end - s.robots[0].goals[0]) <= s.arrival_tolerance;
  o.foretold = distance_to_rests(findings, end) < kSame;
  o.between = findings.back().overlapping && distance_to_rests({findings.back()}, end) < kSame;
  o.words = report_of(s, run);
  return o;
}

/// A robot that starts 5 cm before a vertex at which it is said to rest.
struct VertexOutcome {
  double distance = 0.0;  ///< m, from the vertex to where it ended
  std::string words;
};

/// Every vertex that the test says stops the robot, except those where the way to the goal runs along the edge of the
/// cone of rest: there it is as likely to slide out.
inline std::vector<VertexOutcome> vertex_outcomes(formation::Scenario s) {
  std::vector<VertexOutcome> out;
  for (const formation::TrapFinding& f : formation::trap_test(s, pair_options())) {
    if (!f.overlapping || f.equilibria.size() != 1 || *f.margin > -kBand) continue;
    const formation::Equilibrium& e = f.equilibria[0];
    s.robots[0].position = e.position + 0.05 * e.normal;
    if (!formation::validate(s).empty() || !is_clear_cut(formation::trap_test(s, pair_options()))) continue;
    const formation::Recording run = formation::simulate(s, pair_options());
    out.push_back({norm(run.steps.back().robots[0].position - e.position), report_of(s, run)});
  }
  return out;
}

}  // namespace exactvo::test
