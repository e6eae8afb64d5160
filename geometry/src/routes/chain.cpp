// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/chain.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "routes/signs.h"

namespace exactvo::geometry::routing {
namespace {

/// Whether the ray from q to the right crosses ab: its upper end counts, its lower one does not.
bool ray_crosses(const Point& q, const Point& a, const Point& b) {
  const auto is_above = [&](const Point& p) {
    return sign_of([&](auto to) -> NumberOf<decltype(to)> { return to(p).y - to(q).y; }) > 0;
  };
  const bool a_above = is_above(a), b_above = is_above(b);
  return a_above != b_above && (orient(a, b, q) > 0) == b_above;
}

/// A closed walk over the arcs with an odd number of odd ones: an arc is odd if it crosses the rays from s and from t
/// an odd number of times together. A wall stands at its first end.
class ChainFinder {
 public:
  ChainFinder(const ClearancePlan& plan, const ArcGraph& graph, const Point& s, const Point& t)
      : map_(plan.map()), graph_(graph), s_(s), t_(t), vertices_(static_cast<int>(map_.graph.vertices.size())) {}

  Separated operator()() const {
    const int seed = node_on_odd_cycle();
    if (seed < 0) throw std::runtime_error("routes: two components without a chain between them");
    return as_chain(short_cycle(seed));
  }

 private:
  using Arc = ArcGraph::Arc;
  /// One arc of a cycle, with the node it starts from.
  struct Move {
    int from;
    Arc arc;
  };

  bool odd(const Point& a, const Point& b) const { return ray_crosses(s_, a, b) != ray_crosses(t_, a, b); }
  bool is_wall(int node) const { return node >= vertices_ && !graph_.is_part(node); }
  const Point& place_of(int node) const { return map_.vertex(graph_.vertex_of(node)); }
  const PlanarGraph::Edge& edge_of(int node) const { return map_.graph.edges[node - vertices_]; }

  bool is_odd(int from, const Arc& arc) const {
    if (arc.link == ArcGraph::kSide) return odd(place_of(from), place_of(arc.to));
    const int wall = is_wall(from) ? from : arc.to, vertex = graph_.vertex_of(is_wall(from) ? arc.to : from);
    const PlanarGraph::Edge& e = edge_of(wall);
    if (arc.link == ArcGraph::kEnd) return vertex == e.b && odd(map_.vertex(e.a), map_.vertex(e.b));
    const Point& foot = graph_.foot(arc.link);
    return odd(map_.vertex(vertex), foot) != odd(foot, map_.vertex(e.a));
  }

  /// Labels spanning trees; an arc that disagrees with the labels closes an odd cycle, and the node where the tree ways
  /// of its ends part lies on one.
  int node_on_odd_cycle() const {
    const std::size_t n = static_cast<std::size_t>(graph_.size());
    constexpr int kUnseen = -2, kRoot = -1;
    std::vector<int> parent(n, kUnseen), depth(n, 0);
    std::vector<char> label(n, 0);
    for (std::size_t root = 0; root < n; ++root) {
      if (parent[root] != kUnseen) continue;
      parent[root] = kRoot;
      std::vector<int> queue{static_cast<int>(root)};
      for (std::size_t k = 0; k < queue.size(); ++k) {
        const int from = queue[k];
        for (const Arc* to = graph_.begin(from); to != graph_.end(from); ++to) {
          const Arc& arc = *to;
          const char expected = static_cast<char>(label[from] ^ (is_odd(from, arc) ? 1 : 0));
          if (parent[arc.to] == kUnseen) {
            parent[arc.to] = from;
            label[arc.to] = expected;
            depth[arc.to] = depth[from] + 1;
            queue.push_back(arc.to);
          } else if (label[arc.to] != expected) {
            int a = from, b = arc.to;
            while (a != b) (depth[a] >= depth[b] ? a : b) = parent[depth[a] >= depth[b] ? a : b];
            return a;
          }
        }
      }
    }
    return -1;
  }

  /// The fewest arcs that lead from the node back to itself with odd parity: breadth first over (node, parity). Then
  /// the same from a node opposite, while that gives a shorter one.
  std::vector<Move> short_cycle(int seed) const {
    std::vector<Move> best;
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<Move> cycle = odd_cycle_through(seed);
      if (!best.empty() && cycle.size() >= best.size()) break;
      best = std::move(cycle);
      seed = best[best.size() / 2].from;
    }
    return best;
  }

