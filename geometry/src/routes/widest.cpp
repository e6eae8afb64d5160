// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/widest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// The squared width of a gate as a fraction: numerator and denominator.
template <typename Convert>
std::pair<NumberOf<Convert>, NumberOf<Convert>> squared_width(const CellMap& map, const Portal& portal, Convert to) {
  using N = NumberOf<Convert>;
  if (portal.link < 0) {
    const Side& side = map.sides[portal.side];
    const auto d = to(map.vertex(side.b)) - to(map.vertex(side.a));
    return {N(dot(d, d)), N(to(1.0))};
  }
  const Link& link = map.links[portal.link];
  const auto d = to(map.vertex(link.b)) - to(map.vertex(link.a));
  const N area = cross(d, to(map.vertex(link.vertex)) - to(map.vertex(link.a)));
  return {N(squared(area)), N(dot(d, d))};
}

/// A side that ends at a corner of the square is no gate: it holds nothing up.
bool is_gate(const CellMap& map, const Portal& portal) {
  if (portal.link >= 0) return true;
  const Side& side = map.sides[portal.side];
  return map.is_site(side.a) && map.is_site(side.b);
}

bool is_wider(const CellMap& map, int one, int other) {
  const Portal &p = map.portals[one], &q = map.portals[other];
  const bool gate = is_gate(map, p), other_gate = is_gate(map, q);
  if (!gate || !other_gate) return !gate && other_gate;
  return sign_of([&](auto to) -> NumberOf<decltype(to)> {
           const auto a = squared_width(map, p, to), b = squared_width(map, q, to);
           return a.first * b.second - b.first * a.second;
         }) > 0;
}

/// The largest double r > 0 with f(r), which holds up to some number near `guess` and not beyond; 0 where there is
/// none.
template <typename F>
double largest_with(double guess, const F& f) {
  constexpr double kFirstStep = 0x1p-53;  // to a neighbour: the guess is mostly right, and each f near it is exact
  double low = guess, high = guess;
  for (double step = kFirstStep; !f(low); step *= 16.0) {
    high = low;
    if (step >= 1.0 || low == 0.0) {
      low = 0.0;
      break;
    }
    low = std::min(std::nextafter(low, 0.0), guess * (1.0 - step));
  }
  // From the last one on, not from the guess: that may be 0 where the distance to a crossing of walls rounds to it.
  for (double step = kFirstStep; high == low; step *= 16.0) {
    const double next = std::max(std::nextafter(low, kInfinity), low * (1.0 + step));
    (f(next) ? low : high) = next;
    if (low == next) high = low;
    if (!(next < kInfinity)) return low;
  }
  while (std::nextafter(low, kInfinity) < high) {
    const double middle = low + 0.5 * (high - low);
    const double inside = middle > low && middle < high ? middle : std::nextafter(low, kInfinity);
    (f(inside) ? low : high) = inside;
  }
  return low;
}

}  // namespace

GateTree::GateTree(const CellMap& map) : map_(&map) {
  std::vector<int> portals;
  for (std::size_t p = 0; p < map.portals.size(); ++p)
    if (map.portals[p].right >= 0) portals.push_back(static_cast<int>(p));
  std::stable_sort(portals.begin(), portals.end(), [&](int p, int q) { return is_wider(map, p, q); });
  const std::size_t count = map.cell_portals.size();
  parent_.resize(count);
  std::iota(parent_.begin(), parent_.end(), 0);
  joined_.assign(count, std::numeric_limits<int>::max());
  std::vector<int> size(count, 1);
  for (const int p : portals) {
    int a = root_of(map.portals[p].left), b = root_of(map.portals[p].right);
    if (a == b) continue;
    if (size[a] < size[b]) std::swap(a, b);
    parent_[b] = a;  // the smaller under the larger: at most log2(n) steps to a root
    size[a] += size[b];
    joined_[b] = static_cast<int>(gates_.size());
    gates_.push_back(p);
  }
}

int GateTree::root_of(int cell) const {
  while (parent_[cell] != cell) cell = parent_[cell];
  return cell;
}

bool GateTree::connects(int one, int other) const {
  return root_of(one) == root_of(other);
}

double GateTree::widest_radius(int one, int other) const {
  int last = -1;
  while (one != other) {
    int& earlier = joined_[one] < joined_[other] ? one : other;
    last = std::max(last, joined_[earlier]);
    earlier = parent_[earlier];
  }
  if (last < 0 || !is_gate(*map_, map_->portals[gates_[last]])) return kInfinity;
  const Portal& portal = map_->portals[gates_[last]];
  if (portal.link >= 0) {
    const Link& link = map_->links[portal.link];
    return largest_with(0.5 * link.length, [&](double r) { return map_->link_admits(link, r); });
  }
  const Side& side = map_->sides[portal.side];
  return largest_with(0.5 * norm(map_->vertex(side.b).rounded() - map_->vertex(side.a).rounded()),
                      [&](double r) { return map_->side_admits(side, r); });
}

bool is_clear(const CellMap& map, const PieceTree& grid, Vec2 x, double r) {
  const Point p = x;
  return grid.for_each_near(x, x, r, [&](int piece) {
    const auto [a, b] = map.ends_of(piece);
    return compare_segment_distance(p, map.vertex(a), map.vertex(b), r) >= 0;
  });
}

double clearance_of(const CellMap& map, const PieceTree& grid, Vec2 x) {
  if (map.graph.vertices.empty()) return kInfinity;
  // A distance at which some piece is found, then the least of those within it.
  double nearest = norm(map.vertex(0).rounded() - x);
  for (double r = 0x1p-20 * nearest; r < nearest; r *= 4.0) {
    grid.for_each_near(x, x, r, [&](int piece) {
      const auto [a, b] = map.ends_of(piece);
      const Segment s{map.vertex(a).rounded(), map.vertex(b).rounded()};
      nearest = std::min(nearest, distance(s, x));
      return true;
    });
  }
  return largest_with(nearest, [&](double r) { return is_clear(map, grid, x, r); });
}

}  // namespace exactvo::geometry::routing
