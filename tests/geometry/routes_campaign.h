// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Routes at critical radii: for each world the largest double at which the goal is reached, found by bisection, radii
/// beside it, and radii of whole and half metres, where gaps between integer points are exactly two radii wide. Every
/// answer must be the right one, and be accepted by the checker.

#include <string>
#include <vector>

#include "exactvo/geometry/route_certificate.h"
#include "route_case.h"

namespace exactvo::test {

/// Ratio of a route's length to its lower bound: more than ever seen in these worlds, and far from the way of a search
/// that was given up or of a string that could not be proven.
constexpr double kMostOverBound = 1.25;

/// m; no disc of it fits anywhere: fences are 24 m wide at the most.
constexpr double kLargestRadius = 13.0;

struct RouteCampaign {
  std::size_t cases = 0, routes = 0, chains = 0, blocked = 0;
  std::size_t unproven = 0;  ///< `RouteNotProven`: there is a route, and none was made
  double worst_ratio = 1.0;  ///< of a route's length to its lower bound
  double sum_of_ratios = 0.0;
  std::string worst;  ///< the case of it
  std::vector<std::string> failures;
};

inline void check_radius(const RouteField& f, const geometry::RouteMap& map, double radius, int expected,
                         RouteCampaign& out) {
  ++out.cases;
  const auto fail = [&](const std::string& why) {
    out.failures.push_back(why + "\n" + corpus_line(RouteCase{f, radius}));
  };
  try {
    const geometry::RoutePlan plan(map, radius);
    const geometry::RouteAnswer answer = plan.query(f.start, f.goal);
    const std::string wrong = geometry::check(f.obstacles, {radius, f.start, f.goal}, answer);
    if (!wrong.empty()) fail("refused: " + wrong);
    const bool reached = std::holds_alternative<geometry::Route>(answer);
    if (reached != plan.is_reachable(f.start, f.goal)) fail("query and is_reachable differ");
    if (expected >= 0 && reached != (expected == 1)) fail(expected == 1 ? "not reached" : "reached");
    if (const auto* route = std::get_if<geometry::Route>(&answer)) {
      ++out.routes;
      if (route->length > kMostOverBound * route->lower_bound && route->lower_bound > 0.0)
        fail("longer than " + std::to_string(kMostOverBound) + " of its lower bound");
      out.sum_of_ratios += route->lower_bound > 0.0 ? route->length / route->lower_bound : 1.0;
      if (route->lower_bound > 0.0 && route->length / route->lower_bound > out.worst_ratio) {
        out.worst_ratio = route->length / route->lower_bound;
        out.worst = std::to_string(route->length) + " " + corpus_line(RouteCase{f, radius});
      }
    } else if (std::holds_alternative<geometry::Separated>(answer)) {
      ++out.chains;
    } else {
      ++out.blocked;
    }
  } catch (const geometry::RouteNotProven& e) {
    ++out.unproven;
    fail(e.what());
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

/// Other ends, where some are soon found that a gate keeps apart: at ends drawn anywhere it is often what they keep
/// from the obstacles that decides. Ends on halves stay on halves, others look for room round them.
inline void choose_ends_apart(RouteField& f, const geometry::RouteMap& map, SeededRandom& random) {
  constexpr int kTries = 20, kMoves = 25;
  const std::vector<Vec2> corners = vertices_of(f.obstacles.front());  // the fence
  const auto by_x = [](Vec2 a, Vec2 b) { return a.x < b.x; };
  const auto by_y = [](Vec2 a, Vec2 b) { return a.y < b.y; };
  const auto [left, right] = std::minmax_element(corners.begin(), corners.end(), by_x);
  const auto [low, high] = std::minmax_element(corners.begin(), corners.end(), by_y);
  const auto room_at = [&](Vec2 p) { return map.widest_radius(p, p); };
  const auto on_half = [](Vec2 p) { return 0.5 * Vec2{std::round(2.0 * p.x), std::round(2.0 * p.y)}; };
  const bool on_halves = f.start == on_half(f.start);
  const auto place = [&] {
    Vec2 p{random.uniform(left->x, right->x), random.uniform(low->y, high->y)};
    if (on_halves) return on_half(p);
    double step = 1.0;  // m
    for (int k = 0; k < kMoves; ++k, step *= 0.8) {
      const Vec2 q = p + step * random.direction();
      if (room_at(q) > room_at(p)) p = q;
    }
    return p;
  };
  for (int k = 0; k < kTries; ++k) {
    const Vec2 start = place(), goal = place();
    const double widest = map.widest_radius(start, goal);
    if (!(widest > 0.0) || room_at(start) <= widest || room_at(goal) <= widest) continue;
    f.start = start;
    f.goal = goal;
    return;
  }
}

/// Radii at which gaps between integer points are passed without a hair to spare, and the doubles beside them.
inline void check_whole_radii(const RouteField& f, const geometry::RouteMap& map, double widest, SeededRandom& random,
                              RouteCampaign& out) {
  for (int k = 0; k < 2; ++k) {
    const double radius = 0.5 * random.integer(1, 6);
    for (const double r : {std::nextafter(radius, 0.0), radius, std::nextafter(radius, kLargestRadius)})
      check_radius(f, map, r, r <= widest ? 1 : 0, out);
  }
}

inline void check_field(RouteField f, SeededRandom& random, RouteCampaign& out) {
  const geometry::RouteMap map(f.obstacles);
  if (random.integer(0, 3)) choose_ends_apart(f, map, random);
  const auto reaches = [&](double r) { return geometry::RoutePlan(map, r).is_reachable(f.start, f.goal); };
  constexpr double kSmall = 1e-3;
  const double widest = map.widest_radius(f.start, f.goal);
  const auto fail_widest = [&](double found) {
    out.failures.push_back("the widest radius is " + geometry::hex_text(found) + ", not " + geometry::hex_text(widest) +
                           "\n" + corpus_line(RouteCase{f, found}));
  };
  if (!reaches(kSmall)) {
    if (widest >= kSmall) fail_widest(kSmall);
    check_radius(f, map, kSmall, 0, out);
    check_radius(f, map, random.uniform(0.01, 1.0), 0, out);
    return;
  }
  double low = kSmall, high = kLargestRadius;
  while (std::nextafter(low, high) < high) (reaches(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  if (low != widest) fail_widest(low);
  check_radius(f, map, low, 1, out);
  check_radius(f, map, high, 0, out);
  for (const double size : {1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.5}) {
    check_radius(f, map, std::min(low, low * (1.0 - random.uniform(0.0, size))), 1, out);
    check_radius(f, map, std::max(high, high * (1.0 + random.uniform(0.0, size))), 0, out);
  }
  check_whole_radii(f, map, low, random, out);
}

}  // namespace exactvo::test
