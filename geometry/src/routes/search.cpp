// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/search.h"

#include <functional>

namespace exactvo::geometry::routing {
namespace {

/// m, as a share of the coordinates involved: a ray that passes an end of a portal this closely goes through it. It is
/// more than corners are off by, which come out of a division and a few products (2^-53 each).
constexpr double kRounding = 0x1p-45;

/// A share of a way's length that is more than the search's rounding makes of it.
constexpr double kSearchRounding = 0x1p-30;

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
double share_met(Vec2 root, Vec2 ray, double ray_length, Vec2 right, Vec2 left, double snap) {
  const double on_line = snap * ray_length;
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

/// Too short to aim with: a ray that passes through its own corner.
bool is_void(double ray_length, double size) {
  return ray_length <= 0x1p-51 * size;
}

}  // namespace

WaySearch::WaySearch(const ClearancePlan& plan, std::size_t most)
    : plan_(plan),
      map_(plan.map()),
      most_(most),
      best_(2 * map_.portals.size()),
      best_in_sector_(2 * map_.portals.size()),
      allowed_(map_.cell_portals.size()),
      in_corridor_(2 * map_.portals.size()) {}

std::optional<Way> WaySearch::find(Vec2 s, const std::vector<int>& starts, Vec2 t, const std::vector<int>& goals) {
  Way way;
  steps_ = 0;
  was_second_search_ = false;
  goal_cells_ = goals;
  const auto common = std::find_if(starts.begin(), starts.end(), [&](int cell) { return is_goal(cell); });
  if (common != starts.end()) {
    way.lower_bound = norm(t - s);
    way.start = *common;
    return way;
  }
  if (search(s, starts, t, way)) return way;
  way = {};
  was_second_search_ = true;
  if (search_nearly_open(s, starts, t, way)) return way;
  return std::nullopt;
}

int WaySearch::corner_at(int portal, Vec2 x) const {
  const ShrunkPortal& q = plan_.shrunk(portal);
  return 2 * portal + (norm(x - q.from) <= norm(x - q.to) ? 0 : 1);
}

bool WaySearch::search(Vec2 s, const std::vector<int>& starts, Vec2 t, Way& way) {
  nodes_.clear();
  queue_.clear();
  beside_root_.clear();
  fresh_ = 0;
  corridors_.clear();
  best_.clear();
  best_in_sector_.clear();
  allowed_.clear();
  in_corridor_.clear();
  for (const int goal : goal_cells_)
    for (int c = goal; c >= 0; c = plan_.way_out(c)) allowed_.set(c, 1);
  open_start(s, starts);
  const std::size_t most = std::min(most_, 1000000 + 1000 * map_.cell_portals.size());
  bound_ = norm(t - s);
  while (nodes_.size() <= most) {
    // A single successor is expanded at once, several wait in the queue.
    const bool single = nodes_.size() == fresh_ + 1 && !is_goal(nodes_[fresh_].cell);
    int number = static_cast<int>(fresh_);
    double bound = 0.0;
    if (!single) {
      queue_fresh(t);
      number = next_from_queue(bound);
      if (number < 0) return false;
    }
    fresh_ = nodes_.size();
    const Node& node = nodes_[number];
    if (node.corner >= 0 && is_outdone_at(node.corner, node.length, node.root_size)) continue;
    if (is_goal(nodes_[number].cell)) {
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

/// From one start cell into another no way leads that is shorter than straight into the other.
void WaySearch::open_start(Vec2 s, const std::vector<int>& starts) {
  for (const int start : starts) {
    for (const Passage& p : plan_.passages(start)) {
      if (!may_pass(p, start) || std::find(starts.begin(), starts.end(), p.to) != starts.end()) continue;
      add({p.to, p.portal, -1, -1, p.left, p.right, s, p.left - s, p.right - s, p.left_turns, p.right_turns,
           p.from_left, 0, 0.0, largest_coordinate(s)},
          p);
    }
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

/// The corner was reached before on a shorter way; or another corner round the same vertex was, so much earlier that
/// going on from there to this one is shorter.
bool WaySearch::is_outdone_at(int corner, double length, double size) const {
  constexpr double kSame = 0x1p-34;  // many times what rounding makes of the length of a way
  const double clearly_less = length - kSame * (length + size);
  const double* best = best_.find(corner);
  if (best != nullptr && *best < clearly_less) return true;
  const ClearancePlan::InSector& sector = plan_.sector(corner);
  const ReachedInSector* reached = best_in_sector_.find(sector.number);
  return reached != nullptr && reached->length + std::fabs(reached->at - sector.at) < clearly_less;
}

/// Several portals may end at one root, where it lies on them or where the disc just fits through them. What goes round
/// such a root comes back to the same portal and sees the same there, bit for bit, and is not followed again.
void WaySearch::add(const Node& node, const Passage& through) {
  const double size = std::max(node.root_size, through.size);
  const double beside = kRounding * size * kRounding * size;
  if (squared_norm(node.left - node.root) <= beside || squared_norm(node.right - node.root) <= beside) {
    const Key key{static_cast<double>(node.corner),
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
    const auto [known, fresh] = beside_root_.emplace(key, node.length);
    if (!fresh && known->second <= node.length) return;
    known->second = node.length;
  }
  nodes_.push_back(node);
}

// --- Leaps ---

Crossing WaySearch::crossing_into(int portal, int cell) const {
  const ShrunkPortal& q = plan_.shrunk(portal);
  const bool from_left = map_.portals[portal].right == cell;
  return {portal, cell, from_left ? q.to : q.from, from_left ? q.from : q.to, q.size};
}

/// The corridor that begins or goes on with this portal, crossed into `cell`, and the crossing's place in it.
WaySearch::InCorridor WaySearch::corridor_from(int portal, int cell) {
  const int key = 2 * portal + (map_.portals[portal].right == cell ? 1 : 0);
  if (in_corridor_.find(key) == nullptr) {
    in_corridor_.set(key, {static_cast<int>(corridors_.size()), 0});
    corridors_.emplace_back();
    corridors_.back().add(crossing_into(portal, cell));
  }
  return *in_corridor_.find(key);
}

/// False where the corridor ends before: at the goal, where there are several ways on or none, or another corridor.
bool WaySearch::grow(int number, int length) {
  Corridor& corridor = corridors_[number];
  while (corridor.size() < length) {
    const Crossing last = corridor[corridor.size() - 1];
    if (is_goal(last.cell)) return false;
    const Passage* on = nullptr;
    for (const Passage& p : plan_.passages(last.cell)) {
      if (p.portal == last.portal || !may_pass(p, last.cell)) continue;
      if (on != nullptr) return false;
      on = &p;
    }
    if (on == nullptr) return false;
    const int key = 2 * on->portal + (on->from_left ? 1 : 0);
    if (in_corridor_.find(key) != nullptr) return false;
    in_corridor_.set(key, {number, corridor.size()});
    corridor.add({on->portal, on->to, on->left, on->right, on->size});
  }
  return true;
}

/// Where the rays of the node's view meet the portal, as shares of it from right to left.
std::pair<double, double> WaySearch::shares_seen(const Node& n, const Crossing& c) const {
  const double snap = kRounding * std::max(n.root_size, c.size), width = norm(c.left - c.right);
  if (width < snap) return {-1.0, -1.0};
  const auto share = [&](Vec2 ray) {
    return snapped(share_met(n.root, ray, norm(ray), c.right, c.left, snap), width, snap);
  };
  return {share(n.right_ray), share(n.left_ray)};
}

/// Whether the view between the rays passes the portal without meeting an end of it.
bool WaySearch::passes(const Node& n, const Crossing& c) const {
  const auto [right, left] = shares_seen(n, c);
  return right > 0.0 && right < 1.0 && left > 0.0 && left < 1.0;
}

/// Takes the view on through the cell behind `at`, if it passes one portal of it as a whole: then it sees no other.
bool WaySearch::pass_on(const Node& n, Crossing& at) const {
  if (is_goal(at.cell)) return false;
  for (const Passage& p : plan_.passages(at.cell)) {
    if (p.portal == at.portal || !may_pass(p, at.cell)) continue;
    const Crossing next{p.portal, p.to, p.left, p.right, p.size};
    if (!passes(n, next)) continue;
    at = next;
    return true;
  }
  return false;
}

/// A view between two rays is taken through all portals that it passes without meeting an end: in between it has one
/// successor each, with the same rays.
void WaySearch::leap(int number) {
  constexpr int kFewPortals = 12;  // are passed as fast one by one
  const Node n = nodes_[number];
  if (n.straight < kFewPortals || is_goal(n.cell)) return;
  const double size_here = std::max(n.root_size, plan_.shrunk(n.portal).size);
  if (is_void(norm(n.left_ray), size_here) || is_void(norm(n.right_ray), size_here)) return;
  if (norm(n.left - n.root) <= kRounding * size_here || norm(n.right - n.root) <= kRounding * size_here) return;
  const View view{n.root, n.left_ray, n.right_ray, kRounding, n.root_size};
  Crossing at = crossing_into(n.portal, n.cell);
  do {
    const auto [corridor, first] = corridor_from(at.portal, at.cell);
    const auto grown = [&, number = corridor](int length) {
      ++steps_;
      return grow(number, length);
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
  node.from_left = map_.portals[at.portal].right == at.cell;
  node.right = at.right + right * (at.left - at.right);
  node.left = at.right + left * (at.left - at.right);
}

void WaySearch::expand(int number) {
  leap(number);
  const Node n = nodes_[number];
  if (is_goal(n.cell)) {  // it has leapt there: to be taken in its turn
    nodes_.push_back(n);
    return;
  }
  const double right_length = norm(n.right_ray), left_length = norm(n.left_ray);
  for (const Passage& p : plan_.passages(n.cell)) {
    if (p.portal == n.portal || !may_pass(p, n.cell)) continue;
    ++steps_;
    const double size = std::max(n.root_size, p.size), snap = kRounding * size;
    if (p.width < snap) {
      expand_to_point(number, p, size);
      continue;
    }
    const auto met = [&](Vec2 ray, double length) {
      return snapped(share_met(n.root, ray, length, p.right, p.left, snap), p.width, snap);
    };
    const double right = is_void(right_length, size) ? -1.0 : met(n.right_ray, right_length);
    const double left = is_void(left_length, size) ? 2.0 : met(n.left_ray, left_length);
    const auto at = [&](double share) {
      return share <= 0.0 ? p.right : share >= 1.0 ? p.left : p.right + share * (p.left - p.right);
    };
    if (right > 0.0 && n.right_turns) {  // turning right round `right`, it sees from the right end up to the ray
      const Vec2 end = at(right);
      turn(n, number, false, p,
           {end, p.right, right >= 1.0 ? end - n.right : n.right_ray, p.right - n.right, right >= 1.0 && p.left_turns,
            p.right_turns});
    }
    const double low = std::max(right, 0.0), high = std::min(left, 1.0);
    if (low < high) {
      const Vec2 l = at(high), r = at(low);
      const bool is_straight = low > 0.0 && high < 1.0;
      const int straight = is_straight ? std::min(n.straight + 1, 255) : 0;
      add({p.to, p.portal, number, n.corner, l, r, n.root, high >= 1.0 ? l - n.root : n.left_ray,
           low <= 0.0 ? r - n.root : n.right_ray, high >= 1.0 && p.left_turns, low <= 0.0 && p.right_turns, p.from_left,
           static_cast<std::uint8_t>(straight), n.length, n.root_size},
          p);
    }
    if (left < 1.0 && n.left_turns) {
      const Vec2 end = at(left);
      turn(n, number, true, p,
           {p.left, end, p.left - n.left, left <= 0.0 ? end - n.left : n.left_ray, p.left_turns,
            left <= 0.0 && p.right_turns});
    }
  }
}

/// A portal that the disc just fits through is a point: it is seen whole or not at all, and turned at on both sides.
void WaySearch::expand_to_point(int number, const Passage& p, double size) {
  const Node n = nodes_[number];
  const auto beyond = [&](Vec2 ray, double side) {
    const double length = norm(ray);
    return !is_void(length, size) && side * cross(ray, p.left - n.root) > kRounding * size * length;
  };
  const auto turn_round = [&](bool left) {
    const Vec2 root = left ? n.left : n.right;
    turn(n, number, left, p, {p.left, p.right, p.left - root, p.right - root, p.left_turns, p.right_turns});
  };
  if (beyond(n.left_ray, 1.0)) {
    if (n.left_turns) turn_round(true);
  } else if (beyond(n.right_ray, -1.0)) {
    if (n.right_turns) turn_round(false);
  } else {
    add({p.to, p.portal, number, n.corner, p.left, p.right, n.root, p.left - n.root, p.right - n.root, p.left_turns,
         p.right_turns, p.from_left, 0, n.length, n.root_size},
        p);
  }
}

void WaySearch::turn(const Node& node, int parent, bool round_left, const Passage& p, const Sight& seen) {
  const Vec2 root = round_left ? node.left : node.right;
  const int corner = round_left ? node.left_corner() : node.right_corner();
  const double length = node.length + norm(root - node.root), size = plan_.shrunk(node.portal).size;
  if (is_outdone_at(corner, length, size)) return;
  const double* best = best_.find(corner);
  if (best == nullptr || length < *best) best_.set(corner, length);
  const ClearancePlan::InSector& sector = plan_.sector(corner);
  const ReachedInSector* reached = best_in_sector_.find(sector.number);
  if (reached == nullptr || length < reached->length) best_in_sector_.set(sector.number, {length, sector.at});
  add({p.to, p.portal, parent, corner, seen.left, seen.right, root, seen.left_ray, seen.right_ray, seen.left_turns,
       seen.right_turns, p.from_left, 0, length, size},
      p);
}

}  // namespace exactvo::geometry::routing
