// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/hits.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/require.h"
#include "readers/grid.h"

namespace exactvo::datasets {
namespace {

/// Beyond this a lattice coordinate is no exact double any more.
constexpr double kFarthestCell = 0x1p52;

/// The cell [k c, (k + 1) c] that holds x, its ends rounded as `lattice_point` rounds them.
std::int64_t cell_of(double x, double cell) {
  auto k = static_cast<std::int64_t>(std::floor(x / cell));
  while (cell * static_cast<double>(k) > x) --k;
  while (cell * static_cast<double>(k + 1) < x) ++k;
  return k;
}

struct Span {
  std::int64_t low = 0;
  std::int64_t high = 0;
  std::size_t size() const { return static_cast<std::size_t>(high - low + 1); }
};

template <class Coordinate>
Span span_of(const std::vector<geometry::Vec2>& hits, double cell, Coordinate coordinate) {
  Span span{cell_of(coordinate(hits.front()), cell), 0};
  span.high = span.low;
  for (const geometry::Vec2 hit : hits) {
    const std::int64_t k = cell_of(coordinate(hit), cell);
    span = {std::min(span.low, k), std::max(span.high, k)};
  }
  return span;
}

void refuse_far_hits(const std::vector<geometry::Vec2>& hits, double cell, const Collector& out) {
  for (const geometry::Vec2 hit : hits) {
    EXACTVO_REQUIRE(geometry::is_finite(hit), "a hit that is not finite");
    if (std::max(std::abs(hit.x), std::abs(hit.y)) / cell < kFarthestCell) continue;
    throw DataError(DataCode::size, out.file(), "", "a hit beyond 2^52 cells",
                    "hits nearer to the origin, or larger cells");
  }
}

}  // namespace

bool is_no_return(double range) {
  constexpr double kLeastOfNoReturns = 50.0;
  constexpr double kSixteenBitsOfMillimetres = 32.767;
  return !(range > 0.0) || range >= kLeastOfNoReturns || range == kSixteenBitsOfMillimetres;
}

geometry::Vec2 hit_at(const Pose& laser, double bearing, double range) {
  const double angle = laser.heading + bearing;
  return laser.position + range * geometry::Vec2{std::cos(angle), std::sin(angle)};
}

void add_hits(const std::vector<geometry::Vec2>& hits, Collector& out) {
  if (hits.empty()) return out.note("", "no hit, no obstacle");
  const double cell = out.options().cell_size > 0.0 ? out.options().cell_size : kScanCell;
  refuse_far_hits(hits, cell, out);
  const Span columns = span_of(hits, cell, [](geometry::Vec2 p) { return p.x; });
  const Span rows = span_of(hits, cell, [](geometry::Vec2 p) { return p.y; });
  if (columns.size() > kMostCells || rows.size() > kMostCells / columns.size()) {
    throw DataError(DataCode::size, out.file(), "",
                    "hits over " + std::to_string(columns.size()) + " by " + std::to_string(rows.size()) + " cells",
                    "at most " + std::to_string(kMostCells) + " cells: larger ones");
  }
  Grid grid{columns.size(), rows.size(), std::vector<std::uint8_t>(columns.size() * rows.size(), 0)};
  for (const geometry::Vec2 hit : hits) {
    const auto x = static_cast<std::size_t>(cell_of(hit.x, cell) - columns.low);
    const auto y = static_cast<std::size_t>(cell_of(hit.y, cell) - rows.low);
    grid.occupied[y * grid.width + x] = 1;
  }
  out.note("", geometry::counted(hits.size(), "hit"));
  add_grid(grid, {{0.0, 0.0}, cell, 0.0, columns.low, rows.low}, out);
}

}  // namespace exactvo::datasets
