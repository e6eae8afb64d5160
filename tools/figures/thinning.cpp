// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/thinning.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace exactvo::tools {

namespace {

/// Points looked at together: the time grows with their square where a curve is as jagged as can be.
constexpr std::size_t kStretch = 2048;

double distance_to_stretch(Vec2 a, Vec2 b, Vec2 p) {
  const Vec2 way = b - a;
  const double length = dot(way, way);
  const double along = length > 0.0 ? std::clamp(dot(p - a, way) / length, 0.0, 1.0) : 0.0;
  return norm(p - (a + along * way));
}

/// Marks the points between two that are kept.
void keep_between(const Points& curve, std::size_t first, std::size_t last, std::vector<bool>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    double most = kThinning;
    std::size_t farthest = from;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double distance = distance_to_stretch(curve[from], curve[to], curve[k]);
      if (distance > most) most = distance, farthest = k;
    }
    if (farthest == from) continue;
    kept[farthest] = true;
    open.emplace_back(from, farthest);
    open.emplace_back(farthest, to);
  }
}

}  // namespace

std::vector<std::size_t> all_points(std::size_t count) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> drawn_points(const Points& curve) {
  if (curve.size() < 3) return all_points(curve.size());
  std::vector<bool> kept(curve.size());
  for (std::size_t from = 0; from + 1 < curve.size(); from += kStretch) {
    const std::size_t to = std::min(from + kStretch, curve.size() - 1);
    kept[from] = kept[to] = true;
    keep_between(curve, from, to, kept);
  }
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < curve.size(); ++k)
    if (kept[k]) drawn.push_back(k);
  return drawn;
}

}  // namespace exactvo::tools
