// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/plan.h"

#include <boost/pending/disjoint_sets.hpp>

#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// Gates up to this many diameters wide are crossed through their exact middle.
constexpr double kTight = 1.01;

/// Where a Link crosses the line x + s u, |u| = 1.
double crossing_at(const CellMap& map, int link, Vec2 x, Vec2 u) {
  const Link& l = map.links[link];
  const Vec2 d = map.vertex(l.b).rounded() - map.vertex(l.a).rounded();
  return dot(map.vertex(l.vertex).rounded() - x, d) / dot(u, d);
}

/// One end of a piece of a side, moved inward (dir = 1 or -1 along u) until the centre is clear of what is there.
struct MovedEnd {
  double at;
  int corner;
  bool turns;
  bool moved;
};

MovedEnd moved_from_vertex(const CellMap& map, int vertex, double at, double dir, double r) {
  if (!map.is_site(vertex)) return {at, -1, false, false};
  return {at + dir * r, vertex, true, true};
}

/// Out of the circle round the Link's vertex, and out of the strip along its wall (up to where the foot leaves the
/// wall: beyond that the strip is no bound).
MovedEnd moved_from_link(const CellMap& map, int link, Vec2 x, Vec2 u, double dir, double r) {
  const Link& l = map.links[link];
  const Vec2 v = map.vertex(l.vertex).rounded(), a = map.vertex(l.a).rounded(), d = map.vertex(l.b).rounded() - a;
  const double start = crossing_at(map, link, x, u);
  MovedEnd end{start, -1, true, false};
  const Vec2 z = x + start * u;
  if (norm(z - v) < r) {
    const double b = dot(u, z - v), c = squared_norm(z - v) - r * r;
    end.at += dir * (-dir * b + std::sqrt(std::max(0.0, b * b - c)));
    end.corner = l.vertex;
  }
  const double height = cross(d, z - a) / norm(d), slope = dir * cross(d, u) / norm(d);
  constexpr double kParallel = 1e-12;
  if (height < r && slope > kParallel) {
    double needed = start + dir * (r - height) / slope;
    const double pace = dot(u, d), at = dot(x - a, d);
    if (pace != 0.0) {
      const double leaves = (dir * pace > 0.0 ? squared_norm(d) - at : -at) / pace;
      needed = dir > 0.0 ? std::min(needed, leaves) : std::max(needed, leaves);
    }
    if (dir > 0.0 ? needed > end.at : needed < end.at) {
      end.at = needed;
      end.corner = -1;
    }
  }
  end.moved = end.at != start;
  return end;
}

}  // namespace

ClearancePlan::ClearancePlan(const CellMap& map, const PieceTree& grid, double radius)
    : map_(&map), grid_(&grid), radius_(radius) {
  decide_gates();
  find_components();
  if (!map.has_all_gates()) return;  // no search will be
  shrink_all();
  find_turns();
  find_sectors();
  find_ways_out();
  list_passages();
}

void ClearancePlan::decide_gates() {
  link_admits_.reserve(map_->links.size());
  side_admits_.reserve(map_->sides.size());
  for (const Link& link : map_->links) link_admits_.push_back(map_->link_admits(link, radius_));
  for (const Side& side : map_->sides) side_admits_.push_back(side.right >= 0 && map_->side_admits(side, radius_));
}

void ClearancePlan::find_components() {
  boost::disjoint_sets_with_storage<> cells(map_->cell_portals.size());
  for (const Portal& portal : map_->portals)
    if (portal.right >= 0 && admits(portal)) cells.union_set(portal.left, portal.right);
  for (std::size_t c = 0; c < map_->cell_portals.size(); ++c) component_.push_back(cells.find_set(c));
}

void ClearancePlan::shrink_all() {
  shrunk_.reserve(map_->portals.size());
  for (const Portal& portal : map_->portals) {
    const bool passed = portal.right >= 0 && admits(portal);
    shrunk_.push_back(!passed ? ShrunkPortal{} : portal.link >= 0 ? shrunk_link(portal) : shrunk_side(portal));
  }
}

