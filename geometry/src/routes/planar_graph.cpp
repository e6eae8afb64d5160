// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/planar_graph.h"

#include <CGAL/Bbox_2.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <cstdint>
#include <cstring>
#include <map>
#include <unordered_map>

#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// An edge of one or several obstacles with the points at which it is cut, besides its ends.
struct CutEdge {
  Segment segment;
  int winding;    ///< how many more solids lie on its left than on its right, of those that it bounds
  EdgeName name;  ///< of the first
  std::vector<Point> cuts;
};

using Bits = std::pair<std::uint64_t, std::uint64_t>;

Bits bits_of(Vec2 p) {
  const double x = p.x + 0.0, y = p.y + 0.0;  // -0 is 0
  Bits bits;
  std::memcpy(&bits.first, &x, sizeof x);
  std::memcpy(&bits.second, &y, sizeof y);
  return bits;
}

/// Equal ones once: each pair of edges that meet is looked at.
std::vector<CutEdge> edges_of_all(const std::vector<Obstacle>& obstacles) {
  std::vector<CutEdge> all;
  all.reserve(obstacles.size());
  std::unordered_map<std::pair<Bits, Bits>, std::size_t, boost::hash<std::pair<Bits, Bits>>> by_ends;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::vector<Segment> edges = edges_of(obstacles[i]);
    const int solids = has_interior(obstacles[i]) ? 1 : 0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Bits a = bits_of(edges[k].a), b = bits_of(edges[k].b);
      const auto [known, fresh] = by_ends.emplace(std::minmax(a, b), all.size());
      if (fresh) all.push_back({edges[k], 0, {i, k}, {}});
      CutEdge& edge = all[known->second];
      edge.winding += bits_of(edge.segment.a) == a ? solids : -solids;
    }
  }
  return all;
}

bool is_strictly_between(Vec2 p, const Segment& s) {
  return along(p, s.a, s.a, s.b) > 0 && along(p, s.b, s.a, s.b) < 0;
}

/// Where the lines of two segments that cross properly meet.
Point crossing_of(const Segment& s, const Segment& t) {
  const Vector<Rational> a = Point(s.a).exact(), b = Point(s.b).exact(), c = Point(t.a).exact(), d = Point(t.b).exact();
  const Vector<Rational> e = b - a, f = d - c;
  const Rational share = cross(c - a, f) / cross(e, f);
  return {Rational(a.x + share * e.x), Rational(a.y + share * e.y)};
}

/// Whether two segments have one end in common and lie on two lines: they meet in nothing else. So do most edges that
/// meet, the neighbours along an obstacle.
bool meet_in_an_end_only(const Segment& s, const Segment& t) {
  const bool a_in_t = s.a == t.a || s.a == t.b, b_in_t = s.b == t.a || s.b == t.b;
  if (a_in_t == b_in_t) return false;
  const Vec2 common = a_in_t ? s.a : s.b;
  return orient(common, a_in_t ? s.b : s.a, common == t.a ? t.b : t.a) != 0;
}

/// Cuts both where they meet.
void cut(CutEdge& one, CutEdge& two) {
  const Segment& s = one.segment;
  const Segment& t = two.segment;
  if (meet_in_an_end_only(s, t)) return;
  const int c = orient(s.a, s.b, t.a), d = orient(s.a, s.b, t.b);
  if (c * d > 0) return;
  const int a = orient(t.a, t.b, s.a), b = orient(t.a, t.b, s.b);
  if (a * b > 0) return;
  if (c * d < 0 && a * b < 0) {
    const Point x = crossing_of(s, t);
    one.cuts.push_back(x);
    two.cuts.push_back(x);
    return;
  }
  if (c == 0 && is_strictly_between(t.a, s)) one.cuts.emplace_back(t.a);
  if (d == 0 && is_strictly_between(t.b, s)) one.cuts.emplace_back(t.b);
  if (a == 0 && is_strictly_between(s.a, t)) two.cuts.emplace_back(s.a);
  if (b == 0 && is_strictly_between(s.b, t)) two.cuts.emplace_back(s.b);
}

void cut_all(std::vector<CutEdge>& edges) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 2, std::size_t>;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Segment& s = edges[i].segment;
    const CGAL::Bbox_2 box(std::min(s.a.x, s.b.x), std::min(s.a.y, s.b.y), std::max(s.a.x, s.b.x),
                           std::max(s.a.y, s.b.y));
    boxes.emplace_back(box, i);
  }
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(),
                                [&](const Box& a, const Box& b) { cut(edges[a.info()], edges[b.info()]); });
}

/// Numbers points: equal ones get one number.
class Vertices {
 public:
  Vertices(PlanarGraph& graph, std::size_t expected) : graph_(graph) { doubles_.reserve(expected); }

  int number_of(const Point& p, const EdgeName& on) {
    const int next = static_cast<int>(graph_.vertices.size());
    const int number = p.is_double() ? doubles_.emplace(bits_of(p.rounded()), next).first->second
                                     : fractions_.emplace(p.exact(), next).first->second;
    if (number != next) return number;
    graph_.vertices.push_back(p);
    graph_.on.push_back(on);
    return number;
  }

 private:
  struct Less {
    bool operator()(const Vector<Rational>& p, const Vector<Rational>& q) const {
      const int x = cmp(p.x, q.x);
      return x < 0 || (x == 0 && cmp(p.y, q.y) < 0);
    }
  };
  PlanarGraph& graph_;
  std::unordered_map<Bits, int, boost::hash<Bits>> doubles_;
  std::map<Vector<Rational>, int, Less> fractions_;
};

/// Numbers of a graph's edges by their ends, the lesser one first.
using EdgeNumbers = std::unordered_map<std::pair<int, int>, std::size_t, boost::hash<std::pair<int, int>>>;

void add_pieces(CutEdge& edge, Vertices& vertices, EdgeNumbers& by_ends, PlanarGraph& graph) {
  const Segment& s = edge.segment;
  std::sort(edge.cuts.begin(), edge.cuts.end(),
            [&](const Point& p, const Point& q) { return along(p, q, s.a, s.b) < 0; });
  edge.cuts.emplace_back(s.b);
  int from = vertices.number_of(s.a, edge.name);
  for (const Point& p : edge.cuts) {
    const int to = vertices.number_of(p, edge.name);
    if (to == from) continue;
    const auto [known, fresh] = by_ends.emplace(std::minmax(from, to), graph.edges.size());
    if (fresh) graph.edges.push_back({from, to, 0, edge.name});
    PlanarGraph::Edge& piece = graph.edges[known->second];
    piece.winding += piece.a == from ? edge.winding : -edge.winding;
    from = to;
  }
}

}  // namespace

PlanarGraph planar_graph(const std::vector<Obstacle>& obstacles) {
  std::vector<CutEdge> edges = edges_of_all(obstacles);
  cut_all(edges);
  PlanarGraph graph;
  Vertices vertices(graph, edges.size());
  EdgeNumbers by_ends(edges.size());
  for (CutEdge& edge : edges) {
    if (edge.segment.a == edge.segment.b)
      graph.isolated.push_back(vertices.number_of(edge.segment.a, edge.name));
    else
      add_pieces(edge, vertices, by_ends, graph);
  }
  return graph;
}

}  // namespace exactvo::geometry::routing
