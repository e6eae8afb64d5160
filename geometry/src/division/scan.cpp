// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/scan.h"

#include <algorithm>
#include <cmath>

#include "division/chain_fit.h"
#include "division/region_growing.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"

namespace exactvo::geometry {
namespace {

// Consecutive hits of one wall, as indices into what was given.
using Run = std::vector<std::size_t>;

double gap(Vec2 a, Vec2 b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

std::vector<Run> runs_of(const std::vector<Vec2>& hits, double range_jump) {
  std::vector<Run> runs;
  bool open = false;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!is_finite(hits[i])) {
      open = false;
      continue;
    }
    if (!open || gap(hits[runs.back().back()], hits[i]) > range_jump) runs.emplace_back();
    runs.back().push_back(i);
    open = true;
  }
  return runs;
}

double turn_at(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 in = b - a;
  const Vec2 out = c - b;
  return std::fabs(std::atan2(cross(in, out), dot(in, out)));
}

// One run on its way to facades.
class Division {
 public:
  Division(std::vector<Vec2> points, double tolerance)
      : points_(std::move(points)),
        tolerance_(tolerance),
        largest_(detail::largest_coordinate(points_)),
        kept_(points_.size(), false) {
    kept_.front() = true;
    kept_.back() = true;
  }

  void split() { detail::refine_gap(points_, kept_, 0, points_.size() - 1, tolerance_, largest_); }

  void merge(double turn) {
    std::size_t before = 0;
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
      if (!kept_[i]) continue;
      const std::size_t after = next_kept(i);
      const bool flat = turn_at(points_[before], points_[i], points_[after]) <= turn;
      kept_[i] = !flat || detail::farthest_between(points_, before, after, largest_).distance > tolerance_;
      if (kept_[i]) before = i;
    }
  }

  // Appends the facades; `run` says which hit stands behind each point.
  void append_to(const Run& run, DividedPoints& out) const {
    if (points_.size() == 1) append_facade(0, 0, run, out);
    for (std::size_t i = 0; i + 1 < points_.size(); i = next_kept(i)) append_facade(i, next_kept(i), run, out);
  }

 private:
  std::size_t next_kept(std::size_t i) const {
    do ++i;
    while (!kept_[i]);
    return i;
  }

  void append_facade(std::size_t from, std::size_t to, const Run& run, DividedPoints& out) const {
    const double far = detail::farthest_between(points_, from, to, largest_).distance;
    out.deviation = std::max(out.deviation, far);
    for (std::size_t k = from; k <= to; ++k) {
      if (!out.facade_of[run[k]]) out.facade_of[run[k]] = out.facades.size();
    }
    out.facades.push_back({points_[from], points_[to]});
  }

  std::vector<Vec2> points_;
  double tolerance_;
  double largest_;
  std::vector<bool> kept_;
};

std::vector<Vec2> points_of(const std::vector<Vec2>& hits, const Run& run) {
  std::vector<Vec2> points;
  points.reserve(run.size());
  for (const std::size_t i : run) points.push_back(hits[i]);
  return points;
}

void divide_run(const std::vector<Vec2>& hits, const Run& run, double tolerance, double merge_turn,
                DividedPoints& out) {
  Division division(points_of(hits, run), tolerance);
  division.split();
  division.merge(merge_turn);
  division.append_to(run, out);
}

bool is_length(double x) {
  return std::isfinite(x) && x >= 0.0;
}

std::string text(double a, double b, double c) {
  return hex_text(a) + " " + hex_text(b) + " " + hex_text(c);
}

std::vector<std::size_t> finite_ones(const std::vector<Vec2>& points) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_finite(points[i])) out.push_back(i);
  }
  return out;
}

}  // namespace

DividedPoints divide_scan(const std::vector<Vec2>& hits, const ScanOptions& options) {
  EXACTVO_REQUIRE(is_length(options.range_jump) && options.range_jump > 0.0 && is_length(options.tolerance) &&
                      options.merge_turn >= 0.0 && options.merge_turn <= kPi,
                  text(options.range_jump, options.tolerance, options.merge_turn));
  DividedPoints out;
  out.facade_of.resize(hits.size());
  for (const Run& run : runs_of(hits, options.range_jump)) {
    divide_run(hits, run, options.tolerance, options.merge_turn, out);
  }
  return out;
}

DividedPoints divide_points(const std::vector<Vec2>& points, const PointOptions& options) {
  EXACTVO_REQUIRE(is_length(options.neighbour_radius) && options.neighbour_radius > 0.0 &&
                      is_length(options.tolerance) && options.tolerance > 0.0 && options.normal_angle > 0.0 &&
                      options.normal_angle <= 0.5 * kPi && options.least_points >= 2,
                  text(options.neighbour_radius, options.tolerance, options.normal_angle));
  DividedPoints out;
  out.facade_of.resize(points.size());
  const std::vector<std::size_t> usable = finite_ones(points);
  if (usable.empty()) return out;
  for (const Run& group : detail::points_along_lines(points_of(points, usable), options)) {
    Run run;
    for (const std::size_t i : group) run.push_back(usable[i]);
    divide_run(points, run, options.tolerance, kPi, out);
  }
  for (const std::size_t i : usable) {
    if (!out.facade_of[i]) divide_run(points, {i}, options.tolerance, kPi, out);
  }
  return out;
}

}  // namespace exactvo::geometry
