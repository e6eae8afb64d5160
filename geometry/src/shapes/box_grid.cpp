// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/box_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"

namespace exactvo::geometry {
namespace {

constexpr double kMostCellsABox = 64.0;   // a box of more stands in a list of its own
constexpr double kMostColumns = 32768.0;  // of a scene that is a line of many boxes

/// m; where it is beyond the range of doubles, half their largest: the last cells then hold what lies farther.
double size_between(double low, double high) {
  return std::min(high - low, 0.5 * std::numeric_limits<double>::max());
}

}  // namespace

BoxGrid::BoxGrid(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  if (boxes_.empty()) return;
  for (const Box& b : boxes_) {
    EXACTVO_REQUIRE(!b.is_empty() && is_finite(b.low) && is_finite(b.high), "a box that is empty or not finite");
    extent_.add(b);
  }
  // About one cell a box, as nearly square as the columns allow.
  const Vec2 size{size_between(extent_.low.x, extent_.high.x), size_between(extent_.low.y, extent_.high.y)};
  const double count = static_cast<double>(boxes_.size());
  const double mean = std::sqrt(size.x) * std::sqrt(size.y) / std::sqrt(count);  // no product that could overflow
  side_ = std::max(mean, std::max(size.x, size.y) / std::min(2.0 * count, kMostColumns));
  if (!(side_ > 0.0) || !std::isfinite(side_)) side_ = 1.0;
  columns_ = static_cast<std::int32_t>(std::min(std::floor(size.x / side_), kMostColumns)) + 1;
  rows_ = static_cast<std::int32_t>(std::min(std::floor(size.y / side_), kMostColumns)) + 1;
  const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);

  std::vector<bool> is_large(boxes_.size());
  start_.assign(cells + 1, 0);
  const auto for_each_cell = [&](const Cells& c, const auto& visit) {
    for (std::int32_t y = c.first_y; y <= c.last_y; ++y)
      for (std::int32_t x = c.first_x; x <= c.last_x; ++x)
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x));
  };
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Cells c = cells_.emplace_back(cells_of(boxes_[i]));
    const double covered = (1.0 + c.last_x - c.first_x) * (1.0 + c.last_y - c.first_y);
    is_large[i] = covered > kMostCellsABox;
    if (is_large[i])
      large_.push_back(static_cast<std::uint32_t>(i));
    else
      for_each_cell(c, [&](std::size_t cell) { ++start_[cell + 1]; });
  }
  for (std::size_t cell = 0; cell < cells; ++cell) start_[cell + 1] += start_[cell];
  item_.resize(start_.back());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (!is_large[i])
      for_each_cell(cells_[i], [&](std::size_t cell) { item_[next[cell]++] = static_cast<std::uint32_t>(i); });
}

// `distance_below` is low by up to 20 u of itself, and each side of the window rounds by u of its terms.
Box BoxGrid::window_round(Vec2 x, double reach) {
  const auto beyond = [&](double at) { return reach + 32.0 * kUnitRoundoff * (reach + std::fabs(at)); };
  const Vec2 half{beyond(x.x), beyond(x.y)};
  return {x - half, x + half};
}

// The same rounding for boxes and windows, and monotone: what meets has a cell in common.
BoxGrid::Cells BoxGrid::cells_of(const Box& box) const {
  const auto index = [&](double x, double low, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp((x - low) / side_, 0.0, static_cast<double>(count - 1)));
  };
  if (boxes_.empty()) return {};
  return {index(box.low.x, extent_.low.x, columns_), index(box.low.y, extent_.low.y, rows_),
          index(box.high.x, extent_.low.x, columns_), index(box.high.y, extent_.low.y, rows_)};
}

namespace {

/// Half a box's side, moved up past the roundings of a root of two squares, and centre -+ it past that of the sum.
Box round(Vec2 centre, Vec2 half) {
  constexpr double kUp = 1.0 + 8.0 * kUnitRoundoff;
  const Vec2 sides{half.x * kUp + 4.0 * kUnitRoundoff * std::fabs(centre.x),
                   half.y * kUp + 4.0 * kUnitRoundoff * std::fabs(centre.y)};
  return {centre - sides, centre + sides};
}

}  // namespace

Box box_of(const ConvexShape& shape) {
  if (const auto* d = std::get_if<Disc>(&shape)) return round(d->center, {d->radius, d->radius});
  // h(e_x) = |l11|, h(e_y) = |(l21, l22)|.
  if (const auto* e = std::get_if<Ellipse>(&shape))
    return round(e->center, {std::fabs(e->l11), std::hypot(e->l21, e->l22)});
  if (const auto* s = std::get_if<Segment>(&shape))
    return {{std::min(s->a.x, s->b.x), std::min(s->a.y, s->b.y)}, {std::max(s->a.x, s->b.x), std::max(s->a.y, s->b.y)}};
  Box box;
  for (const Vec2 v : std::get<ConvexPolygon>(shape).vertices) box.add(v);
  return box;
}

// A difference of doubles carries u and never underflows. Where the sum of squares is neither tiny nor infinite, what
// underflows in it is less than u of it: squares and sum carry 4 u, the root 3 u, the last product and its factor 2 u.
double distance_below(const Box& box, Vec2 x) {
  constexpr double kDown = 1.0 - 10.0 * kUnitRoundoff;
  constexpr double kTiny = 0x1p-900, kMost = std::numeric_limits<double>::max();
  const double dx = std::max({box.low.x - x.x, x.x - box.high.x, 0.0});
  const double dy = std::max({box.low.y - x.y, x.y - box.high.y, 0.0});
  const double squares = dx * dx + dy * dy;
  if (squares > kTiny && squares <= kMost) return std::sqrt(squares) * kDown;
  if (!(squares > 1.0)) return std::max(dx, dy) * kDown;
  return box.is_empty() ? squares : std::min(std::hypot(dx, dy), kMost) * kDown;
}

}  // namespace exactvo::geometry
