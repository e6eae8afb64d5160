// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/measuring.h"

#include <algorithm>

#include "liveness/split_mix.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {
namespace {

/// Within a disc about 0, so far inside that sums with it stay within the bound.
Vec2 error_within(double bound, SplitMix64& random) {
  constexpr double kInside = 1.0 - 1e-9;
  for (;;) {
    const double x = 2.0 * random.fraction() - 1.0, y = 2.0 * random.fraction() - 1.0;
    if (x * x + y * y <= 1.0) return kInside * bound * Vec2{x, y};
  }
}

}  // namespace

void Measuring::look(const std::vector<Vec2>& positions, const std::vector<Vec2>& velocities) {
  constexpr double kRounding = 1.0 + 1e-9;
  const Measurements& bounds = *rules_.measurements;
  rows_.push_back({positions, velocities});
  const auto most_rows = static_cast<std::size_t>(std::min(kRounding * bounds.age / rules_.time_step, 1e6)) + 1;
  if (rows_.size() > most_rows) rows_.pop_front();
  const Row& then = rows_.front();
  const double age = static_cast<double>(rows_.size() - 1) * rules_.time_step;
  const std::size_t n = robots_.size();
  measured_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<MeasuredRobot>& mine = measured_[i];
    mine.clear();
    const auto is_in_sight = [&](std::size_t j) {
      return norm(positions[j] - positions[i]) <=
             sight_of(rules_, robots_[i].radius + robots_[j].radius, robots_[i].max_speed + robots_[j].max_speed);
    };
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || !is_in_sight(j)) continue;
      SplitMix64 random((row_ * n + i) * n + j + 1);
      const Vec2 off = error_within(bounds.position, random);
      mine.push_back({j, then.positions[j] + off, then.velocities[j] + error_within(bounds.velocity, random), age});
    }
    const auto distance = [&](const MeasuredRobot& m) { return norm(m.position - positions[i]); };
    std::stable_sort(mine.begin(), mine.end(),
                     [&](const MeasuredRobot& a, const MeasuredRobot& b) { return distance(a) < distance(b); });
  }
  ++row_;
}

}  // namespace exactvo::formation::detail
