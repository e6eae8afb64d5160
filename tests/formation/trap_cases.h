// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random (wall, enclosure, goal) cases: the trap test against the simulation of what it predicts.

#include <cmath>

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

}  // namespace exactvo::test
