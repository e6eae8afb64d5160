// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/near.h"

#include <algorithm>
#include <cmath>

#include "crowd/packs.h"

namespace exactvo::formation::crowd {
namespace {

/// Of a squared reach: above what squared distances in float are rounded by.
constexpr double kFarthest = 1.0 + 0x1p-16;

/// Everybody nearer than `reach` (lattice steps), and maybe some beyond, by the order of neighbours.
void everybody_near(const Robots& robots, std::size_t robot, double reach, std::vector<Near>& near) {
  const Window at{robots.x[robot], robots.x[robot], robots.y[robot], robots.y[robot]};
  const Cells cells = robots.cells_of(grown(at, reach));
  const auto farthest = static_cast<float>(reach * reach * kFarthest);
  near.clear();
  for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
    const Stretch stretch = robots.stretch(cells, row);
    for (std::size_t j = stretch.from; j < stretch.to; ++j) {
      if (j == robot) continue;
      const auto dx = static_cast<float>(robots.x[j] - robots.x[robot]),
                 dy = static_cast<float>(robots.y[j] - robots.y[robot]);
      const float squared = without_number(dx * dx + dy * dy);
      if (squared <= farthest) near.emplace_back(squared, static_cast<std::int32_t>(j));
    }
  }
  std::sort(near.begin(), near.end());
}

}  // namespace

bool neighbours_of(const Robots& robots, const ReachTable& table, std::size_t robot, std::vector<Near>& near,
                   float& last) {
  const std::size_t kind = robots.kind(robot);
  const auto most = static_cast<std::size_t>(table.neighbours[kind]);
  double reach = std::min(table.window[kind], kFirstReach * robots.hint[robot] + table.nearby);
  reach = std::max(reach, std::sqrt(static_cast<double>(table.reach[kind])) * (1.0 + 0x1p-10));
  for (;; reach = std::min(table.window[kind], reach * kWiderReach)) {
    everybody_near(robots, robot, reach, near);
    const bool full = near.size() >= most && static_cast<double>(near[most - 1].first) <= reach * reach * kWholeKey;
    if (full || reach >= table.window[kind]) break;
  }
  last = near.size() >= most ? near[most - 1].first : table.none[kind];
  std::size_t count = 0;
  while (count < near.size() && near[count].first < table.none[kind] &&
         (count < most || near[count].first < table.reach[kind]))
    ++count;
  near.resize(count);
  return count > most || (count == most && last < table.reach[kind]);
}

std::int32_t hint_of(const ReachTable& table, float key, std::size_t kind) {
  const double most = table.window[kind];
  if (!(key < table.none[kind])) return static_cast<std::int32_t>(std::min(most, 0x1p30));
  const double distance = static_cast<double>(std::sqrt(float_of(bits_of(key) & ~kIndexBits)));
  return static_cast<std::int32_t>(std::min({distance, most, 0x1p30}));
}

}  // namespace exactvo::formation::crowd
