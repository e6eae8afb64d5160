// SPDX-License-Identifier: GPL-3.0-or-later
#include "walled_in.h"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;
using geometry::Segment;

namespace bg = boost::geometry;
using Corner = bg::model::point<double, 2, bg::cs::cartesian>;
using Box = bg::model::box<Corner>;
using BoxedEdge = std::pair<Box, std::size_t>;

/// m; so much narrower than the robot a gap must be, beyond what rounding asks for.
constexpr double kSlack = 1e-9;

Box box_of(const Segment& s, double wider) {
  return {{std::min(s.a.x, s.b.x) - wider, std::min(s.a.y, s.b.y) - wider},
          {std::max(s.a.x, s.b.x) + wider, std::max(s.a.y, s.b.y) + wider}};
}

/// A point that two segments with a point in common share, up to rounding.
Vec2 common_point(const Segment& s, const Segment& t) {
  const Vec2 d = s.b - s.a, e = t.b - t.a;
  const double det = cross(d, e);
  if (det != 0.0) return s.a + (cross(t.a - s.a, e) / det) * d;
  for (const Vec2 p : {t.a, t.b})
    if (norm(geometry::nearest_point(s, p) - p) == 0.0) return p;
  return geometry::nearest_point(t, s.a) == s.a ? s.a : s.b;
}

/// The ends of a shortest connector, the first on s.
Segment connector(const Segment& s, const Segment& t) {
  if (geometry::intersect(s, t)) {
    const Vec2 p = common_point(s, t);
    return {p, p};  // no gap: the point stands for one of both
  }
  const Segment choices[] = {{geometry::nearest_point(s, t.a), t.a},
                             {geometry::nearest_point(s, t.b), t.b},
                             {s.a, geometry::nearest_point(t, s.a)},
                             {s.b, geometry::nearest_point(t, s.b)}};
  return *std::min_element(std::begin(choices), std::end(choices),
                           [](const Segment& x, const Segment& y) { return norm(x.b - x.a) < norm(y.b - y.a); });
}

bool is_left(const Segment& line, Vec2 p) {
  return geometry::orientation(line.a, line.b, p) != geometry::Sign::negative;
}

/// Whether the path crosses the segment an odd number of times. A point on the segment's line counts as left of it, so
/// that the crossings of a closed path add up. Exact. REQUIRES: neither end of the segment on the path.
template <class Path>
bool crosses_oddly(const Path& path, const Segment& segment) {
  bool odd = false;
  for (std::size_t k = 1; k < path.size(); ++k) {
    if (is_left(segment, path[k - 1]) == is_left(segment, path[k])) continue;
    const Segment leg{path[k - 1], path[k]};
    if (is_left(leg, segment.a) != is_left(leg, segment.b)) odd = !odd;
  }
  return odd;
}

template <class Path>
bool comes_near(const Path& path, const Place& place) {
  for (std::size_t k = 1; k < path.size(); ++k)
    if (geometry::distance(Segment{path[k - 1], path[k]}, place.point) <= place.reach) return true;
  return false;
}

}  // namespace

Walls::Walls(const std::vector<SceneObstacle>& obstacles, double robot_radius) {
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    for (const Segment& s : geometry::edges_of(obstacles[k].shape)) edges_.push_back({s, k, {}});
  add_links(robot_radius);
  std::vector<geometry::Box> boxes;
  for (const Link& link : links_) {
    geometry::Box& box = boxes.emplace_back();
    for (const Vec2 p : link.path) box.add(p);
  }
  links_by_place_ = geometry::BoxGrid(std::move(boxes));
  number_parts();
}

void Walls::add_links(double robot_radius) {
  std::vector<BoxedEdge> boxes;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Segment& s = edges_[i].segment;
    for (const double x : {s.a.x, s.a.y, s.b.x, s.b.y}) largest_ = std::max(largest_, std::fabs(x));
    boxes.emplace_back(box_of(s, 0.0), i);
  }
  const double narrow = 2.0 * robot_radius - kSlack - 2.0 * geometry::rounding_of_distance(largest_);
  const bg::index::rtree<BoxedEdge, bg::index::rstar<16>> tree(boxes);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto within = bg::index::intersects(box_of(edges_[i].segment, 2.0 * robot_radius));
    for (auto found = tree.qbegin(within); found != tree.qend(); ++found) {
      const std::size_t j = found->second;
      if (j <= i) continue;
      const Segment gap = connector(edges_[i].segment, edges_[j].segment);
      const double length = norm(gap.b - gap.a);
      if (!(length < narrow)) continue;
      edges_[i].links.push_back(links_.size());
      edges_[j].links.push_back(links_.size());
      links_.push_back({i, j, {edges_[i].segment.a, gap.a, gap.b, edges_[j].segment.a}, length});
    }
  }
}

