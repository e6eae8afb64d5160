// SPDX-License-Identifier: GPL-3.0-or-later
// What a search has found as a way, and the second search.
#include <algorithm>
#include <functional>
#include <queue>
#include <unordered_map>

#include "exactvo/geometry/infinity.h"
#include "routes/funnel.h"
#include "routes/search.h"

namespace exactvo::geometry::routing {
Vec2 mirrored(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double squared = squared_norm(d);
  if (squared == 0.0) return p;
  const Vec2 n{-d.y, d.x};
  return p - (2.0 * dot(p - a, n) / squared) * n;
}

// --- From the last node back to the way ---

void WaySearch::trace(int number, Vec2 t, Way& way) const {
  std::vector<const Node*> nodes;
  for (int k = number; k >= 0; k = nodes_[k].parent) nodes.push_back(&nodes_[k]);
  std::reverse(nodes.begin(), nodes.end());
  std::vector<bool> from_left;       // of each portal of the way: whether it is crossed from its left cell
  std::vector<std::size_t> last_of;  // of each node: the place of its last portal
  std::unordered_map<int, std::size_t> first_place;  // of a portal
  const auto pass = [&](int portal, int cell) {
    first_place.emplace(portal, way.portals.size());
    way.portals.push_back(portal);
    from_left.push_back(map_.portals[portal].right == cell);
  };
  for (const Node* n : nodes) {
    if (n->first_portal >= 0) {
      Crossing at = crossing_into(n->first_portal, n->first_cell);
      do pass(at.portal, at.cell);
      while (pass_on(*n, at) && !(at.portal == n->portal && at.cell == n->cell));
    }
    pass(n->portal, n->cell);
    last_of.push_back(way.portals.size() - 1);
  }
  const auto place_of = [&](int portal, std::size_t otherwise) {
    const auto found = first_place.find(portal);
    return found == first_place.end() ? otherwise : found->second;
  };
  std::vector<Waypoint> turns;
  const auto add_vertex = [&](int corner, std::size_t otherwise) {
    const std::size_t at = place_of(corner / 2, otherwise);
    const ShrunkPortal& q = plan_.shrunk(corner / 2);
    const int vertex = corner % 2 ? q.to_corner : q.from_corner;
    if (vertex < 0 || q.tight) return;
    // Its portal's left cell sees `to` on the left.
    turns.push_back({-1, false, vertex, from_left[at] == (corner % 2 == 1), static_cast<int>(at)});
  };
  int last = -1;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k]->corner < 0 || nodes[k]->corner == last) continue;
    last = nodes[k]->corner;
    add_vertex(last, last_of[k]);
  }
  // The last turn may be at an end of the last interval.
  const Node& n = *nodes.back();
  const Vec2 d = n.left - n.right;
  const Vec2 goal = squared_norm(d) > 0.0 && cross(d, t - n.right) > 0.0 ? mirrored(t, n.right, n.left) : t;
  int corner = -1;
  if (cross(n.left - n.root, goal - n.root) > 0.0)
    corner = corner_at(n.portal, n.left);
  else if (cross(n.right - n.root, goal - n.root) < 0.0)
    corner = corner_at(n.portal, n.right);
  if (corner >= 0 && corner != last) add_vertex(corner, way.portals.size() - 1);
  const Portal& first = map_.portals[way.portals.front()];
  way.start = from_left.front() ? first.left : first.right;
  set_waypoints(turns, from_left, way);
}

