// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether robots of a run overlap: every motion against every other one near it, continuous in time, in whole numbers.
/// Written for itself: it shares nothing with the engine, with the audit or with the metrics.

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "exactvo/formation/crowd.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;

/// A place in whole lattice steps.
struct LatticePlace {
  std::int64_t x, y;
};

/// The places on the lattice of these robots of the crowd.
inline std::vector<LatticePlace> lattice_places(const Crowd& crowd, const std::vector<RobotId>& robots) {
  std::vector<Vec2> at;
  crowd.positions(at);
  const double step = crowd.options().position_step;
  std::vector<LatticePlace> places;
  for (const RobotId id : robots)
    places.push_back({static_cast<std::int64_t>(at[id].x / step), static_cast<std::int64_t>(at[id].y / step)});
  return places;
}

/// Looks at the motions of all robots in a step.
class MotionOverlaps {
 public:
  std::size_t motions = 0;   ///< of pairs near enough to be looked at
  std::size_t overlaps = 0;  ///< of these
  std::string first;         ///< losslessly

  /// Robot k moves from `from[k]` to `to[k]` in lattice steps of `step` metres; `radius[k]` in metres.
  void look(std::vector<LatticePlace> from, std::vector<LatticePlace> to, const std::vector<double>& radius,
            double step, std::size_t steps) {
    from_ = std::move(from);
    to_ = std::move(to);
    radius_ = &radius;
    step_ = step;
    std::int64_t longest = 0, widest = 0;
    for (std::size_t i = 0; i < from_.size(); ++i) {
      longest = std::max({longest, std::abs(to_[i].x - from_[i].x), std::abs(to_[i].y - from_[i].y)});
      widest = std::max(widest, static_cast<std::int64_t>(std::ceil(radius[i] / step_)));
    }
    const std::int64_t reach = 2 * (longest + widest) + 2;
    order_.resize(from_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return from_[a].x < from_[b].x; });
    for (std::size_t a = 0; a < order_.size(); ++a)
      for (std::size_t b = a + 1; b < order_.size() && from_[order_[b]].x - from_[order_[a]].x <= reach; ++b)
        if (std::abs(from_[order_[b]].y - from_[order_[a]].y) <= reach) look_at(order_[a], order_[b], steps);
  }

 private:
  void look_at(std::size_t i, std::size_t j, std::size_t steps) {
    ++motions;
    const Int128 dx = from_[j].x - from_[i].x, dy = from_[j].y - from_[i].y;
    const Int128 mx = to_[j].x - from_[j].x - to_[i].x + from_[i].x, my = to_[j].y - from_[j].y - to_[i].y + from_[i].y;
    const Int128 squared = mx * mx + my * my, along = dx * mx + dy * my;
    const Int128 ex = dx + mx, ey = dy + my, across = dx * my - dy * mx;
    bool meet;
    if (along >= 0)
      meet = is_below(dx * dx + dy * dy, 1, i, j);
    else if (-along >= squared)
      meet = is_below(ex * ex + ey * ey, 1, i, j);
    else
      meet = is_below(across * across, squared, i, j);
    if (!meet) return;
    if (overlaps++ != 0) return;
    char text[400];
    std::snprintf(text, sizeof text,
                  "step %zu: robots %zu and %zu, D (%lld, %lld), M (%lld, %lld), radii %a and %a, step %a", steps, i, j,
                  static_cast<long long>(dx), static_cast<long long>(dy), static_cast<long long>(mx),
                  static_cast<long long>(my), (*radius_)[i], (*radius_)[j], step_);
    first = text;
  }

  static mpz_class whole(Int128 value) {
    const bool negative = value < 0;
    const auto bits = static_cast<UInt128>(negative ? -value : value);
    mpz_class all(static_cast<unsigned long>(bits >> 64U));
    all = (all << 64U) + static_cast<unsigned long>(bits);
    return negative ? mpz_class(-all) : all;
  }

  /// Whether a / b, in squared lattice steps, is below the squared sum of the radii. Exact: doubles decide where they
  /// can.
  bool is_below(Int128 a, Int128 b, std::size_t i, std::size_t j) const {
    const double sum = ((*radius_)[i] + (*radius_)[j]) / step_;
    const double left = static_cast<double>(a), right = sum * sum * static_cast<double>(b);
    if (left > right * (1.0 + 0x1p-45)) return false;
    if (left < right * (1.0 - 0x1p-45)) return true;
    const mpq_class radii = (mpq_class((*radius_)[i]) + mpq_class((*radius_)[j])) / mpq_class(step_);
    return mpq_class(whole(a)) < radii * radii * whole(b);
  }

  const std::vector<double>* radius_ = nullptr;
  double step_ = 1.0;
  std::vector<LatticePlace> from_, to_;
  std::vector<std::size_t> order_;
};

/// Looks at each step of a run of a crowd.
class OverlapCheck : public RunSink {
 public:
  explicit OverlapCheck(const Scenario& scenario) {
    for (const Robot& r : scenario.robots) {
      robots_.push_back(static_cast<RobotId>(robots_.size()));
      radius_.push_back(r.radius);
    }
  }

  MotionOverlaps found;

  void add_state(const RunState& now) override {
    std::vector<LatticePlace> from = std::move(to_);
    to_ = lattice_places(*now.crowd, robots_);
    if (now.steps > 0) found.look(std::move(from), to_, radius_, now.crowd->options().position_step, now.steps);
  }

 private:
  std::vector<RobotId> robots_;
  std::vector<double> radius_;
  std::vector<LatticePlace> to_;
};

}  // namespace exactvo::formation
