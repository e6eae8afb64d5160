// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/piece_tree.h"

namespace exactvo::geometry::routing {
namespace {

/// Parts that long pieces are cut into: this many of each piece in the mean.
constexpr double kPartsOfPiece = 2.0;

}  // namespace

PieceTree::PieceTree(const CellMap& map) {
  const int count = static_cast<int>(map.graph.edges.size() + map.graph.isolated.size());
  const auto end_of = [&](int vertex) { return map.vertex(vertex).rounded(); };
  std::vector<int> triangle_of(map.vertices.size(), 0);
  for (std::size_t f = 0; f < map.triangles.size(); ++f)
    for (const int v : map.triangles[f].vertex) triangle_of[static_cast<std::size_t>(v)] = static_cast<int>(f);
  double total = 0.0;
  for (int k = 0; k < count; ++k) {
    const auto [a, b] = map.ends_of(k);
    triangle_at_.push_back(triangle_of[static_cast<std::size_t>(a)]);
    total += norm(end_of(b) - end_of(a));
  }
  const double share = total > 0.0 ? kPartsOfPiece * count / total : 0.0;  // of a part a metre
  for (int k = 0; k < count; ++k) {
    const auto [i, j] = map.ends_of(k);
    const Vec2 a = end_of(i), b = end_of(j);
    for (const double x : {a.x, a.y, b.x, b.y}) largest_ = std::max(largest_, std::fabs(x));
    const int cuts = 1 + static_cast<int>(share * norm(b - a));
    Vec2 from = a;
    for (int c = 1; c <= cuts; ++c) {
      const Vec2 to = c == cuts ? b : a + (static_cast<double>(c) / cuts) * (b - a);
      Part part{{}, k};
      part.box.add(from);
      part.box.add(to);
      parts_.push_back(part);
      from = to;
    }
  }
  if (!parts_.empty()) build(0, static_cast<int>(parts_.size()));
}

/// Halves along the longer side of the middles' box.
int PieceTree::build(int first, int last) {
  constexpr int kLeaf = 4;
  const int number = static_cast<int>(nodes_.size());
  nodes_.push_back({{}, 0, first, last});
  Box box, middles;
  for (int k = first; k < last; ++k) {
    const Box& one = parts_[static_cast<std::size_t>(k)].box;
    box.add(one.low);
    box.add(one.high);
    middles.add(0.5 * (one.low + one.high));
  }
  nodes_.back().box = box;
  if (last - first <= kLeaf) return number;
  const bool by_x = middles.high.x - middles.low.x >= middles.high.y - middles.low.y;
  const int half = first + (last - first) / 2;
  const auto place = [by_x](const Part& p) { return by_x ? p.box.low.x + p.box.high.x : p.box.low.y + p.box.high.y; };
  std::nth_element(
      parts_.begin() + first, parts_.begin() + half, parts_.begin() + last,
      [&](const Part& p, const Part& q) { return place(p) < place(q) || (place(p) == place(q) && p.piece < q.piece); });
  build(first, half);
  const int right = build(half, last);
  nodes_[static_cast<std::size_t>(number)].right = right;
  return number;
}

/// Down the tree to the nearer box each time: near enough to walk from.
int PieceTree::triangle_near(Vec2 x) const {
  if (nodes_.empty()) return 0;
  const auto distance_to = [&](const Box& box) {
    return norm(
        Vec2{std::max({box.low.x - x.x, x.x - box.high.x, 0.0}), std::max({box.low.y - x.y, x.y - box.high.y, 0.0})});
  };
  std::size_t at = 0;
  while (nodes_[at].right > 0) {
    const std::size_t left = at + 1, right = static_cast<std::size_t>(nodes_[at].right);
    at = distance_to(nodes_[left].box) <= distance_to(nodes_[right].box) ? left : right;
  }
  return triangle_at_[static_cast<std::size_t>(parts_[static_cast<std::size_t>(nodes_[at].first)].piece)];
}

}  // namespace exactvo::geometry::routing
