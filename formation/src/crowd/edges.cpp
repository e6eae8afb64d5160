// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/edges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "crowd/edge_rounding.h"

namespace exactvo::formation::crowd {
namespace {

using namespace edge_rounding;
using geometry::dot;

/// How far beyond a cell its edges are looked for: rounding moves a point by far less into the next one.
constexpr double kHalfDiagonal = 0.7072;

Vec2 nearest_point(const Segment& s) {
  const Vec2 along = s.b - s.a;
  const double length = geometry::squared_norm(along);
  return s.a + (length > 0.0 ? std::clamp(-dot(s.a, along) / length, 0.0, 1.0) : 0.0) * along;
}

double squared_distance(const Segment& s) {
  return geometry::squared_norm(nearest_point(s));
}

double magnitude(const Segment& s) {
  return std::fabs(s.a.x) + std::fabs(s.a.y) + std::fabs(s.b.x) + std::fabs(s.b.y);
}

/// The part of an edge within |x|, |y| <= far: what is beyond the range cannot be met, and a normal that is rounded
/// turns the far end of a long wall across the way. A new end is off the edge by a rounding error of the old ones.
Segment cut(const Segment& s, double far) {
  if (std::max({std::fabs(s.a.x), std::fabs(s.a.y), std::fabs(s.b.x), std::fabs(s.b.y)}) <= far) return s;
  double from = 0.0, to = 1.0;
  const auto clip = [&](double a, double b) {
    if (a == b) return;
    const double one = (-far - a) / (b - a), other = (far - a) / (b - a);
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  };
  clip(s.a.x, s.b.x);
  clip(s.a.y, s.b.y);
  if (!(from <= to)) return s;
  const Vec2 along = s.b - s.a;
  return {from > 0.0 ? s.a + from * along : s.a, to < 1.0 ? s.a + to * along : s.b};
}

/// The edge from the robot, and what is asked.
class Cone {
 public:
  Cone(const Segment& seen, double range, const ObstacleQuery& query)
      : seen_(cut(seen, kCutRanges * range)),
        query_(query),
        size_(magnitude(seen) + query.radius),
        error_(kSupportError * size_) {
    const double u = query.float_normals ? 0x1p-24 : kUnit;
    grown_ = query.radius + kRoundingRoom * u * (magnitude(seen_) + query.radius) + kSupportRoom * size_;
  }

  /// At least h(n), exactly that of the doubles given.
  double support_above(Vec2 n) const {
    const double length = std::sqrt(geometry::squared_norm(n));
    return std::max(dot(n, seen_.a), dot(n, seen_.b)) + query_.radius * length + error_;
  }

  ObstacleLine best_line() {
    // The cut-offs at the ends of the edge.
    try_normal(direction(query_.still_horizon * query_.velocity - seen_.a));
    try_normal(direction(query_.still_horizon * query_.velocity - seen_.b));
    const Vec2 across = direction(geometry::perp(seen_.b - seen_.a));
    try_normal(across);
    try_normal(-across);
    try_legs(seen_.a);
    try_legs(seen_.b);
    ObstacleLine line = line_with(found_, query_);
    if (least_ < std::numeric_limits<double>::infinity() && set_offset(line)) return line;
    return facing();
  }

 private:
  /// The two tangents from the robot to the disc round an end.
  void try_legs(Vec2 centre) {
    const double squared = geometry::squared_norm(centre), square = squared - grown_ * grown_;
    if (!(square > 0.0)) return;
    const double leg = std::sqrt(square), scale = 1.0 / squared;
    for (const double side : {leg, -leg}) {
      const Vec2 n = {-(grown_ * centre.x + side * centre.y), side * centre.x - grown_ * centre.y};
      try_normal(scale * n, error_);
    }
  }

  /// Valid where no point of the grown edge lies on its side of the robot; `room` for what a leg is rounded by.
  void try_normal(Vec2 n, double room = 0.0) {
    const double support = std::max(dot(n, seen_.a), dot(n, seen_.b)) + grown_;
    if (!(support <= room)) return;
    const double depth = support - query_.still_horizon * dot(n, query_.velocity);
    if (!(depth < least_)) return;
    least_ = depth;
    found_ = n;
  }

  /// False where the normal as rounded does not separate robot and edge.
  bool set_offset(ObstacleLine& line) const {
    const double support = support_above(line.normal);
    if (!(support <= 0.0)) return false;
    line.offset = std::min(0.0, (support + kSharedVertex * error_) / query_.still_horizon * kTowardsZero);
    return true;
  }

  /// Not nearer to the edge: where it is too near for anything else.
  ObstacleLine facing() const {
    Vec2 n = direction(-nearest_point(seen_));
    if (n == Vec2{}) n = direction(geometry::perp(seen_.b - seen_.a));
    if (n == Vec2{}) n = {1.0, 0.0};
    ObstacleLine line = line_with(n, query_);
    line.touching = !(support_above(line.normal) <= 0.0);
    return line;
  }

  Segment seen_;
  const ObstacleQuery& query_;
  double size_, error_, grown_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
  Vec2 found_;
};

/// Whether an earlier half-plane excludes all that meets this edge.
bool is_covered(const Cone& cone, const std::vector<ObstacleLine>& lines, double horizon) {
  return std::any_of(lines.begin(), lines.end(), [&](const ObstacleLine& line) {
    const double support = cone.support_above(line.normal);
    return !line.touching && support <= horizon * line.offset * kAwayFromZero;
  });
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

void edge_lines(const EdgeGrid& grid, const ObstacleQuery& query, std::vector<NearEdge>& near,
                std::vector<ObstacleLine>& out) {
  out.clear();
  near.clear();
  const double range = (query.still_horizon * query.max_speed + query.radius) * kWiden;
  const auto seen = [&](std::uint32_t edge) {
    return Segment{grid.edges()[edge].a - query.position, grid.edges()[edge].b - query.position};
  };
  std::uint32_t place = grid.near(query.position).first;
  grid.for_near(query.position, [&](std::uint32_t edge) {
    const double squared = squared_distance(seen(edge));
    if (squared <= range * range) near.emplace_back(squared, place);
    ++place;
  });
  std::sort(near.begin(), near.end());
  for (const auto& [squared, at] : near) {
    const std::uint32_t edge = grid.items()[at];
    Cone cone(seen(edge), range, query);
    if (is_covered(cone, out, query.still_horizon)) continue;
    out.push_back(cone.best_line());
    out.back().obstacle = edge;
  }
}

}  // namespace exactvo::formation::crowd
