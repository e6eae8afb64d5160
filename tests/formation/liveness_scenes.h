// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Scenes in which robots are in each other's way (docs/guide/liveness.md). Radius 0.5 m, 1.5 m/s; widths in metres,
/// which are diameters.

#include <cmath>
#include <string>

#include "exactvo/formation/scenario.h"
#include "support/seeded_random.h"

namespace exactvo::formation::test_scenes {

using geometry::Vec2;

constexpr double kTurn = 6.283185307179586;

inline Robot robot(const std::string& id, Vec2 from, Vec2 to) {
  Robot r;
  r.id = id;
  r.position = from;
  r.max_speed = 1.5;
  r.goals = {to};
  return r;
}

inline void add_robot(Scenario& s, Vec2 from, Vec2 to) {
  s.robots.push_back(robot("R" + std::to_string(s.robots.size() + 1), from, to));
}

inline void add_wall(Scenario& s, std::vector<Vec2> line) {
  s.obstacles.push_back({"wall" + std::to_string(s.obstacles.size() + 1), geometry::Polyline{std::move(line)}});
}

/// Every robot crosses a circle to the opposite place, exactly symmetric.
inline Scenario circle(int count, double gap = 3.0) {
  Scenario s;
  s.name = "circle";
  const double radius = std::max(4.0, gap * count / kTurn);
  for (int i = 0; i < count; ++i) {
    const Vec2 p = radius * geometry::rotated({1.0, 0.0}, kTurn * i / count);
    add_robot(s, p, -p);
  }
  return s;
}

/// Half of them from each end of a street that is open at both.
inline Scenario street(int count, double width) {
  Scenario s;
  s.name = "street";
  add_wall(s, {{-40.0, 0.5 * width}, {40.0, 0.5 * width}});
  add_wall(s, {{-40.0, -0.5 * width}, {40.0, -0.5 * width}});
  const int rows = std::max(1, static_cast<int>((width - 0.2) / 1.3));
  for (int k = 0; k < count / 2; ++k) {
    const double y = rows == 1 ? 0.0 : -0.5 * width + 0.6 + (k % rows) * (width - 1.2) / (rows - 1);
    const double x = -8.0 - 1.5 * (k / rows);
    add_robot(s, {x, y}, {-x, y});
    add_robot(s, {-x, -y}, {x, -y});
  }
  return s;
}

/// Places in a box, 1.2 m from each other and clear of a wall at x = 0.
inline std::vector<Vec2> scattered(std::size_t count, Vec2 low, Vec2 high, double apart, test::SeededRandom& random) {
  std::vector<Vec2> places;
  for (int tries = 0; places.size() < count && tries < 1000000; ++tries) {
    const Vec2 p{random.uniform(low.x, high.x), random.uniform(low.y, high.y)};
    bool is_free = true;
    for (const Vec2 q : places) is_free = is_free && norm(p - q) >= apart;
    if (is_free) places.push_back(p);
  }
  return places;
}

inline void add_box(Scenario& s, double x, double y) {
  add_wall(s, {{-x, -y}, {x, -y}, {x, y}, {-x, y}, {-x, -y}});
}

inline void exchange(Scenario& s, int count, Vec2 low, Vec2 high, test::SeededRandom& random) {
  const auto half = static_cast<std::size_t>(count / 2);
  const auto left = [&] { return scattered(half, {-high.x, low.y}, {-low.x, high.y}, 1.25, random); };
  const auto right = [&] { return scattered(half, low, high, 1.25, random); };
  const std::vector<Vec2> a = left(), b = right(), c = right(), d = left();
  for (std::size_t k = 0; k < half && k < std::min({a.size(), b.size(), c.size(), d.size()}); ++k) {
    add_robot(s, a[k], c[k]);
    add_robot(s, b[k], d[k]);
  }
}

/// Two rooms with a door between, which change robots.
inline Scenario door(int count, double width, test::SeededRandom& random) {
  Scenario s;
  s.name = "door";
  const double side = std::max(10.0, 2.2 * std::sqrt(0.5 * count) + 6.0);
  add_box(s, side, 0.5 * side);
  add_wall(s, {{0.0, -0.5 * side}, {0.0, -0.5 * width}});
  add_wall(s, {{0.0, 0.5 * width}, {0.0, 0.5 * side}});
  exchange(s, count, {1.5, -0.5 * side + 1.0}, {side - 1.0, 0.5 * side - 1.0}, random);
  return s;
}

/// Two rooms with a corridor 6 m long between.
inline Scenario rooms(int count, double width, test::SeededRandom& random) {
  Scenario s;
  s.name = "rooms";
  const double side = 9.0 + 0.25 * count;
  add_box(s, side, 5.0);
  add_wall(s, {{-3.0, -5.0}, {-3.0, -0.5 * width}, {3.0, -0.5 * width}, {3.0, -5.0}});
  add_wall(s, {{-3.0, 5.0}, {-3.0, 0.5 * width}, {3.0, 0.5 * width}, {3.0, 5.0}});
  exchange(s, count, {3.7, -4.3}, {side - 0.7, 4.3}, random);
  return s;
}

/// A closed box with robots on that share of its floor, in per cent.
inline Scenario crowded_box(int count, double percent, test::SeededRandom& random) {
  Scenario s;
  s.name = "box";
  const double half = 0.5 * std::sqrt(count * 0.25 * 0.5 * kTurn / (percent / 100.0));
  add_box(s, half, half);
  const Vec2 corner{half - 0.56, half - 0.56};
  std::vector<Vec2> from, to;
  if (percent <= 41.0) {
    from = scattered(static_cast<std::size_t>(count), -corner, corner, 1.08, random);
    to = scattered(static_cast<std::size_t>(count), -corner, corner, 1.08, random);
  } else {
    const int rows = static_cast<int>((2.0 * half - 1.04) / 1.06) + 1;
    const double pitch = (2.0 * half - 1.04) / (rows - 1);
    for (std::vector<Vec2>* places : {&from, &to}) {
      for (int k = 0; k < rows * rows; ++k)
        places->push_back(Vec2{0.52 - half + (k % rows) * pitch, 0.52 - half + (k / rows) * pitch});
      for (std::size_t k = places->size(); k > 1; --k)
        std::swap((*places)[k - 1], (*places)[static_cast<std::size_t>(random.integer(0, static_cast<int>(k) - 1))]);
    }
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(count) && k < std::min(from.size(), to.size()); ++k)
    add_robot(s, from[k], to[k]);
  return s;
}

/// The scenario "Cross" of navground's tutorial "Deadlocks and collisions": robots go to and fro between two targets 4
/// m apart, four kinds of ends.
inline Scenario cross(double margin, test::SeededRandom& random) {
  constexpr double kRadius = 0.08, kFastest = 0.166, kTarget = 2.0, kTargetMargin = 0.1, kAgentMargin = 0.1;
  Scenario s;
  s.name = "cross";
  s.time_step = 0.1;
  s.time_limit = 300.0;
  s.arrival_tolerance = 0.5;
  s.margins.robot = margin;
  s.neighbour_distance = 5.0;
  const Vec2 corner{kTarget - kTargetMargin, kTarget - kTargetMargin};
  const std::vector<Vec2> places = scattered(20, -corner, corner, 2.0 * kRadius + kAgentMargin + margin, random);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec2 target = (i / 2) % 2 == 0 ? Vec2{kTarget, 0.0} : Vec2{0.0, kTarget};
    add_robot(s, places[i], i % 2 == 0 ? target : -target);
    Robot& r = s.robots.back();
    r.radius = kRadius;
    r.max_speed = kFastest;
    constexpr int kLegs = 20;  // more than anybody drives
    for (int leg = 1; leg < kLegs; ++leg) r.goals.push_back(-r.goals.back());
  }
  return s;
}

