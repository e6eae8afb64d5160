// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/search.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <unordered_map>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pi.h"
#include "routes/funnel.h"

namespace exactvo::geometry::routing {
namespace {

/// m, as a share of the coordinates involved: a ray that passes an end of a portal this closely goes through it. It is
/// more than corners are off by, which come out of a division and a few products (2^-53 each).
constexpr double kRounding = 0x1p-45;

/// A share of a way's length that is more than the search's rounding makes of it.
constexpr double kSearchRounding = 0x1p-30;

Vec2 mirrored(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double squared = squared_norm(d);
  if (squared == 0.0) return p;
  const Vec2 n{-d.y, d.x};
  return p - (2.0 * dot(p - a, n) / squared) * n;
}

/// The length of the shortest way from `root` through the interval to t.
double way_through(Vec2 root, Vec2 left, Vec2 right, Vec2 t) {
  const Vec2 d = left - right;
  if (cross(d, t - right) > 0.0) t = mirrored(t, right, left);  // t lies on the root's side
  if (cross(left - root, t - root) > 0.0) return norm(left - root) + norm(t - left);
  if (cross(right - root, t - root) < 0.0) return norm(right - root) + norm(t - right);
  return norm(t - root);
}

/// Where a ray from `root` meets the line from `right` to `left`, as a share of it: -1 where it passes to the right of
/// both, 2 where to the left. An end nearer to the ray's line than `snap` lies on it: where the root itself lies on the
/// line, an end behind it would come to lie on the wrong side.
double share_met(Vec2 root, Vec2 ray, Vec2 right, Vec2 left, double snap) {
  const double on_line = snap * norm(ray);
  const auto side_of = [&](Vec2 end) {
    const double side = cross(ray, end - root);
    return std::fabs(side) <= on_line ? 0.0 : side;
  };
  const double r = side_of(right), l = side_of(left);
  if (r >= 0.0 && l >= 0.0) return r == 0.0 && l > 0.0 ? 0.0 : -1.0;
  if (r <= 0.0 && l <= 0.0) return 2.0;
  return r < 0.0 ? r / (r - l) : -1.0;
}

double snapped(double share, double length, double snap) {
  if (std::fabs(share) * length < snap) return 0.0;
  if (std::fabs(share - 1.0) * length < snap) return 1.0;
  return share;
}

Vec2 nearest_point(Vec2 a, Vec2 b, Vec2 x) {
  const Vec2 d = b - a;
  const double squared = squared_norm(d);
  return squared > 0.0 ? a + std::clamp(dot(x - a, d) / squared, 0.0, 1.0) * d : a;
}

/// Too short to aim with: a ray that passes through its own corner.
bool is_void(Vec2 ray, double size) {
  return norm(ray) <= 0x1p-51 * size;
}

}  // namespace

WaySearch::WaySearch(const ClearancePlan& plan, std::size_t most) : plan_(plan), map_(plan.map()), most_(most) {
  const std::size_t ends = 2 * map_.portals.size();
  best_.assign(ends, kInfinity);
  best_in_sector_.assign(ends, kInfinity);
  seen_ = seen_in_sector_ = Marks(ends);
  allowed_ = Marks(map_.cell_portals.size());
  corridor_of_.assign(ends, -1);
  place_in_corridor_.assign(ends, 0);
  in_corridor_ = Marks(ends);
}

std::optional<Way> WaySearch::find(Vec2 s, int start, Vec2 t, int goal) {
  Way way;
  steps_ = 0;
  was_second_search_ = false;
  if (start == goal) {
    way.lower_bound = norm(t - s);
    return way;
  }
  if (search(s, start, t, goal, way)) return way;
  way = {};
  was_second_search_ = true;
  if (search_nearly_open(s, start, t, goal, way)) return way;
  return std::nullopt;
}

WaySearch::Ends WaySearch::ends_seen(const CellMap::CellPortal& p) const {
  const ShrunkPortal& q = plan_.shrunk(p.portal);
  if (p.is_left) return {q.from, q.to, q.from_turns, q.to_turns};
  return {q.to, q.from, q.to_turns, q.from_turns};
}

int WaySearch::corner_at(int portal, Vec2 x) const {
  const ShrunkPortal& q = plan_.shrunk(portal);
  return 2 * portal + (norm(x - q.from) <= norm(x - q.to) ? 0 : 1);
}

bool WaySearch::search(Vec2 s, int start, Vec2 t, int goal, Way& way) {
  nodes_.clear();
  queue_.clear();
  beside_root_.clear();
  fresh_ = 0;
  corridors_.clear();
  goal_cell_ = goal;
  for (Marks* marks : {&seen_, &seen_in_sector_, &allowed_, &in_corridor_}) marks->clear();
  for (int c = goal; c >= 0; c = plan_.way_out(c)) allowed_.add(c);
  open_start(s, start);
  const std::size_t most = std::min(most_, 1000000 + 1000 * map_.cell_portals.size());
  bound_ = norm(t - s);
  while (nodes_.size() <= most) {
    // A single successor is expanded at once, several wait in the queue.
    const bool single = nodes_.size() == fresh_ + 1 && nodes_[fresh_].cell != goal;
    int number = static_cast<int>(fresh_);
    double bound = 0.0;
    if (!single) {
      queue_fresh(t);
      number = next_from_queue(bound);
      if (number < 0) return false;
    }
    fresh_ = nodes_.size();
    if (is_outdone(nodes_[number])) continue;
    if (nodes_[number].cell == goal) {
      trace(number, t, way);
      // Portals that rounding has shut were opened by up to twice the slack.
      way.lower_bound =
          std::max(norm(t - s), bound - 2.0 * kOpenSlack * plan_.radius() * static_cast<double>(way.portals.size()));
      return true;
    }
    expand(number);
  }
  queue_fresh(t);
  double bound = 0.0;
  if (next_from_queue(bound) >= 0) bound_ = std::max(bound_, (1.0 - kSearchRounding) * bound);
  return false;
}

void WaySearch::open_start(Vec2 s, int start) {
  for (const CellMap::CellPortal& p : map_.cell_portals[start]) {
    const Portal& portal = map_.portals[p.portal];
    const int to = p.is_left ? portal.right : portal.left;
    if (!plan_.shrunk(p.portal).open || !may_enter(start, to)) continue;
    const Ends e = ends_seen(p);
    add({to, p.portal, -1, -1, e.left, e.right, s, e.left - s, e.right - s, e.left_turns, e.right_turns, 0.0});
  }
}

void WaySearch::queue_fresh(Vec2 t) {
  for (; fresh_ < nodes_.size(); ++fresh_) {
    const Node& n = nodes_[fresh_];
    queue_.emplace_back(n.length + way_through(n.root, n.left, n.right, t), static_cast<int>(fresh_));
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
  }
}

int WaySearch::next_from_queue(double& bound) {
  if (queue_.empty()) return -1;
  std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
  const auto [best, number] = queue_.back();
  queue_.pop_back();
  bound = best;
  return number;
}

bool WaySearch::is_outdone(const Node& node) const {
  return node.corner >= 0 && is_outdone_at(node.corner, node.length);
}

/// The corner was reached before on a shorter way; or another corner round the same vertex was, so much earlier that
/// going round from there is no longer.
bool WaySearch::is_outdone_at(int corner, double length) const {
  constexpr double kSame = 0x1p-34;  // many times what rounding makes of the length of a way
  const double clearly_less = length - kSame * (length + plan_.shrunk(corner / 2).size);
  const int sector = plan_.sector(corner);
  return (seen_.has(corner) && best_[corner] < clearly_less) ||
         (seen_in_sector_.has(sector) && best_in_sector_[sector] + 2.0 * kPi * plan_.radius() < clearly_less);
}

/// Several portals may end at one root, where it lies on them or where the disc just fits through them. What goes round
/// such a root comes back to the same portal and sees the same there, bit for bit, and is not followed again.
void WaySearch::add(const Node& node) {
  const double size = std::max(size_of_root(node), plan_.shrunk(node.portal).size);
  if (norm(node.left - node.root) <= kRounding * size || norm(node.right - node.root) <= kRounding * size) {
    const Sight sight{static_cast<double>(node.corner),
                      static_cast<double>(node.portal),
                      static_cast<double>(node.cell),
                      node.left.x,
                      node.left.y,
                      node.right.x,
                      node.right.y,
                      node.left_ray.x,
                      node.left_ray.y,
                      node.right_ray.x,
                      node.right_ray.y};
    const auto [known, fresh] = beside_root_.emplace(sight, node.length);
    if (!fresh && known->second <= node.length) return;
    known->second = node.length;
  }
  nodes_.push_back(node);
}

double WaySearch::size_of_root(const Node& node) const {
  return node.corner < 0 ? largest_of(node.root) : plan_.shrunk(node.corner / 2).size;
}

// --- Leaps ---

Crossing WaySearch::crossing_into(int portal, int cell) const {
  const ShrunkPortal& q = plan_.shrunk(portal);
  const bool from_left = map_.portals[portal].right == cell;
  return {portal, cell, from_left ? q.to : q.from, from_left ? q.from : q.to, q.size};
}

/// The corridor that begins or goes on with this portal, crossed into `cell`, and the crossing's place in it.
int WaySearch::corridor_from(int portal, int cell, int& place) {
  const int key = 2 * portal + (map_.portals[portal].right == cell ? 1 : 0);
  if (!in_corridor_.has(key)) {
    in_corridor_.add(key);
    corridor_of_[key] = static_cast<int>(corridors_.size());
    place_in_corridor_[key] = 0;
    corridors_.emplace_back();
    corridors_.back().add(crossing_into(portal, cell));
  }
  place = place_in_corridor_[key];
  return corridor_of_[key];
}

/// False where the corridor ends before: at the goal, where there are several ways on or none, or another corridor.
bool WaySearch::grow(int number, int length) {
  Corridor& corridor = corridors_[number];
  while (corridor.size() < length) {
    const Crossing last = corridor[corridor.size() - 1];
    if (last.cell == goal_cell_) return false;
    int portal = -1, cell = -1;
    for (const CellMap::CellPortal& p : map_.cell_portals[last.cell]) {
      const Portal& beyond = map_.portals[p.portal];
      const int to = p.is_left ? beyond.right : beyond.left;
      if (p.portal == last.portal || !plan_.shrunk(p.portal).open || !may_enter(last.cell, to)) continue;
      if (portal >= 0) return false;
      portal = p.portal;
      cell = to;
    }
    if (portal < 0) return false;
    const int key = 2 * portal + (map_.portals[portal].right == cell ? 1 : 0);
    if (in_corridor_.has(key)) return false;
    in_corridor_.add(key);
    corridor_of_[key] = number;
    place_in_corridor_[key] = corridor.size();
    corridor.add(crossing_into(portal, cell));
  }
  return true;
}

/// Where the rays of the node's view meet the portal, as shares of it from right to left.
std::pair<double, double> WaySearch::shares_seen(const Node& n, const Crossing& c) const {
  const double snap = kRounding * std::max(size_of_root(n), c.size), width = norm(c.left - c.right);
  if (width < snap) return {-1.0, -1.0};
  const auto share = [&](Vec2 ray) { return snapped(share_met(n.root, ray, c.right, c.left, snap), width, snap); };
  return {share(n.right_ray), share(n.left_ray)};
}

/// Whether the view between the rays passes the portal without meeting an end of it.
bool WaySearch::passes(const Node& n, const Crossing& c) const {
  const auto [right, left] = shares_seen(n, c);
  return right > 0.0 && right < 1.0 && left > 0.0 && left < 1.0;
}

/// Takes the view on through the cell behind `at`, if it passes one portal of it as a whole: then it sees no other.
bool WaySearch::pass_on(const Node& n, Crossing& at) const {
  if (at.cell == goal_cell_) return false;
  for (const CellMap::CellPortal& p : map_.cell_portals[at.cell]) {
    const Portal& beyond = map_.portals[p.portal];
    const int to = p.is_left ? beyond.right : beyond.left;
    if (p.portal == at.portal || !plan_.shrunk(p.portal).open || !may_enter(at.cell, to)) continue;
    const Crossing next = crossing_into(p.portal, to);
    if (!passes(n, next)) continue;
    at = next;
    return true;
  }
  return false;
}

/// A view between two rays is taken through all portals that it passes without meeting an end: in between it has one
/// successor each, with the same rays.
void WaySearch::leap(int number) {
  const Node n = nodes_[number];
  const double size = size_of_root(n), size_here = std::max(size, plan_.shrunk(n.portal).size);
  if (n.left_turns || n.right_turns || n.cell == goal_cell_ || is_void(n.left_ray, size_here) ||
      is_void(n.right_ray, size_here))
    return;
  if (norm(n.left - n.root) <= kRounding * size_here || norm(n.right - n.root) <= kRounding * size_here) return;
  const View view{n.root, n.left_ray, n.right_ray, kRounding, size};
  Crossing at = crossing_into(n.portal, n.cell);
  do {
    int first = 0;
    const int corridor = corridor_from(at.portal, at.cell, first);
    const auto grown = [&](int length) {
      ++steps_;
      return grow(corridor, length);
    };
    const auto passes_one = [&](const Crossing& c) { return passes(n, c); };
    at = corridors_[corridor][corridors_[corridor].last_passed(first, view, grown, passes_one)];
    ++steps_;
  } while (pass_on(n, at));
  if (at.portal == n.portal && at.cell == n.cell) return;
  const auto [right, left] = shares_seen(n, at);
  Node& node = nodes_[number];
  node.first_portal = n.portal;
  node.first_cell = n.cell;
  node.portal = at.portal;
  node.cell = at.cell;
  node.right = at.right + right * (at.left - at.right);
  node.left = at.right + left * (at.left - at.right);
}

void WaySearch::expand(int number) {
  leap(number);
  const Node n = nodes_[number];
  if (n.cell == goal_cell_) {  // it has leapt there: to be taken in its turn
    nodes_.push_back(n);
    return;
  }
  for (const CellMap::CellPortal& p : map_.cell_portals[n.cell]) {
    const Portal& portal = map_.portals[p.portal];
    const int to = p.is_left ? portal.right : portal.left;
    if (p.portal == n.portal || !plan_.shrunk(p.portal).open || !may_enter(n.cell, to)) continue;
    ++steps_;
    const Ends e = ends_seen(p);
    const double width = norm(e.left - e.right);
    const double size = std::max(size_of_root(n), plan_.shrunk(p.portal).size), snap = kRounding * size;
    if (width < snap) {
      expand_to_point(number, p.portal, to, e, size);
      continue;
    }
    const double right =
        is_void(n.right_ray, size) ? -1.0 : snapped(share_met(n.root, n.right_ray, e.right, e.left, snap), width, snap);
    const double left =
        is_void(n.left_ray, size) ? 2.0 : snapped(share_met(n.root, n.left_ray, e.right, e.left, snap), width, snap);
    const auto at = [&](double share) {
      return share <= 0.0 ? e.right : share >= 1.0 ? e.left : e.right + share * (e.left - e.right);
    };
    if (right > 0.0 &&
        n.right_turns) {  // turning right round `right`, it sees from the portal's right end up to the ray
      const Vec2 end = at(right);
      turn(n, number, corner_at(n.portal, n.right), n.right, p.portal, to, end, e.right,
           right >= 1.0 ? end - n.right : n.right_ray, e.right - n.right, right >= 1.0 && e.left_turns, e.right_turns);
    }
    const double low = std::max(right, 0.0), high = std::min(left, 1.0);
    if (low < high) {
      const Vec2 l = at(high), r = at(low);
      add({to, p.portal, number, n.corner, l, r, n.root, high >= 1.0 ? l - n.root : n.left_ray,
           low <= 0.0 ? r - n.root : n.right_ray, high >= 1.0 && e.left_turns, low <= 0.0 && e.right_turns, n.length});
    }
    if (left < 1.0 && n.left_turns) {
      const Vec2 end = at(left);
      turn(n, number, corner_at(n.portal, n.left), n.left, p.portal, to, e.left, end, e.left - n.left,
           left <= 0.0 ? end - n.left : n.left_ray, e.left_turns, left <= 0.0 && e.right_turns);
    }
  }
}

/// A portal that the disc just fits through is a point: it is seen whole or not at all, and turned at on both sides.
void WaySearch::expand_to_point(int number, int portal, int to, const Ends& e, double size) {
  const Node n = nodes_[number];
  const auto beyond = [&](Vec2 ray, double side) {
    return !is_void(ray, size) && side * cross(ray, e.left - n.root) > kRounding * size * norm(ray);
  };
  if (beyond(n.left_ray, 1.0)) {
    if (n.left_turns)
      turn(n, number, corner_at(n.portal, n.left), n.left, portal, to, e.left, e.right, e.left - n.left,
           e.right - n.left, e.left_turns, e.right_turns);
  } else if (beyond(n.right_ray, -1.0)) {
    if (n.right_turns)
      turn(n, number, corner_at(n.portal, n.right), n.right, portal, to, e.left, e.right, e.left - n.right,
           e.right - n.right, e.left_turns, e.right_turns);
  } else {
    add({to, portal, number, n.corner, e.left, e.right, n.root, e.left - n.root, e.right - n.root, e.left_turns,
         e.right_turns, n.length});
  }
}

void WaySearch::turn(const Node& node, int parent, int corner, Vec2 root, int portal, int to, Vec2 left, Vec2 right,
                     Vec2 left_ray, Vec2 right_ray, bool left_turns, bool right_turns) {
  const double length = node.length + norm(root - node.root);
  if (is_outdone_at(corner, length)) return;
  const auto keep_least = [&](Marks& seen, std::vector<double>& best, int key) {
    if (!seen.has(key) || length < best[key]) {
      seen.add(key);
      best[key] = length;
    }
  };
  keep_least(seen_, best_, corner);
  keep_least(seen_in_sector_, best_in_sector_, plan_.sector(corner));
  add({to, portal, parent, corner, left, right, root, left_ray, right_ray, left_turns, right_turns, length});
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
  const auto vertex_at = [&](int corner) {
    const ShrunkPortal& q = plan_.shrunk(corner / 2);
    return corner % 2 ? q.to_corner : q.from_corner;
  };
  const auto place_of = [&](int portal, std::size_t otherwise) {
    const auto found = first_place.find(portal);
    return found == first_place.end() ? otherwise : found->second;
  };
  std::vector<Waypoint> list;
  const auto add_vertex = [&](int corner, std::size_t otherwise) {
    const std::size_t at = place_of(corner / 2, otherwise);
    const int vertex = vertex_at(corner);
    if (vertex < 0 || plan_.shrunk(corner / 2).tight) return;
    // Its portal's left cell sees `to` on the left.
    list.push_back({-1, false, vertex, from_left[at] == (corner % 2 == 1), static_cast<int>(at)});
  };

  for (std::size_t k = 0; k < way.portals.size(); ++k)
    if (plan_.shrunk(way.portals[k]).tight)
      list.push_back({way.portals[k], from_left[k], -1, false, static_cast<int>(k)});
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

  std::stable_sort(list.begin(), list.end(), [](const Waypoint& a, const Waypoint& b) { return a.at < b.at; });
  way.waypoints = std::move(list);
  drop_repeated(way.waypoints);
}

/// Of waypoints in a row that are pieces of one gate, or the same turn, the first.
void WaySearch::drop_repeated(std::vector<Waypoint>& list) const {
  const auto same = [&](const Waypoint& a, const Waypoint& b) {
    if ((a.portal < 0) != (b.portal < 0)) return false;
    if (a.portal < 0) return a.vertex == b.vertex && a.on_left == b.on_left;
    const Portal &p = map_.portals[a.portal], &q = map_.portals[b.portal];
    return p.link >= 0 && p.link == q.link;
  };
  list.erase(std::unique(list.begin(), list.end(), same), list.end());
}

// --- The second search ---

bool WaySearch::search_nearly_open(Vec2 s, int start, Vec2 t, int goal, Way& way) {
  way.lower_bound = bound_;
  // Portals that are clearly empty come last: a gate that the disc fits through may have some.
  using Cost = std::pair<int, double>;  // of those, how many; then the length, m
  struct Reached {
    Cost cost{std::numeric_limits<int>::max(), kInfinity};
    int through = -1;  ///< the portal
    Vec2 at;
  };
  std::vector<Reached> reached(map_.cell_portals.size());
  reached[start] = {{0, 0.0}, -1, s};
  std::priority_queue<std::pair<Cost, int>, std::vector<std::pair<Cost, int>>, std::greater<>> queue;
  queue.emplace(Cost{0, 0.0}, start);
  while (!queue.empty()) {
    const auto [cost, cell] = queue.top();
    queue.pop();
    if (cost > reached[cell].cost) continue;
    if (cell == goal) break;
    for (const CellMap::CellPortal& p : map_.cell_portals[cell]) {
      const Portal& portal = map_.portals[p.portal];
      if (portal.right < 0 || !plan_.admits(portal)) continue;
      const ShrunkPortal& q = plan_.shrunk(p.portal);
      const int to = p.is_left ? portal.right : portal.left;
      const Vec2 next = nearest_point(q.from, q.to, reached[cell].at);
      const Cost there{cost.first + (q.nearly ? 0 : 1), cost.second + norm(next - reached[cell].at)};
      if (!(there < reached[to].cost)) continue;
      reached[to] = {there, p.portal, next};
      queue.emplace(there, to);
    }
  }
  if (reached[goal].through < 0) return false;
  std::vector<bool> from_left;
  for (int c = goal; c != start;) {
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
  std::vector<Waypoint> list;
  for (std::size_t k = 0; k < way.portals.size(); ++k)
    if (plan_.shrunk(way.portals[k]).tight)
      list.push_back({way.portals[k], from_left[k], -1, false, static_cast<int>(k)});
  const PortalRow row(plan_, way.portals, from_left);
  for (const Turn& turn : turns_through(row, s, t)) {
    const int vertex = row.vertex(turn.at, turn.left);
    if (vertex >= 0 && !plan_.shrunk(row.portal(turn.at)).tight)
      list.push_back({-1, false, vertex, turn.left, static_cast<int>(turn.at)});
  }
  for (const Waypoint& w : list) way.waypoints.push_back(w);
  std::stable_sort(way.waypoints.begin(), way.waypoints.end(),
                   [](const Waypoint& a, const Waypoint& b) { return a.at < b.at; });
  drop_repeated(way.waypoints);
}

}  // namespace exactvo::geometry::routing