ShrunkPortal ClearancePlan::shrunk_link(const Portal& portal) const {
  const Link& link = map_->links[portal.link];
  const Vec2 v = map_->vertex(link.vertex).rounded();
  const Vec2 d = map_->vertex(link.b).rounded() - map_->vertex(link.a).rounded();
  const Vec2 u = Vec2{d.y, -d.x} / norm(d);  // towards the wall
  const auto crossing = [&](int k) {
    const Link::Exit& exit = link.exits[k];
    const Side& side = map_->sides[map_->side_of[exit.triangle][exit.side]];
    const Vec2 x = map_->vertex(side.a).rounded(), y = map_->vertex(side.b).rounded();
    return dot(x + dot(v - x, d) / dot(y - x, d) * (y - x) - v, u);
  };
  const bool last = portal.piece + 1 == static_cast<int>(link.exits.size());
  const double begins = portal.piece == 0 ? 0.0 : crossing(portal.piece - 1);
  const double ends = last ? link.length : crossing(portal.piece);
  double low = std::max(begins, radius_), high = std::min(ends, link.length - radius_);
  ShrunkPortal out;
  const double slack = kOpenSlack * radius_;
  out.open = low <= high + slack;
  out.nearly = low <= high + 1e3 * slack;
  out.tight = link.length < 2.0 * kTight * radius_;
  if (low > high) low = high = 0.5 * (low + high);  // rounding has turned the interval over
  out.from = v + low * u;
  out.to = v + high * u;
  out.size = std::max({largest_coordinate(v), largest_coordinate(out.from), largest_coordinate(out.to), link.length});
  out.from_corner = portal.piece == 0 || begins < radius_ || out.tight ? link.vertex : -1;
  out.from_moved = portal.piece == 0 || low != begins;
  out.to_moved = last || high != ends;
  if (!portal.outward) {
    std::swap(out.from, out.to);
    std::swap(out.from_corner, out.to_corner);
    std::swap(out.from_moved, out.to_moved);
  }
  return out;
}

/// Positions are counted from an end that is a site: the other may be a corner of the square, far away.
ShrunkPortal ClearancePlan::shrunk_side(const Portal& portal) const {
  const Side& side = map_->sides[portal.side];
  const bool turned = !map_->is_site(side.a);
  const int first = turned ? side.b : side.a, second = turned ? side.a : side.b;
  const Vec2 x = map_->vertex(first).rounded(), y = map_->vertex(second).rounded();
  const double length = norm(y - x);
  const Vec2 u = (y - x) / length;
  const auto position = [&](const PortalEnd& end) {
    return end.vertex >= 0 ? (end.vertex == first ? 0.0 : length) : crossing_at(*map_, end.link, x, u);
  };
  const bool forward = portal.from.vertex == first || portal.to.vertex == second ||
                       (portal.from.vertex < 0 && portal.to.vertex < 0 && position(portal.from) < position(portal.to));
  const auto moved = [&](const PortalEnd& end, double dir) {
    return end.vertex >= 0 ? moved_from_vertex(*map_, end.vertex, position(end), dir, radius_)
                           : moved_from_link(*map_, end.link, x, u, dir, radius_);
  };
  MovedEnd from = moved(portal.from, forward ? 1.0 : -1.0), to = moved(portal.to, forward ? -1.0 : 1.0);
  const double gap = forward ? to.at - from.at : from.at - to.at;
  ShrunkPortal out;
  const double slack = kOpenSlack * radius_;
  out.open = gap >= -slack;
  out.nearly = gap >= -1e3 * slack;
  out.tight = portal.from.vertex >= 0 && portal.to.vertex >= 0 && map_->is_site(side.a) && map_->is_site(side.b) &&
              length < 2.0 * kTight * radius_;
  if (gap < 0.0) from.at = to.at = 0.5 * (from.at + to.at);
  out.from = x + from.at * u;
  out.to = x + to.at * u;
  if (radius_ == 0.0) {  // in the same bits on every side that ends at the vertex: a funnel asks which of two is where
    if (portal.from.vertex >= 0) out.from = map_->vertex(portal.from.vertex).rounded();
    if (portal.to.vertex >= 0) out.to = map_->vertex(portal.to.vertex).rounded();
  }
  out.from_corner = from.corner;
  out.to_corner = to.corner;
  out.from_turns = from.turns;
  out.to_turns = to.turns;
  out.size = largest_coordinate(x);  // of an end where nothing turns it does not matter
  if (from.turns) out.size = std::max({out.size, largest_coordinate(out.from), std::fabs(from.at)});
  if (to.turns) out.size = std::max({out.size, largest_coordinate(out.to), std::fabs(to.at)});
  out.from_moved = from.moved || gap < 0.0;
  out.to_moved = to.moved || gap < 0.0;
  return out;
}

