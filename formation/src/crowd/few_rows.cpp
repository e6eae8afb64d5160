// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/few_rows.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/few_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using RowLanes = hn::CappedTag<double, 8>;

/// Where normals are nearer to parallel than this, the square of the sine, the linear program decides.
constexpr double kParallel = 0x1p-10;

/// Lattice steps.
struct Way {
  double x, y;
};

/// Rows that are filled up to whole registers by rows that always hold.
class RowSearch {
 public:
  explicit RowSearch(FewRows& rows) : rows_(rows) {
    const std::size_t lanes = hn::Lanes(RowLanes());
    filled_ = (rows.count + lanes - 1) / lanes * lanes;
    for (std::size_t k = rows.count; k < filled_; ++k) {
      rows.x[k] = 1.0, rows.y[k] = 0.0;
      rows.least[k] = -std::numeric_limits<double>::infinity();
    }
  }

  bool allow(Way m) const {
    const RowLanes d;
    auto all = hn::Eq(hn::Zero(d), hn::Zero(d));
    for (std::size_t k = 0; k < filled_; k += hn::Lanes(d))
      all = hn::And(all, hn::Ge(along(k, m), hn::Load(d, rows_.least + k)));
    return hn::AllTrue(d, all);
  }

  /// Whether the wish is allowed; else also what each row, moved inward, misses of it.
  bool allow_wish(Way wish) {
    const RowLanes d;
    auto all = hn::Eq(hn::Zero(d), hn::Zero(d));
    auto most = hn::Set(d, -std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < filled_; k += hn::Lanes(d)) {
      const auto x = hn::Load(d, rows_.x + k), y = hn::Load(d, rows_.y + k), least = hn::Load(d, rows_.least + k);
      const auto at = along(k, wish), length = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
      const auto inward = hn::Add(least, hn::Mul(hn::Set(d, kHalfDiagonal), length)), its = hn::Sub(inward, at);
      all = hn::And(all, hn::Ge(at, least));
      most = hn::Max(most, its);
      hn::Store(inward, d, inward_ + k);
      hn::Store(its, d, missing_ + k);
    }
    if (hn::AllTrue(d, all)) return true;
    first_ = least_equal(hn::MaxOfLanes(d, most));
    return false;
  }

  /// REQUIRES: the wish is not allowed.
  bool solve(Way wish, Way& found) {
    const std::size_t first = first_;
    const double of_first = missing_[first], share = of_first / times(first, first);
    found = {wish.x + share * rows_.x[first], wish.y + share * rows_.y[first]};
    const std::size_t second = most_missing(found);
    if (second != first && missing_[second] > 0.0) {
      if (!meet(wish, first, of_first, second, found)) return false;
      const std::size_t third = most_missing(found);
      if (third != first && third != second && missing_[third] > 0.0) return false;
    }
    return found.x * found.x + found.y * found.y <= rows_.squared_disc;
  }

 private:
  HWY_INLINE hn::Vec<RowLanes> along(std::size_t k, Way m) const {
    const RowLanes d;
    return hn::Add(hn::Mul(hn::Load(d, rows_.x + k), hn::Set(d, m.x)),
                   hn::Mul(hn::Load(d, rows_.y + k), hn::Set(d, m.y)));
  }
  double times(std::size_t a, std::size_t b) const { return rows_.x[a] * rows_.x[b] + rows_.y[a] * rows_.y[b]; }

  /// Writes what each row misses.
  std::size_t most_missing(Way m) {
    const RowLanes d;
    auto most = hn::Set(d, -std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < filled_; k += hn::Lanes(d)) {
      const auto its = hn::Sub(hn::Load(d, inward_ + k), along(k, m));
      hn::Store(its, d, missing_ + k);
      most = hn::Max(most, its);
    }
    return least_equal(hn::MaxOfLanes(d, most));
  }

  /// The row that misses as much, of equal rows the first. The order of rows depends on how robots are divided among
  /// threads: it breaks no tie.
  HWY_INLINE std::size_t least_equal(hn::Vec<RowLanes> most) const {
    const RowLanes d;
    std::size_t row = 0, found = 0;
    for (std::size_t k = 0; k < filled_; k += hn::Lanes(d)) {
      const auto equal = hn::Eq(hn::Load(d, missing_ + k), most);
      const std::intptr_t lane = hn::FindFirstTrue(d, equal);
      if (lane < 0) continue;
      if (found == 0) row = k + static_cast<std::size_t>(lane);
      found += hn::CountTrue(d, equal);
    }
    if (found == 1) return row;
    for (std::size_t k = row + 1; k < rows_.count; ++k)
      if (missing_[k] == missing_[row] &&
          (rows_.x[k] != rows_.x[row] ? rows_.x[k] < rows_.x[row] : rows_.y[k] < rows_.y[row]))
        row = k;
    return row;
  }

  /// On both boundaries, if both pull the wish there. `of_a`: what a misses of the wish.
  bool meet(Way wish, std::size_t a, double of_a, std::size_t b, Way& found) const {
    const double *x = rows_.x, *y = rows_.y;
    const double aa = times(a, a), bb = times(b, b), ab = times(a, b), cross = x[a] * y[b] - y[a] * x[b],
                 squared = cross * cross;
    if (!(squared >= kParallel * aa * bb)) return false;
    const double of_b = inward_[b] - (x[b] * wish.x + y[b] * wish.y);
    const double pull_a = (of_a * bb - of_b * ab) / squared, pull_b = (of_b * aa - of_a * ab) / squared;
    found = {wish.x + (pull_a * x[a] + pull_b * x[b]), wish.y + (pull_a * y[a] + pull_b * y[b])};
    return pull_a >= 0.0 && pull_b >= 0.0;
  }

  FewRows& rows_;
  std::size_t filled_, first_ = 0;
  alignas(64) double inward_[FewRows::kMost];  ///< FewRows::least moved inward by kHalfDiagonal
  alignas(64) double missing_[FewRows::kMost];
};

Few search_rows(FewRows& rows, Motion& m) {
  RowSearch search(rows);
  const auto way_of = [](Motion of) { return Way{static_cast<double>(of.x), static_cast<double>(of.y)}; };
  const Way wish = way_of(rows.wish);
  m = rows.wish;
  if (search.allow_wish(wish)) return Few::allowed;
  Way found{};
  if (!search.solve(wish, found)) return Few::not_found;
  m = whole(found.x, found.y);
  const Way rounded = way_of(m);
  return rounded.x * rounded.x + rounded.y * rounded.y <= rows.squared_way && search.allow(rounded) ? Few::allowed
                                                                                                    : Few::not_allowed;
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(search_rows);

Few nearest_of_few(FewRows& rows, Motion& m) {
  return HWY_DYNAMIC_DISPATCH(search_rows)(rows, m);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