  std::vector<Move> odd_cycle_through(int seed) const {
    struct Step {
      int before = -1;
      const Arc* arc = nullptr;
    };
    std::vector<Step> steps(2 * static_cast<std::size_t>(graph_.size()));
    const std::size_t start = 2 * static_cast<std::size_t>(seed), end = start + 1;
    std::vector<std::size_t> queue{start};
    steps[start].before = static_cast<int>(start);
    for (std::size_t k = 0; k < queue.size() && steps[end].before < 0; ++k) {
      const std::size_t at = queue[k];
      const int from = static_cast<int>(at / 2);
      for (const Arc* arc = graph_.begin(from); arc != graph_.end(from); ++arc) {
        const std::size_t next = 2 * static_cast<std::size_t>(arc->to) + ((at & 1) ^ (is_odd(from, *arc) ? 1 : 0));
        if (steps[next].before >= 0) continue;
        steps[next] = {static_cast<int>(at), arc};
        queue.push_back(next);
      }
    }
    std::vector<Move> cycle;
    for (std::size_t at = end; at != start; at = static_cast<std::size_t>(steps[at].before))
      cycle.push_back({steps[at].before / 2, *steps[at].arc});
    std::reverse(cycle.begin(), cycle.end());
    return cycle;
  }

  /// A vertex is one point; a wall is passed from where the chain comes to it to where it leaves.
  Separated as_chain(const std::vector<Move>& cycle) const {
    Separated out;
    const std::size_t n = cycle.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Move& into = cycle[(k + n - 1) % n];
      const Move& leaving = cycle[k];
      const int node = leaving.from;
      const bool gap = leaving.arc.link != ArcGraph::kEnd;
      if (is_wall(node)) {
        const EdgeName on = edge_of(node).on;
        out.chain.push_back({shown(contact(into.arc, into.from)), on, false});
        out.chain.push_back({shown(contact(leaving.arc, leaving.arc.to)), on, gap});
      } else {
        // Where no gap follows, a wall does: the point lies on that.
        const EdgeName on = gap ? map_.graph.on[graph_.vertex_of(node)] : edge_of(leaving.arc.to).on;
        out.chain.push_back({shown(place_of(node)), on, gap});
      }
    }
    drop_repeated(out.chain);
    return out;
  }

  /// Where an arc between a wall and `vertex` touches the wall.
  Point contact(const Arc& arc, int vertex) const {
    return arc.link == ArcGraph::kEnd ? place_of(vertex) : graph_.foot(arc.link);
  }

  /// A point that is followed by itself along an edge says nothing.
  static void drop_repeated(std::vector<ChainPoint>& chain) {
    std::vector<ChainPoint> kept;
    const auto same = [](const ChainPoint& a, const ChainPoint& b) {
      return a.point.rounded == b.point.rounded && a.point.x == b.point.x && a.point.y == b.point.y;
    };
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const ChainPoint& next = chain[(k + 1) % chain.size()];
      if (!chain[k].gap_follows && same(chain[k], next)) continue;
      kept.push_back(chain[k]);
    }
    chain = std::move(kept);
  }

  const CellMap& map_;
  const ArcGraph& graph_;
  Point s_, t_;
  int vertices_;
};

}  // namespace

ArcGraph::ArcGraph(const ClearancePlan& plan) {
  const CellMap& map = plan.map();
  const int vertices = static_cast<int>(map.graph.vertices.size());
  whole_ = vertices + static_cast<int>(map.graph.edges.size());
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < map.graph.edges.size(); ++k) {
    const int wall = vertices + static_cast<int>(k);
    pairs.push_back({wall, map.graph.edges[k].a, kEnd});
    pairs.push_back({wall, map.graph.edges[k].b, kEnd});
  }
  for (std::size_t k = 0; k < map.sides.size(); ++k) {
    const Side& side = map.sides[k];
    if (side.right >= 0 && !plan.side_admits(static_cast<int>(k)) && map.triangles[side.left].free)
      pairs.push_back({side.a, side.b, kSide});
  }
  feet_.resize(map.links.size());
  for (std::size_t k = 0; k < map.links.size(); ++k) {
    const Link& link = map.links[k];
    if (plan.link_admits(static_cast<int>(k))) continue;
    feet_[k] = map.foot(link);
    pairs.push_back({link.vertex, vertices + link.wall, static_cast<int>(k)});
  }
  set_arcs(whole_, pairs);
}