/// Where a Link crosses a side four portals meet. Where all of them are open up to the crossing, no shortest path turns
/// there.
void ClearancePlan::find_turns() {
  std::vector<std::size_t> first{0};  // of a Link's crossings
  for (const Link& link : map_->links) first.push_back(first.back() + link.exits.size());
  struct Crossing {
    struct End {
      std::size_t portal;
      bool is_from;
    };
    End ends[4];
    int count = 0;
    void add(std::size_t portal, bool is_from) {
      if (count < 4) ends[count] = {portal, is_from};
      ++count;
    }
  };
  std::vector<Crossing> meeting(first.back());
  for (std::size_t p = 0; p < map_->portals.size(); ++p) {
    const Portal& portal = map_->portals[p];
    if (portal.link >= 0) {
      const std::size_t base = first[portal.link] + static_cast<std::size_t>(portal.piece);
      if (portal.piece > 0) meeting[base - 1].add(p, portal.outward);
      meeting[base].add(p, !portal.outward);
      continue;
    }
    for (const bool is_from : {true, false}) {
      const int link = (is_from ? portal.from : portal.to).link;
      if (link < 0) continue;
      const std::vector<Link::Exit>& exits = map_->links[link].exits;
      std::size_t k = 0;
      while (map_->side_of[exits[k].triangle][exits[k].side] != portal.side) ++k;
      meeting[first[link] + k].add(p, is_from);
    }
  }
  for (std::size_t l = 0; l < map_->links.size(); ++l) {
    for (std::size_t k = first[l]; k + 1 < first[l + 1]; ++k) {  // the last lies on the wall
      const Crossing& c = meeting[k];
      const bool all_reach = c.count == 4 && std::all_of(c.ends, c.ends + 4, [&](const Crossing::End& end) {
                               const ShrunkPortal& q = shrunk_[end.portal];
                               return q.open && !(end.is_from ? q.from_moved : q.to_moved);
                             });
      if (!all_reach) continue;
      for (const Crossing::End& end : c.ends)
        (end.is_from ? shrunk_[end.portal].from_turns : shrunk_[end.portal].to_turns) = false;
    }
  }
}

/// Going round a cell counter-clockwise, one portal ends at a corner and the next begins there: round the corner that
/// is one direction. So the ends of a sector are a chain, or a ring, which is opened anywhere.
void ClearancePlan::find_sectors() {
  const std::size_t count = 2 * map_->portals.size();
  std::vector<int> next(count, -1);
  std::vector<char> is_first(count, 1);
  for (const auto& portals : map_->cell_portals) {
    for (std::size_t k = 0; k < portals.size(); ++k) {
      const auto [one, one_left] = portals[k];
      const auto [two, two_left] = portals[k + 1 < portals.size() ? k + 1 : 0];
      const ShrunkPortal &p = shrunk_[one], &q = shrunk_[two];
      if (one == two || !p.open || !q.open) continue;
      const int corner = one_left ? p.to_corner : p.from_corner;
      if (corner < 0 || corner != (two_left ? q.from_corner : q.to_corner)) continue;
      next[2 * one + (one_left ? 1 : 0)] = 2 * two + (two_left ? 0 : 1);
      is_first[2 * two + (two_left ? 0 : 1)] = 0;
    }
  }
  sectors_.assign(count, {-1, 0.0});
  const auto number_from = [&](int first) {
    double at = 0.0;
    for (int end = first; end >= 0 && sectors_[end].number < 0; end = next[end]) {
      sectors_[end] = {first, at};
      if (next[end] >= 0) at += norm(end_at(next[end]) - end_at(end));
    }
  };
  for (std::size_t end = 0; end < count; ++end)
    if (is_first[end]) number_from(static_cast<int>(end));
  for (std::size_t end = 0; end < count; ++end)
    if (sectors_[end].number < 0) number_from(static_cast<int>(end));  // a ring
}

void ClearancePlan::find_ways_out() {
  const std::size_t count = map_->cell_portals.size();
  std::vector<int> exits(count, 0), dead_ends;
  way_out_.assign(count, -1);
  for (std::size_t c = 0; c < count; ++c) {
    for (const CellMap::CellPortal& p : map_->cell_portals[c]) exits[c] += shrunk_[p.portal].open ? 1 : 0;
    if (exits[c] == 1) dead_ends.push_back(static_cast<int>(c));
  }
  while (!dead_ends.empty()) {
    const int cell = dead_ends.back();
    dead_ends.pop_back();
    if (exits[cell] != 1 || way_out_[cell] >= 0) continue;
    for (const CellMap::CellPortal& p : map_->cell_portals[cell]) {
      if (!shrunk_[p.portal].open) continue;
      const Portal& portal = map_->portals[p.portal];
      const int to = p.is_left ? portal.right : portal.left;
      if (way_out_[to] >= 0) continue;
      way_out_[cell] = to;
      if (--exits[to] == 1) dead_ends.push_back(to);
    }
  }
}

