// SPDX-License-Identifier: GPL-3.0-or-later
//
// The heading of a twist turns from e towards the velocity u of the reference point p, by less than a half turn and
// never back. While it is between unit vectors a and b, a disc at d behind p is within |d| max |a - m|, |b - m| of p +
// s u - d m, m between them. Turns are halved until the disc is proven clear on this way, or it moves by less than
// kFinest.
#include "recordings/audit_points.h"

#include <algorithm>
#include <cmath>

namespace exactvo::datasets {
namespace {

using exact::exactly;
using exact::Point;
using exact::Rational;
using exact::Verdict;
using geometry::Vec2;

constexpr double kFinest = 1e-4;     // m
constexpr double kUnit = 0x1p-40;    // by which lengths of unit vectors may be off
constexpr double kBeyond = 0x1p-45;  // a last vector is turned beyond u by this

bool is_unit(const Point& a) {
  return abs(exact::dot(a, a) - 1) <= Rational(kUnit) / 4;
}

/// A disc behind the reference point.
struct Link {
  const RationalObstacle& obstacle;
  Point at, way;
  Rational behind, reach;

  /// Judges a turn from `a` to `b`, by a right angle at most, to the left (`side` 1) or right (-1).
  Verdict over(Vec2 a, Vec2 b, int side) const {
    const Vec2 middle = geometry::normalized(a + b);
    const double half = (1.0 + 1e-12) * std::max(norm(a - middle), norm(b - middle));
    const Point from = exactly(a), m = exactly(middle), to = exactly(b);
    const auto is_turn = [&](const Point& p, const Point& q) {
      return side * sgn(exact::cross(p, q)) >= 0 && sgn(exact::dot(p, q)) > 0;
    };
    const auto is_near = [&](const Point& p) {
      const Point off = p - m;
      return exact::dot(off, off) <= Rational(half) * Rational(half);
    };
    if (!is_unit(from) || !is_unit(m) || !is_unit(to) || !is_turn(from, m) || !is_turn(m, to) || !is_near(from) ||
        !is_near(to))
      return Verdict::unknown;
    const Rational moves = abs(behind) * (Rational(half) + 2 * Rational(kUnit));
    const Point start = at - behind * m;
    const exact::Chord chord{{start, start + way}, moves};
    std::vector<NearEdge> edges;
    for (const std::size_t edge : obstacle.near(box_of(chord), exact::at_least(reach))) edges.push_back({edge, reach});
    const Verdict whole = against(chord, obstacle, edges, reach);
    if (whole != Verdict::unknown || moves <= Rational(kFinest)) return whole;
    const Verdict first = over(a, middle, side);
    return first == Verdict::clear ? over(middle, b, side) : first;
  }
};

}  // namespace

double obstacle_reach_of(const formation::Robot& robot) {
  constexpr double kRounding = 1.0 + 1e-12;
  double reach = formation::obstacle_radius(robot);
  if (robot.drive)
    for (const geometry::Disc& link : robot.drive->chain)
      reach = std::max(reach, kRounding * (std::fabs(robot.drive->reference - link.center.x) + link.radius));
  return reach;
}

Verdict chain_against(const formation::Robot& robot, const formation::RobotStep& state, const Rational& time,
                      const RationalObstacle& obstacle) {
  if (!robot.drive || robot.drive->chain.empty()) return Verdict::clear;
  if (!state.wheels || !geometry::is_finite(state.wheels->heading) || !geometry::is_finite(state.chosen))
    return Verdict::unknown;
  const Vec2 e = state.wheels->heading, u = state.chosen;
  const Point heading = exactly(e), velocity = exactly(u);
  const int turns = sgn(exact::cross(heading, velocity));
  const bool is_behind = sgn(exact::dot(heading, velocity)) < 0;
  for (std::size_t k = 1; k < robot.drive->chain.size(); ++k) {
    const geometry::Disc& disc = robot.drive->chain[k];
    const Link link{obstacle, exactly(state.position), time * velocity,
                    Rational(robot.drive->reference) - Rational(disc.center.x), Rational(disc.radius)};
    const auto turned = [&](int side) {
      const Vec2 along = u == Vec2{} ? e : geometry::normalized(u), left{-along.y, along.x};
      const Vec2 last = geometry::normalized(along + side * kBeyond * left), across = side * Vec2{-e.y, e.x};
      if (side * sgn(exact::cross(exactly(last), velocity)) > 0) return Verdict::unknown;
      if (!is_behind) return link.over(e, last, side);
      const Verdict first = link.over(e, across, side);
      return first == Verdict::clear ? link.over(across, last, side) : first;
    };
    Verdict verdict = Verdict::clear;
    for (const int side : {1, -1})  // straight ahead or back: to either side
      if (verdict == Verdict::clear && side * turns >= 0) verdict = turned(side);
    if (verdict != Verdict::clear) return verdict;
  }
  return Verdict::clear;
}

}  // namespace exactvo::datasets