/// Numbers the connected parts of the graph.
void Walls::number_parts() {
  constexpr std::size_t kUnseen = std::numeric_limits<std::size_t>::max();
  part_.assign(edges_.size(), kUnseen);
  std::vector<std::size_t> queue;
  for (std::size_t root = 0; root < edges_.size(); ++root) {
    if (part_[root] != kUnseen) continue;
    part_[root] = root;
    queue.assign(1, root);
    while (!queue.empty()) {
      const std::size_t i = queue.back();
      queue.pop_back();
      for (const std::size_t l : edges_[i].links) {
        const std::size_t j = links_[l].from == i ? links_[l].to : links_[l].from;
        if (part_[j] != kUnseen) continue;
        part_[j] = root;
        queue.push_back(j);
      }
    }
  }
}

/// Only links whose boxes meet the way can cross it, and only those within reach of a place come near it.
std::vector<Walls::Use> Walls::uses_for(const Place& start, const Place& goal) const {
  std::vector<Use> uses(links_.size());
  for (const Place& place : {start, goal}) {
    const double largest = std::max({largest_, std::fabs(place.point.x), std::fabs(place.point.y)});
    const double reach = place.reach + 2.0 * geometry::rounding_of_distance(largest);
    links_by_place_.for_each_within(place.point, reach,
                                    [&](std::size_t l) { uses[l].is_taken |= comes_near(links_[l].path, place); });
  }
  const Segment way{start.point, goal.point};
  geometry::Box box;
  box.add(way.a);
  box.add(way.b);
  links_by_place_.for_each_meeting(box, [&](std::size_t l) {
    if (!uses[l].is_taken) uses[l].is_odd = crosses_oddly(links_[l].path, way);
  });
  return uses;
}

/// Spans every connected part of the graph by a tree, breadth first, with the parity of the crossings of the way to the
/// root at each edge. A link that contradicts the parities closes a chain that separates the places. In a part where no
/// link crosses oddly none does.
std::optional<Enclosing> Walls::between(const Place& start, const Place& goal) const {
  const std::vector<Use> uses = uses_for(start, goal);
  std::vector<char> is_crossed(edges_.size(), 0);  // of parts
  for (std::size_t l = 0; l < links_.size(); ++l)
    if (uses[l].is_odd) is_crossed[part_[links_[l].from]] = 1;
  constexpr std::size_t kUnseen = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> by(edges_.size(), kUnseen), parent(edges_.size()), depth(edges_.size(), 0);
  std::vector<char> odd(edges_.size(), 0), seen(edges_.size(), 0);
  std::vector<std::size_t> queue;
  for (std::size_t root = 0; root < edges_.size(); ++root) {
    if (seen[root] || !is_crossed[part_[root]]) continue;
    seen[root] = 1;
    queue.assign(1, root);
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const std::size_t i = queue[head];
      for (const std::size_t l : edges_[i].links) {
        if (l == by[i] || uses[l].is_taken) continue;
        const std::size_t j = links_[l].from == i ? links_[l].to : links_[l].from;
        const bool parity = (odd[i] != 0) != uses[l].is_odd;
        if (!seen[j]) {
          seen[j] = 1;
          by[j] = l;
          parent[j] = i;
          depth[j] = depth[i] + 1;
          odd[j] = parity;
          queue.push_back(j);
        } else if (parity != (odd[j] != 0)) {
          std::vector<std::size_t> chain{l};
          for (std::size_t a = i, b = j; a != b;) {
            std::size_t& deeper = depth[a] >= depth[b] ? a : b;
            chain.push_back(by[deeper]);
            deeper = parent[deeper];
          }
          return enclosing(chain, goal.point);
        }
      }
    }
  }
  return std::nullopt;
}

Enclosing Walls::enclosing(const std::vector<std::size_t>& chain, Vec2 goal) const {
  Enclosing e;
  Vec2 outside = goal;
  for (const std::size_t l : chain)
    for (const Vec2 p : links_[l].path) outside.x = std::max(outside.x, p.x + 1.0 + std::fabs(p.x));
  for (const std::size_t l : chain) {
    const Link& link = links_[l];
    e.around_goal = e.around_goal != crosses_oddly(link.path, Segment{goal, outside});
    e.widest_gap = std::max(e.widest_gap, link.gap);
    for (const std::size_t i : {link.from, link.to}) e.obstacles.push_back(edges_[i].obstacle);
  }
  std::sort(e.obstacles.begin(), e.obstacles.end());
  e.obstacles.erase(std::unique(e.obstacles.begin(), e.obstacles.end()), e.obstacles.end());
  return e;
}

}  // namespace exactvo::formation::detail