void ClearancePlan::list_passages() {
  std::size_t open = 0;
  for (const ShrunkPortal& q : shrunk_) open += q.open ? 2 : 0;
  passages_.reserve(open);
  first_passage_.reserve(map_->cell_portals.size() + 1);
  for (const auto& portals : map_->cell_portals) {
    first_passage_.push_back(passages_.size());
    for (const auto& [number, is_left] : portals) {
      const ShrunkPortal& q = shrunk_[number];
      if (!q.open) continue;
      const Portal& portal = map_->portals[number];
      const int to = is_left ? portal.right : portal.left;
      passages_.push_back({is_left ? q.to : q.from, is_left ? q.from : q.to, norm(q.to - q.from), q.size, number, to,
                           is_left ? q.to_turns : q.from_turns, is_left ? q.from_turns : q.to_turns, is_left,
                           way_out_[to] >= 0});
    }
  }
  first_passage_.push_back(passages_.size());
}

namespace {

/// The strip of width r round a straight piece.
class Strip {
 public:
  Strip(Vec2 p, Vec2 q, double r) : p_(p), length_(norm(q - p)), along_((q - p) / length_), r_(r) {
    size_ = std::fabs(p.x) + std::fabs(p.y) + length_;
  }

  /// Whether ab lies, with room for every rounding, on one side of it.
  bool is_clearly_apart(Vec2 a, Vec2 b) const {
    constexpr double kShort = 0x1p-400;  // m: a square of it would underflow
    if (!(length_ > kShort)) return false;
    const double size = size_ + std::fabs(a.x) + std::fabs(a.y) + std::fabs(b.x) + std::fabs(b.y);
    const double far = r_ * (1.0 + 1e-6) + 0x1p-40 * size;
    const double a_left = cross(along_, a - p_), b_left = cross(along_, b - p_);
    if ((a_left > far && b_left > far) || (a_left < -far && b_left < -far)) return true;
    const double a_on = dot(along_, a - p_), b_on = dot(along_, b - p_);
    return (a_on < -far && b_on < -far) || (a_on > length_ + far && b_on > length_ + far);
  }

 private:
  Vec2 p_;
  double length_;
  Vec2 along_;
  double r_, size_;
};

}  // namespace

int ClearancePlan::piece_too_near(const Point& x) const {
  int found = -1;
  grid_->for_each_near(x.rounded(), x.rounded(), radius_, [&](int piece) {
    const auto [a, b] = map_->ends_of(piece);
    if ((found < 0 || piece < found) && is_too_near(x, map_->vertex(a), map_->vertex(b), radius_)) found = piece;
    return true;
  });
  return found;
}

std::vector<int> ClearancePlan::pieces_within(Vec2 x, double r) const {
  std::vector<int> found;
  grid_->for_each_near(x, x, r, [&](int piece) {
    const auto [a, b] = map_->ends_of(piece);
    if (compare_segment_distance(x, map_->vertex(a), map_->vertex(b), r) < 0) found.push_back(piece);
    return true;
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool ClearancePlan::is_clear(const Point& p, const Point& q) const {
  const Strip strip(p.rounded(), q.rounded(), radius_);
  return grid_->for_each_near(p.rounded(), q.rounded(), radius_, [&](int piece) {
    const auto [i, j] = map_->ends_of(piece);
    const Point &a = map_->vertex(i), &b = map_->vertex(j);
    return strip.is_clearly_apart(a.rounded(), b.rounded()) || keeps_clear(p, q, a, b, radius_);
  });
}

bool ClearancePlan::is_clear_but_at(const Point& p, const Point& q, bool p_may, bool q_may) const {
  const Strip strip(p.rounded(), q.rounded(), 0.0);
  return grid_->for_each_near(p.rounded(), q.rounded(), 0.0, [&](int piece) {
    const auto [i, j] = map_->ends_of(piece);
    const Point &a = map_->vertex(i), &b = map_->vertex(j);
    return strip.is_clearly_apart(a.rounded(), b.rounded()) || !touch(p, q, a, b, p_may, q_may);
  });
}

}  // namespace exactvo::geometry::routing