/// As navground draws it for each run.
inline Scenario cross_with_any_margin(test::SeededRandom& random) {
  const double margin = random.uniform(0.0, 0.25);
  return cross(margin, random);
}

/// Two head-on in a corridor 1.5 m wide with a niche.
inline Scenario siding() {
  Scenario s;
  s.name = "siding";
  add_wall(s, {{-12.0, 0.0},
               {12.0, 0.0},
               {12.0, 1.5},
               {5.7, 1.5},
               {5.7, 2.9},
               {4.3, 2.9},
               {4.3, 1.5},
               {-12.0, 1.5},
               {-12.0, 0.0}});
  add_robot(s, {-10.0, 0.75}, {10.0, 0.75});
  add_robot(s, {10.0, 0.75}, {-10.0, 0.75});
  return s;
}

/// The same as a formation: the leader rests at the origin, and goals are slots.
inline Scenario at_slots(Scenario s, double k3 = 37.5) {
  const std::size_t n = s.robots.size();
  FormationSpec& formation = s.formation.emplace();
  formation.leader.path = {{0.0, 0.0}};
  formation.recentre = false;
  formation.gains = {0.25, 0.45, k3, 1.5};
  formation.catch_up_speed = 1.5;
  formation.topology.adjacency.assign(n, std::vector<double>(n, 1.0));
  for (std::size_t i = 0; i < n; ++i) formation.topology.adjacency[i][i] = 0.0;
  formation.topology.pinning.assign(n, 1.0);
  for (Robot& r : s.robots) {
    formation.offsets.push_back(r.goals.front());
    r.goals.clear();
  }
  s.time_step = 0.02;
  return s;
}

}  // namespace exactvo::formation::test_scenes
