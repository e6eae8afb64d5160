// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <optional>

namespace exactvo::lp::oracle {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Digits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

/// Values carry 100 digits and come from determinants of size 1e-34 at worst (differences of doubles, squared): what is
/// left is below this.
const Digits kLeftOver("1e-45");

template <class N>
struct LineOf {
  N x, y, c;
  bool soft;
};
template <class N>
struct PointOf {
  N x, y;
};

template <class N>
std::vector<LineOf<N>> lines_of(const Problem& problem, bool hard_only) {
  std::vector<LineOf<N>> lines;
  for (const Constraint& c : problem.constraints) {
    const bool soft = c.priority == Priority::soft;
    if (hard_only && soft) continue;
    lines.push_back({N(c.half_plane.normal.x), N(c.half_plane.normal.y), N(c.half_plane.offset), soft});
  }
  const SpeedBound& b = problem.bound;
  if (std::isfinite(b.box_x)) {
    lines.push_back({N(1), N(0), N(-b.box_x), false});
    lines.push_back({N(-1), N(0), N(-b.box_x), false});
  }
  if (std::isfinite(b.box_y)) {
    lines.push_back({N(0), N(1), N(-b.box_y), false});
    lines.push_back({N(0), N(-1), N(-b.box_y), false});
  }
  return lines;
}

template <class N>
std::optional<PointOf<N>> crossing(const LineOf<N>& a, const LineOf<N>& b) {
  const N det = a.x * b.y - a.y * b.x;
  if (det == 0) return std::nullopt;
  return PointOf<N>{N((a.c * b.y - b.c * a.y) / det), N((a.x * b.c - b.x * a.c) / det)};
}

template <class N>
PointOf<N> foot(const LineOf<N>& a, const PointOf<N>& p) {
  const N s = (a.c - a.x * p.x - a.y * p.y) / (a.x * a.x + a.y * a.y);
  return {N(p.x + s * a.x), N(p.y + s * a.y)};
}

template <class N>
bool keeps_all(const std::vector<LineOf<N>>& lines, const PointOf<N>& v, const N& tolerance) {
  for (const auto& l : lines)
    if (l.x * v.x + l.y * v.y < l.c - tolerance) return false;
  return true;
}

/// 0, its foot on every line and every crossing: among these is the point of a polygon that is nearest 0.
template <class N>
std::vector<PointOf<N>> corners(const std::vector<LineOf<N>>& lines, const PointOf<N>& from) {
  std::vector<PointOf<N>> points{from};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    points.push_back(foot(lines[i], from));
    for (std::size_t j = i + 1; j < lines.size(); ++j)
      if (const auto p = crossing(lines[i], lines[j])) points.push_back(*p);
  }
  return points;
}

void add_on_disc(const LineOf<Digits>& line, double disc, std::vector<PointOf<Digits>>& points) {
  const Digits nn = line.x * line.x + line.y * line.y;
  const Digits room = Digits(disc) * disc - line.c * line.c / nn;
  if (room < 0) return;
  const Digits s = sqrt(Digits(room / nn));
  for (const int side : {-1, 1})
    points.push_back(
        {Digits(line.x * line.c / nn - side * s * line.y), Digits(line.y * line.c / nn + side * s * line.x)});
}

void add_top(const Digits& x, const Digits& y, double disc, std::vector<PointOf<Digits>>& points) {
  const Digits length = sqrt(Digits(x * x + y * y));
  if (length > 0) points.push_back({Digits(x * disc / length), Digits(y * disc / length)});
}

bool inside(double disc, const PointOf<Digits>& v) {
  return std::isinf(disc) || v.x * v.x + v.y * v.y <= Digits(disc) * disc + kLeftOver;
}

/// Every point where the nearest or the farthest velocity can be.
std::vector<PointOf<Digits>> candidates(const Problem& problem, const std::vector<LineOf<Digits>>& lines) {
  const PointOf<Digits> p{Digits(problem.preferred.x), Digits(problem.preferred.y)};
  std::vector<PointOf<Digits>> points = corners(lines, p);
  if (std::isfinite(problem.bound.disc)) {
    for (const auto& line : lines) add_on_disc(line, problem.bound.disc, points);
    add_top(p.x, p.y, problem.bound.disc, points);
  }
  return points;
}

