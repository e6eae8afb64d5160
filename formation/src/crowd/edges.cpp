// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/edges.h"

#include <algorithm>
#include <cmath>

#include "crowd/layout.h"

namespace exactvo::formation::crowd {
namespace {

/// Squared distance of the origin from s.
double squared_distance(const Segment& s) {
  return geometry::squared_norm(nearest_on(s.a, s.b, {}));
}

}  // namespace

template <class Do>
void EdgeGrid::for_cells_of(const Segment& edge, const Do& what) const {
  const auto column = [&](double x) { return std::clamp(std::floor((x - low_.x) * per_cell_), 0.0, columns_ - 1.0); };
  const auto row = [&](double y) { return std::clamp(std::floor((y - low_.y) * per_cell_), 0.0, rows_ - 1.0); };
  const double far = (reach_ + kHalfDiagonal * cell_) * (1.0 + 1e-9), left = std::min(edge.a.x, edge.b.x) - far,
               right = std::max(edge.a.x, edge.b.x) + far;
  for (double r = row(std::min(edge.a.y, edge.b.y) - far); r <= row(std::max(edge.a.y, edge.b.y) + far); ++r)
    for (double c = column(left); c <= column(right); ++c) {
      const Vec2 middle = low_ + cell_ * Vec2{c + 0.5, r + 0.5};
      if (squared_distance({edge.a - middle, edge.b - middle}) <= far * far)
        what(static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c));
    }
}

void EdgeGrid::lay_out(double reach) {
  start_.clear();
  items_.clear();
  columns_ = rows_ = 0.0;
  if (edges_.empty()) return;
  reach_ = reach;
  low_ = edges_[0].a;
  Vec2 high = low_;
  for (const Segment& e : edges_)
    for (const Vec2 p : {e.a, e.b}) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  low_ = low_ - Vec2{reach, reach};
  const Vec2 extent = high + Vec2{reach, reach} - low_;
  // Small beside the reach, and not many more cells than edges.
  const double fine = std::sqrt(extent.x * extent.y / (8.0 * static_cast<double>(edges_.size()) + 4096.0));
  cell_ = std::max({reach / 4.0, fine, std::max(extent.x, extent.y) / 0x1p20});
  per_cell_ = 1.0 / cell_;
  columns_ = std::floor(extent.x * per_cell_) + 1.0;
  rows_ = std::floor(extent.y * per_cell_) + 1.0;
  start_.assign(static_cast<std::size_t>(columns_ * rows_) + 2, 0);
  for (const Segment& e : edges_) for_cells_of(e, [&](std::size_t cell) { ++start_[cell + 2]; });
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  items_.resize(start_.back());
  for (std::size_t k = 0; k < edges_.size(); ++k)
    for_cells_of(edges_[k], [&](std::size_t cell) { items_[start_[cell + 1]++] = static_cast<std::uint32_t>(k); });
  order_cells();
}

/// Nearest to the middle of the cell first: so robots of a pack meet theirs at about the same place of their lists.
void EdgeGrid::order_cells() {
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) {
    const auto first = items_.begin() + start_[cell], last = items_.begin() + start_[cell + 1];
    if (first == last) continue;
    const auto columns = static_cast<std::size_t>(columns_);
    const Vec2 middle =
        low_ + cell_ * Vec2{static_cast<double>(cell % columns) + 0.5, static_cast<double>(cell / columns) + 0.5};
    order.clear();
    for (auto k = first; k != last; ++k)
      order.emplace_back(squared_distance({edges_[*k].a - middle, edges_[*k].b - middle}), *k);
    std::sort(order.begin(), order.end());
    std::transform(order.begin(), order.end(), first, [](const auto& e) { return e.second; });
  }
}

std::size_t EdgeGrid::bytes() const {
  return edges_.capacity() * sizeof(Segment) + 4 * (start_.capacity() + items_.capacity());
}

}  // namespace exactvo::formation::crowd
