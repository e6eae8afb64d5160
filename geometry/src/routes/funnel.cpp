// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/funnel.h"

#include <algorithm>
#include <deque>

namespace exactvo::geometry::routing {
namespace {

/// Of the coordinates: ends this close to each other are one.
constexpr double kSame = 0x1p-45;

}  // namespace

PortalRow::PortalRow(const ClearancePlan& plan, const std::vector<int>& portals, int start)
    : plan_(&plan), portals_(&portals) {
  int cell = start;
  for (const int number : portals) {
    const Portal& portal = plan.map().portals[number];
    from_left_.push_back(portal.left == cell);
    cell = portal.left == cell ? portal.right : portal.left;
  }
}

/// Between the apex and the last portal, the ends on either side that still bound what is seen.
std::vector<Turn> turns_through(const PortalRow& row, Vec2 s, Vec2 t) {
  std::vector<Turn> turns;
  const std::size_t n = row.size();
  const auto end_of = [&](std::size_t k, bool left) { return k == n ? t : row.end(k, left); };
  std::deque<std::size_t>
      side[2];  // of each the bounding ends in order, by the portal; the first bounds the apex's view
  Vec2 apex = s;
  for (std::size_t k = 0; k <= n; ++k) {
    for (const bool left : {true, false}) {
      const double sense = left ? 1.0 : -1.0;
      const Vec2 end = end_of(k, left);
      std::deque<std::size_t>&mine = side[left ? 0 : 1], &other = side[left ? 1 : 0];
      // Ends of this side behind which the new one is seen bound nothing any more.
      while (!mine.empty()) {
        const Vec2 last = end_of(mine.back(), left);
        const Vec2 before = mine.size() > 1 ? end_of(mine[mine.size() - 2], left) : apex;
        const bool is_same = norm(end - last) <= kSame * std::max(largest_of(end), largest_of(last));
        if (!is_same && sense * cross(last - before, end - before) > 0.0) break;
        mine.pop_back();
      }
      if (mine.empty()) {
        // Beyond ends of the other side: the curve turns at each of them.
        while (!other.empty() && sense * cross(end_of(other.front(), !left) - apex, end - apex) < 0.0) {
          apex = end_of(other.front(), !left);
          turns.push_back({other.front(), !left});
          other.pop_front();
        }
      }
      mine.push_back(k);
    }
  }
  return turns;
}

}  // namespace exactvo::geometry::routing