/// The turns and the tight gates, along the way. Those in a row that are pieces of one gate, or the same turn, are one.
void WaySearch::set_waypoints(const std::vector<Waypoint>& turns, const std::vector<bool>& from_left, Way& way) const {
  std::vector<Waypoint>& list = way.waypoints;
  for (std::size_t k = 0; k < way.portals.size(); ++k)
    if (plan_.shrunk(way.portals[k]).tight)
      list.push_back({way.portals[k],
                      from_left[k],
                      -1,
                      false,
                      static_cast<int>(k),
                      {way.portals[k], from_left[k], static_cast<int>(k)}});
  list.insert(list.end(), turns.begin(), turns.end());
  std::stable_sort(list.begin(), list.end(), [](const Waypoint& a, const Waypoint& b) { return a.at < b.at; });
  const auto same = [&](const Waypoint& a, const Waypoint& b) {
    if ((a.portal < 0) != (b.portal < 0)) return false;
    if (a.portal < 0) return a.vertex == b.vertex && a.on_left == b.on_left;
    const Portal &p = map_.portals[a.portal], &q = map_.portals[b.portal];
    return p.link >= 0 && p.link == q.link;
  };
  std::size_t count = 0;
  for (const Waypoint& w : list) {
    if (count > 0 && same(list[count - 1], w))
      list[count - 1].last = w.last;
    else
      list[count++] = w;
  }
  list.resize(count);
}

// --- The second search ---

bool WaySearch::search_nearly_open(Vec2 s, const std::vector<int>& starts, Vec2 t, Way& way) {
  way.lower_bound = bound_;
  // Portals that are clearly empty come last: a gate that the disc fits through may have some.
  using Cost = std::pair<int, double>;  // of those, how many; then the length, m
  struct Reached {
    Cost cost{std::numeric_limits<int>::max(), kInfinity};
    int through = -1;  ///< the portal
    Vec2 at;
  };
  std::vector<Reached> reached(map_.cell_portals.size());
  std::priority_queue<std::pair<Cost, int>, std::vector<std::pair<Cost, int>>, std::greater<>> queue;
  for (const int start : starts) {
    reached[start] = {{0, 0.0}, -1, s};
    queue.emplace(Cost{0, 0.0}, start);
  }
  int goal = -1;
  while (!queue.empty() && goal < 0) {
    const auto [cost, cell] = queue.top();
    queue.pop();
    if (cost > reached[cell].cost) continue;
    if (is_goal(cell)) goal = cell;
    for (const CellMap::CellPortal& p : map_.cell_portals[cell]) {
      const Portal& portal = map_.portals[p.portal];
      if (portal.right < 0 || !plan_.admits(portal)) continue;
      const ShrunkPortal& q = plan_.shrunk(p.portal);
      const int to = p.is_left ? portal.right : portal.left;
      const Vec2 next = nearest_on(q.from, q.to, reached[cell].at);
      const Cost there{cost.first + (q.nearly ? 0 : 1), cost.second + norm(next - reached[cell].at)};
      if (!(there < reached[to].cost)) continue;
      reached[to] = {there, p.portal, next};
      queue.emplace(there, to);
    }
  }
  if (goal < 0) return false;
  std::vector<bool> from_left;
  way.start = goal;
  for (int& c = way.start; reached[c].through >= 0;) {
    const Portal& portal = map_.portals[reached[c].through];
    from_left.push_back(portal.right == c);
    way.portals.push_back(reached[c].through);
    c = from_left.back() ? portal.left : portal.right;
  }
  std::reverse(way.portals.begin(), way.portals.end());
  std::reverse(from_left.begin(), from_left.end());
  pull_through(s, t, from_left, way);
  return true;
}

/// The waypoints of the shortest curve through the portals of a way.
void WaySearch::pull_through(Vec2 s, Vec2 t, const std::vector<bool>& from_left, Way& way) const {
  std::vector<Waypoint> turns;
  const PortalRow row(plan_, way.portals, from_left);
  for (const Turn& turn : turns_through(row, s, t)) {
    const int vertex = row.vertex(turn.at, turn.left);
    if (vertex >= 0 && !plan_.shrunk(row.portal(turn.at)).tight)
      turns.push_back({-1, false, vertex, turn.left, static_cast<int>(turn.at)});
  }
  set_waypoints(turns, from_left, way);
}

}  // namespace exactvo::geometry::routing