namespace {

/// The walls at a vertex by solid angle: the numbers of the graph's edges between two free triangles, and where there
/// is a free triangle on both sides of one, that edge alone.
std::vector<std::vector<int>> walls_by_angle(const CellMap& map, const std::vector<CellMap::TriangleAt>& about) {
  std::vector<std::vector<int>> angles;
  const std::size_t n = about.size();
  const auto is_free = [&](std::size_t k) { return map.triangles[about[k % n].triangle].free; };
  std::size_t first = 0;
  while (first < n && !is_free(first)) ++first;
  bool is_open = false;  // whether the last angle goes on
  for (std::size_t k = first; k < first + n; ++k) {
    if (is_free(k)) is_open = false;
    const CellMap::TriangleAt& t = about[k % n];
    const int wall = map.triangles[t.triangle].wall[t.side_to_next];
    if (wall < 0) continue;
    if (!is_open) angles.emplace_back();
    is_open = true;
    angles.back().push_back(wall);
  }
  return angles;
}

}  // namespace

ArcGraph::ArcGraph(const ArcGraph& graph, const CellMap& map, const std::vector<CellMap::TriangleAt>& about)
    : feet_(graph.feet_), whole_(graph.whole_), vertex_of_part_(graph.vertex_of_part_) {
  const int vertices = static_cast<int>(map.graph.vertices.size());
  const CellMap::TriangleAt& first = about.front();
  const int vertex = first.corner >= 0 ? map.triangles[first.triangle].vertex[first.corner] : -1;
  std::vector<int> node_of(map.graph.edges.size(), vertex);  // that stands for the vertex beside a wall
  int cut_wall = -1;
  if (vertex >= 0) {
    const std::vector<std::vector<int>> angles = walls_by_angle(map, about);
    for (std::size_t k = 1; k < angles.size(); ++k) {
      for (const int wall : angles[k]) node_of[wall] = whole_ + static_cast<int>(vertex_of_part_.size());
      vertex_of_part_.push_back(vertex);
    }
  } else if (map.triangles[first.triangle].free && map.triangles[about.back().triangle].free) {
    cut_wall = vertices + map.triangles[first.triangle].wall[first.side_to_next];
  }
  std::vector<Pair> pairs;
  for (int node = 0; node < graph.size(); ++node) {
    for (const Arc* arc = graph.begin(node); arc != graph.end(node); ++arc) {
      if (node > arc->to || node == cut_wall || arc->to == cut_wall) continue;
      const bool is_here = vertex >= 0 && node == vertex && arc->to >= vertices && arc->to < whole_;
      pairs.push_back({is_here ? node_of[arc->to - vertices] : node, arc->to, arc->link});
    }
  }
  set_arcs(whole_ + static_cast<int>(vertex_of_part_.size()), pairs);
}

void ArcGraph::set_arcs(int nodes, const std::vector<Pair>& pairs) {
  first_.assign(static_cast<std::size_t>(nodes) + 1, 0);
  for (const Pair& p : pairs) {
    ++first_[p.a + 1];
    ++first_[p.b + 1];
  }
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  arcs_.resize(2 * pairs.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (const Pair& p : pairs) {
    arcs_[next[p.a]++] = {p.b, p.link};
    arcs_[next[p.b]++] = {p.a, p.link};
  }
}

ExactPoint shown(const Point& p) {
  ExactPoint out{p.rounded(), {}, {}};
  if (p.is_double()) return out;
  const Vector<Rational> exact = p.exact();
  const auto text = [](const Rational& x, double rounded) {
    return Rational(rounded) == x ? std::string() : x.get_num().get_str() + "/" + x.get_den().get_str();
  };
  out.x = text(exact.x, out.rounded.x);
  out.y = text(exact.y, out.rounded.y);
  return out;
}

Separated separating_chain(const ClearancePlan& plan, const ArcGraph& graph, const ChainEnd& s, const ChainEnd& t) {
  const CellMap& map = plan.map();
  // Beside an end in contact, on any side of it: no chain of the cut graph tells them apart.
  const auto beside = [&](const ChainEnd& end) {
    for (const CellMap::TriangleAt& at : end.about)
      if (map.triangles[at.triangle].free) return map.middle_of(at.triangle);
    return Point(end.at);
  };
  std::optional<ArcGraph> cut;
  for (const ChainEnd* end : {&s, &t})
    if (!end->about.empty()) cut.emplace(ArcGraph(cut ? *cut : graph, map, end->about));
  return ChainFinder(plan, cut ? *cut : graph, beside(s), beside(t))();
}

}  // namespace exactvo::geometry::routing
