// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/patterns.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "control/consensus.h"
#include "exactvo/geometry/names.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"

namespace exactvo::formation {
namespace {

constexpr geometry::Names<Pattern, 4> kNames{
    {{Pattern::line, "line"}, {Pattern::wedge, "wedge"}, {Pattern::circle, "circle"}, {Pattern::grid, "grid"}}};

/// The point, then left and right in turn; each arm's neighbours 1 apart, 45 degrees back.
Vec2 on_wedge(std::size_t k) {
  const double rank = static_cast<double>((k + 1) / 2) / std::sqrt(2.0);
  return {-rank, k % 2 == 1 ? rank : -rank};
}

Vec2 on_circle(std::size_t k, std::size_t n) {
  if (n == 1) return {};
  const double turn = 2.0 * geometry::kPi / static_cast<double>(n);
  const double radius = 0.5 / std::sin(0.5 * turn);
  const double angle = turn * static_cast<double>(k);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vec2 on_grid(std::size_t k, std::size_t n) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))));
  const std::size_t row = k / columns;
  const std::size_t in_row = std::min(columns, n - row * columns);
  const double middle = 0.5 * static_cast<double>(in_row - 1);
  return {-static_cast<double>(row), static_cast<double>(k % columns) - middle};
}

Vec2 slot(Pattern pattern, std::size_t k, std::size_t n) {
  if (pattern == Pattern::line) return {0.0, static_cast<double>(k)};
  if (pattern == Pattern::wedge) return on_wedge(k);
  return pattern == Pattern::circle ? on_circle(k, n) : on_grid(k, n);
}

}  // namespace

bool parse(const std::string& text, Pattern& out) {
  return geometry::parse_in(kNames, text, out);
}

std::vector<Vec2> pattern_offsets(Pattern pattern, std::size_t n, double spacing, Vec2 heading) {
  EXACTVO_REQUIRE(n >= 1, std::to_string(n));
  EXACTVO_REQUIRE(spacing > 0.0 && std::isfinite(spacing), std::to_string(spacing));
  const Vec2 forward = geometry::normalized(heading);
  std::vector<Vec2> offsets;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 local = spacing * slot(pattern, k, n);
    offsets.push_back(local.x * forward + local.y * geometry::perp(forward));
  }
  return detail::recentred(std::move(offsets));
}

Topology complete_topology(std::size_t n) {
  return neighbour_topology(std::vector<Vec2>(n), 0.0);
}

Topology neighbour_topology(const std::vector<Vec2>& offsets, double reach, const std::vector<std::size_t>& pinned) {
  const std::size_t n = offsets.size();
  Topology t;
  t.adjacency.assign(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (i != j && norm(offsets[i] - offsets[j]) <= reach) t.adjacency[i][j] = 1.0;
  t.pinning.assign(n, pinned.empty() ? 1.0 : 0.0);
  for (std::size_t i : pinned) t.pinning.at(i) = 1.0;
  return t;
}

}  // namespace exactvo::formation
