// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/funnel.h"

#include <algorithm>
#include <deque>

#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// A share of the coordinates: ends this close to each other are one.
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

namespace {

/// An end of a portal, or of the way. `exact` is used where the row's ends are exact alone.
struct FunnelEnd {
  Vec2 at;
  Point exact;
};

}  // namespace

/// Between the apex and the last portal, the ends on either side that still bound what is seen.
std::vector<Turn> turns_through(const PortalRow& row, Vec2 s, Vec2 t) {
  std::vector<Turn> turns;
  const std::size_t n = row.size();
  const bool is_exact = row.has_exact_ends();
  const auto end_of = [&](std::size_t k, bool left) -> FunnelEnd {
    if (k == n) return {t, t};
    return {row.end(k, left), is_exact ? row.exact_end(k, left) : Point()};
  };
  /// Above 0 where a -> b -> c turns left.
  const auto turn_of = [&](const FunnelEnd& a, const FunnelEnd& b, const FunnelEnd& c) {
    return is_exact ? static_cast<double>(orient(a.exact, b.exact, c.exact)) : cross(b.at - a.at, c.at - a.at);
  };
  std::deque<std::size_t>
      side[2];  // of each the bounding ends in order, by the portal; the first bounds the apex's view
  FunnelEnd apex{s, s};
  for (std::size_t k = 0; k <= n; ++k) {
    for (const bool left : {true, false}) {
      const double sense = left ? 1.0 : -1.0;
      const FunnelEnd end = end_of(k, left);
      std::deque<std::size_t>&mine = side[left ? 0 : 1], &other = side[left ? 1 : 0];
      // Ends of this side behind which the new one is seen bound nothing any more.
      while (!mine.empty()) {
        const FunnelEnd last = end_of(mine.back(), left);
        const FunnelEnd before = mine.size() > 1 ? end_of(mine[mine.size() - 2], left) : apex;
        const bool is_same =
            norm(end.at - last.at) <= kSame * std::max(largest_coordinate(end.at), largest_coordinate(last.at));
        if (!is_same && sense * turn_of(before, last, end) > 0.0) break;
        mine.pop_back();
      }
      if (mine.empty()) {
        // Beyond ends of the other side: the curve turns at each of them.
        while (!other.empty() && sense * turn_of(apex, end_of(other.front(), !left), end) < 0.0) {
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
