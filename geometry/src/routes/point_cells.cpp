// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>

#include "routes/cell_map.h"
#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// A view looks at every portal of a cell that it comes into.
constexpr int kMostPortals = 12;

/// The borders of cells as rings of half-edges. Half-edge 3 f + i is side i of triangle f, which lies to its left.
class CellJoiner {
 public:
  explicit CellJoiner(const CellMap& map)
      : map_(map), removed_(3 * map.triangles.size(), 0), cells_(map.triangles.size()) {
    const std::size_t count = removed_.size();
    next_.resize(count);
    previous_.resize(count);
    portals_.resize(map.triangles.size());
    for (int h = 0; h < static_cast<int>(count); ++h) {
      const int first = h - h % 3;
      next_[h] = first + (h + 1) % 3;
      previous_[h] = first + (h + 2) % 3;
      portals_[h / 3] += is_portal(h) ? 1 : 0;
    }
  }

  void join_all() {
    for (int h = 0; h < static_cast<int>(next_.size()); ++h)
      if (is_portal(h) && h < twin(h)) join_across(h);
  }

  bool is_removed(int h) const { return removed_[h] != 0; }
  int next(int h) const { return next_[h]; }
  int origin(int h) const { return map_.triangles[h / 3].vertex[(h % 3 + 1) % 3]; }
  int end(int h) const { return map_.triangles[h / 3].vertex[(h % 3 + 2) % 3]; }
  int side(int h) const { return map_.side_of[h / 3][h % 3]; }
  int twin(int h) const {
    const int beyond = map_.triangles[h / 3].neighbour[h % 3];
    const std::array<int, 3>& sides = map_.side_of[beyond];
    return 3 * beyond + static_cast<int>(std::find(sides.begin(), sides.end(), side(h)) - sides.begin());
  }
  bool is_portal(int h) const {
    const Triangle& t = map_.triangles[h / 3];
    return t.free && t.wall[h % 3] < 0 && t.neighbour[h % 3] >= 0;
  }
  /// One of its triangles.
  std::size_t cell_of(int triangle) { return cells_.find_set(triangle); }

 private:
  int turn(int a, int b) const { return orient(map_.vertex(origin(a)), map_.vertex(origin(b)), map_.vertex(end(b))); }

  /// Whether b may follow a. Where they lie on one line, b goes on as a came, not back from the end of a wall, and one
  /// of them is a wall that no other piece of that line follows: so no two portals of a cell lie on one line.
  bool may_follow(int a, int b) const {
    const int sign = turn(a, b);
    if (sign != 0) return sign > 0;
    const Point &from = map_.vertex(origin(a)), &corner = map_.vertex(origin(b)), &to = map_.vertex(end(b));
    if (along(to, corner, from, corner) <= 0) return false;
    return (!is_portal(a) && turn(previous_[a], a) > 0) || (!is_portal(b) && turn(b, next_[b]) > 0);
  }

  void join_across(int h) {
    const int t = twin(h);
    const std::size_t one = cell_of(h / 3), other = cell_of(t / 3);
    const int portals = portals_[one] + portals_[other] - 2;
    if (one == other || portals > kMostPortals) return;
    if (!may_follow(previous_[h], next_[t]) || !may_follow(previous_[t], next_[h])) return;
    link(previous_[h], next_[t]);
    link(previous_[t], next_[h]);
    removed_[h] = removed_[t] = 1;
    cells_.link(one, other);
    portals_[cell_of(h / 3)] = portals;
  }
  void link(int a, int b) {
    next_[a] = b;
    previous_[b] = a;
  }

  const CellMap& map_;
  std::vector<char> removed_;
  std::vector<int> next_, previous_;
  boost::disjoint_sets_with_storage<> cells_;  ///< of triangles
  std::vector<int> portals_;                   ///< of the triangle that stands for a cell
};

}  // namespace

CellMap::CellMap(const CellMap& map, ForPoints) : CellMap(map, Uncut{}) {
  CellJoiner joiner(*this);
  joiner.join_all();
  std::vector<int> number(triangles.size(), -1), portal_of(sides.size(), -1);
  for (int h = 0; h < static_cast<int>(3 * triangles.size()); ++h) {
    if (!triangles[h / 3].free || joiner.is_removed(h) || number[joiner.cell_of(h / 3)] >= 0) continue;
    const int cell = number[joiner.cell_of(h / 3)] = static_cast<int>(cell_portals.size());
    cell_portals.emplace_back();
    int at = h;
    do {
      if (!joiner.is_portal(at)) continue;
      int& slot = portal_of[joiner.side(at)];
      const bool is_left = slot < 0;
      if (is_left) {
        slot = static_cast<int>(portals.size());
        Portal portal;
        portal.side = joiner.side(at);
        portal.from.vertex = joiner.origin(at);
        portal.to.vertex = joiner.end(at);
        portals.push_back(portal);
      }
      (is_left ? portals[slot].left : portals[slot].right) = cell;
      cell_portals.back().push_back({slot, is_left});
    } while ((at = joiner.next(at)) != h);
  }
  cell_chords.resize(cell_portals.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) first_cell.push_back(number[joiner.cell_of(static_cast<int>(f))]);
  first_cell.push_back(static_cast<int>(cell_portals.size()));
}

}  // namespace exactvo::geometry::routing