/// The lines along which two soft constraints are violated equally, and the hard lines.
std::vector<LineOf<Digits>> ridges(const std::vector<LineOf<Digits>>& lines) {
  std::vector<LineOf<Digits>> out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].soft) out.push_back(lines[i]);
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      if (!lines[i].soft || !lines[j].soft) continue;
      const LineOf<Digits> ridge{Digits(lines[i].x - lines[j].x), Digits(lines[i].y - lines[j].y),
                                 Digits(lines[i].c - lines[j].c), false};
      if (ridge.x != 0 || ridge.y != 0) out.push_back(ridge);
    }
  }
  return out;
}

}  // namespace

bool is_feasible(const Problem& problem, bool hard_only) {
  const auto lines = lines_of<Rational>(problem, hard_only);
  const bool bounded = std::isfinite(problem.bound.disc);
  const Rational limit = bounded ? Rational(Rational(problem.bound.disc) * Rational(problem.bound.disc)) : Rational(0);
  for (const auto& v : corners(lines, PointOf<Rational>{0, 0})) {
    if (bounded && v.x * v.x + v.y * v.y > limit) continue;
    if (keeps_all(lines, v, Rational(0))) return true;
  }
  return false;
}

Status verdict(const Problem& problem) {
  if (is_feasible(problem, false)) return Status::optimal;
  return is_feasible(problem, true) ? Status::relaxed : Status::infeasible;
}

double least_squared_distance(const Problem& problem) {
  const auto lines = lines_of<Digits>(problem, false);
  std::optional<Digits> least;
  for (const auto& v : candidates(problem, lines)) {
    if (!inside(problem.bound.disc, v) || !keeps_all(lines, v, kLeftOver)) continue;
    const Digits dx = v.x - problem.preferred.x, dy = v.y - problem.preferred.y;
    const Digits squared = dx * dx + dy * dy;
    if (!least || squared < *least) least = squared;
  }
  return static_cast<double>(least.value());
}

double farthest(const Problem& problem) {
  const auto lines = lines_of<Digits>(problem, false);
  std::optional<Digits> most;
  for (const auto& v : candidates(problem, lines)) {
    if (!inside(problem.bound.disc, v) || !keeps_all(lines, v, kLeftOver)) continue;
    const Digits along = v.x * problem.preferred.x + v.y * problem.preferred.y;
    if (!most || along > *most) most = along;
  }
  return static_cast<double>(most.value());
}

double least_violation(const Problem& problem) {
  auto lines = lines_of<Digits>(problem, false);
  if (!is_feasible(problem, true)) {
    lines = lines_of<Digits>(problem, true);
    std::size_t hard = 0;
    for (const Constraint& c : problem.constraints) hard += c.priority == Priority::hard;
    for (std::size_t k = 0; k < hard; ++k) lines[k].soft = true;  // the sides of the box follow them
  }
  const auto edges = ridges(lines);
  auto points = corners(edges, PointOf<Digits>{0, 0});
  if (std::isfinite(problem.bound.disc)) {
    for (const auto& edge : edges) add_on_disc(edge, problem.bound.disc, points);
    for (const auto& line : lines)
      if (line.soft) add_top(line.x, line.y, problem.bound.disc, points);
  }
  std::optional<Digits> least;
  for (const auto& v : points) {
    if (!inside(problem.bound.disc, v)) continue;
    Digits worst = 0;
    bool kept = true;
    for (const auto& l : lines) {
      const Digits by = l.c - l.x * v.x - l.y * v.y;
      if (l.soft && by > worst) worst = by;
      if (!l.soft && by > kLeftOver) kept = false;
    }
    if (kept && (!least || worst < *least)) least = worst;
  }
  return static_cast<double>(least.value());
}

}  // namespace exactvo::lp::oracle
