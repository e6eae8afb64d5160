// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/edge_grid.h"

#include "exactvo/geometry/box.h"

namespace exactvo::geometry::routing {
namespace {

struct Piece {
  Vec2 a, b;
};

std::vector<Piece> pieces_of(const CellMap& map) {
  std::vector<Piece> pieces;
  for (const PlanarGraph::Edge& e : map.graph.edges)
    pieces.push_back({map.vertex(e.a).rounded(), map.vertex(e.b).rounded()});
  for (const int v : map.graph.isolated) pieces.push_back({map.vertex(v).rounded(), map.vertex(v).rounded()});
  return pieces;
}

Vec2 middle_of(const CellMap& map, const Triangle& t) {
  return (map.vertex(t.vertex[0]).rounded() + map.vertex(t.vertex[1]).rounded() + map.vertex(t.vertex[2]).rounded()) /
         3.0;
}

}  // namespace

EdgeGrid::EdgeGrid(const CellMap& map) {
  Box box;
  for (const Point& p : map.graph.vertices) box.add(p.rounded());
  if (box.is_empty()) box = {{0.0, 0.0}, {0.0, 0.0}};
  low_ = box.low;
  const double width = box.high.x - box.low.x, height = box.high.y - box.low.y, extent = std::max(width, height);
  // About two cells a vertex; as thin a map as may be gets no more than that many in a row.
  const double wanted = 2.0 * static_cast<double>(map.graph.vertices.size()) + 16.0;
  size_ = std::max(std::sqrt(width) * std::sqrt(height) / std::sqrt(wanted), extent / wanted);
  if (!(size_ > 0.0)) size_ = 1.0;
  columns_ = static_cast<int>(width / size_) + 1;
  rows_ = static_cast<int>(height / size_) + 1;
  for (const double x : {box.low.x, box.low.y, box.high.x, box.high.y}) largest_ = std::max(largest_, std::fabs(x));

  hints_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1);
  for (std::size_t f = 0; f < map.triangles.size(); ++f) {
    const Vec2 m = middle_of(map, map.triangles[f]);
    hints_[cell(column(m.x), row(m.y))] = static_cast<int>(f);
  }
  int last = 0;
  for (int& hint : hints_) last = hint = hint < 0 ? last : hint;
  add_all(map);
}

std::pair<int, int> EdgeGrid::rows_in_column(Vec2 a, Vec2 b, double reach, int i) const {
  double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
  const double run = b.x - a.x;
  if (std::fabs(run) > size_) {  // else the box does
    // The first column stands for all that lies to its left, the last for all to its right.
    const double left = i == 0 ? std::min(a.x, b.x) : low_.x + i * size_ - reach;
    const double right = i == columns_ - 1 ? std::max(a.x, b.x) : low_.x + (i + 1) * size_ + reach;
    const auto height = [&](double x) { return a.y + std::clamp((x - a.x) / run, 0.0, 1.0) * (b.y - a.y); };
    low = std::min(height(left), height(right));
    high = std::max(height(left), height(right));
  }
  return {row(low - reach), row(high + reach)};
}

void EdgeGrid::add_all(const CellMap& map) {
  const std::vector<Piece> pieces = pieces_of(map);
  const auto for_each_cell = [&](const Piece& p, const auto& f) {
    const double slack = slack_for(p.a, p.b, 0.0);
    const int first = column(std::min(p.a.x, p.b.x) - slack), last = column(std::max(p.a.x, p.b.x) + slack);
    for (int i = first; i <= last; ++i) {
      const auto [low, high] = rows_in_column(p.a, p.b, slack, i);
      for (int j = low; j <= high; ++j) f(cell(i, j));
    }
  };
  starts_.assign(hints_.size() + 1, 0);
  for (const Piece& p : pieces) for_each_cell(p, [&](std::size_t c) { ++starts_[c + 1]; });
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  items_.resize(static_cast<std::size_t>(starts_.back()));
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for_each_cell(pieces[k], [&](std::size_t c) { items_[next[c]++] = static_cast<int>(k); });
}

}  // namespace exactvo::geometry::routing
