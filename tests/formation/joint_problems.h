// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random problems of joint plans, and what every sequence of moves must keep, asked in rationals.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "liveness/joint_search.h"
#include "liveness/plan.h"
#include "support/seeded_random.h"

namespace exactvo::formation::detail {

using Rational = mpq_class;
using test::SeededRandom;

struct ExactPoint {
  Rational x, y;
};
inline ExactPoint exactly(Vec2 p) {
  return {Rational(p.x), Rational(p.y)};
}
inline ExactPoint operator-(const ExactPoint& a, const ExactPoint& b) {
  return {a.x - b.x, a.y - b.y};
}
inline Rational dot(const ExactPoint& a, const ExactPoint& b) {
  return a.x * b.x + a.y * b.y;
}

inline Rational exact_squared_distance(Vec2 point, Vec2 from, Vec2 to) {
  const ExactPoint p = exactly(point), a = exactly(from), d = exactly(to) - a;
  const Rational length2 = dot(d, d);
  Rational t = sgn(length2) > 0 ? Rational(dot(p - a, d) / length2) : Rational(0);
  t = std::max(Rational(0), std::min(Rational(1), t));
  const ExactPoint gap = p - ExactPoint{a.x + t * d.x, a.y + t * d.y};
  return dot(gap, gap);
}

/// A box with a wall in it that has a gap, as segments that discs keep away from.
class Walls : public FreeSpace {
 public:
  explicit Walls(std::vector<Segment> walls) : walls_(std::move(walls)) {}
  bool is_open() const override { return walls_.empty(); }
  double clearance(Vec2 place, double enough) const override {
    double least = enough * enough;
    for (const Segment& w : walls_) least = std::min(least, squared_distance(place, w.a, w.b));
    return std::sqrt(least);
  }
  bool is_clear(Vec2 from, Vec2 to, double least) const override {
    return std::all_of(walls_.begin(), walls_.end(), [&](const Segment& w) {
      return squared_distance(Segment{from, to}, w) >= least * least;
    });
  }
  const std::vector<Segment>& all() const { return walls_; }

 private:
  std::vector<Segment> walls_;
};

inline Walls two_rooms(double gap) {
  const Vec2 a{-6, -4}, b{6, -4}, c{6, 4}, d{-6, 4};
  return Walls({{a, b}, {b, c}, {c, d}, {d, a}, {{0, -4}, {0, -0.5 * gap}}, {{0, 0.5 * gap}, {0, 4}}});
}

/// Discs of some sizes (m, 0.5 at most) at random free places, and other such places for goals.
struct Problem {
  Roadmap map;
  JointProblem joint;

  Problem(const Walls& walls, std::size_t count, SeededRandom& random,
          const std::vector<double>& sizes = {0.5, 0.5, 0.4})
      : map(walls, {{-5.4, -3.4}, {5.4, 3.4}}, 0.5) {
    joint.map = &map;
    for (std::size_t i = 0; i < count; ++i) joint.radii.push_back(sizes[i % sizes.size()]);
    joint.starts = places(walls, random);
    joint.goals = places(walls, random);
  }

  std::vector<PlaceNumber> places(const Walls& walls, SeededRandom& random) {
    std::vector<PlaceNumber> chosen;
    while (chosen.size() < joint.radii.size()) {
      const Vec2 p{random.uniform(-5.4, 5.4), random.uniform(-3.4, 3.4)};
      const double radius = joint.radii[chosen.size()];
      bool is_free = walls.clearance(p, 1.0) >= 0.55;
      for (std::size_t j = 0; j < chosen.size(); ++j)
        is_free = is_free && norm(map.place(chosen[j]) - p) > 1.02 * (radius + joint.radii[j]);
      if (is_free) chosen.push_back(map.attach(p, radius));
    }
    return chosen;
  }
};

/// Single moves in sequence: the others stand where they are then. In rationals.
inline void expect_apart(const std::vector<Vec2>& starts, const std::vector<double>& radii,
                         const std::vector<PlannedMove>& moves, const Walls& walls) {
  std::vector<Vec2> at = starts;
  for (const PlannedMove& m : moves) {
    ASSERT_EQ(at[m.robot], m.from) << "Property 2";
    for (std::size_t j = 0; j < at.size(); ++j) {
      if (j == m.robot) continue;
      const Rational reach = Rational(radii[m.robot]) + Rational(radii[j]);
      ASSERT_GE(exact_squared_distance(at[j], m.from, m.to), reach * reach) << "Property 1";
    }
    for (const Segment& w : walls.all())
      for (const Vec2 end : {w.a, w.b})
        ASSERT_GE(exact_squared_distance(end, m.from, m.to), Rational(radii[m.robot]) * Rational(radii[m.robot]));
    at[m.robot] = m.to;
  }
}

inline std::vector<Vec2> positions(const Roadmap& map, const std::vector<PlaceNumber>& places) {
  std::vector<Vec2> all;
  for (const PlaceNumber p : places) all.push_back(map.place(p));
  return all;
}

/// All of a problem and its moves without loss, for a message.
inline std::string described(const Problem& p, const std::vector<JointMove>& moves) {
  std::ostringstream text;
  text << std::hexfloat;
  for (std::size_t i = 0; i < p.joint.radii.size(); ++i) {
    const Vec2 from = p.map.place(p.joint.starts[i]), to = p.map.place(p.joint.goals[i]);
    text << "robot " << i << " radius " << p.joint.radii[i] << " from " << from.x << " " << from.y << " to " << to.x
         << " " << to.y << "\n";
  }
  for (const JointMove& m : moves)
    text << "move " << m.robot << " to " << p.map.place(m.to).x << " " << p.map.place(m.to).y << "\n";
  return text.str();
}

/// Moves along the map with the places that they lead to.
inline std::vector<PlannedMove> on_map(const Roadmap& map, const std::vector<JointMove>& moves) {
  std::vector<PlannedMove> all;
  for (const JointMove& m : moves) all.push_back({m.robot, map.place(m.from), map.place(m.to)});
  return all;
}

}  // namespace exactvo::formation::detail
