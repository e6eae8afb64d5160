// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/robots.h"

#include <limits>

namespace exactvo::formation::crowd {
namespace {

constexpr std::size_t kGrain = 16384;

/// Height of a strip by the mean distance of the last neighbour: measured, flat between 1.2 and 1.5.
constexpr double kStripFactor = 1.35;

/// Buckets a strip's height.
constexpr double kBucketsPerStrip = 3.0;

/// Robots that are looked at together for one that is not above the last.
constexpr std::size_t kBlock = 64;

/// Robots whose cells are numbered before they are counted.
constexpr std::size_t kNumbered = 4096;

/// Ranges for counting, at most.
constexpr std::size_t kRangesPerThread = 4;

std::size_t ranges_of(std::size_t count, std::size_t grain) {
  return (count + grain - 1) / grain;
}

Extent both(Extent a, Extent b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// Cuts ranges of cells, given in any order, down to the cells between the ranges before and after, both ends excluded:
/// such a cell is in no other range.
void make_exclusive(std::vector<Extent>& ranges) {
  std::int32_t after = std::numeric_limits<std::int32_t>::max();
  std::vector<std::int32_t> highs(ranges.size());
  for (std::size_t k = ranges.size(); k-- > 0;) {
    highs[k] = after;
    after = std::min(after, ranges[k].low);
  }
  std::int32_t before = -1;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const std::int32_t high = ranges[k].high;
    ranges[k] = {before, highs[k]};
    before = std::max(before, high);
  }
}

/// Room for more than there can be robots is not made.
constexpr std::size_t kMostReserved = std::size_t{1} << 30U;

}  // namespace

void Robots::resize(std::size_t robots) {
  size_ = robots;
  for_fields([&](auto& field) { field.resize(robots + kPadding); });
}

void Robots::reserve(std::size_t robots) {
  if (robots <= kMostReserved) for_fields([&](auto& field) { field.reserve(robots + kPadding); });
}

void Robots::shrink() {
  if (x.capacity() > x.size() + x.size() / 4) for_fields([](auto& field) { field.shrink_to_fit(); });
}

void Robots::append(std::int32_t at_x, std::int32_t at_y, std::int32_t robot, KindId kind) {
  const std::size_t i = size_;
  resize(size_ + 1);
  x[i] = at_x;
  y[i] = at_y;
  mx[i] = my[i] = hint[i] = 0;
  id[i] = robot;
  tag[i] = kind;
}

void Robots::remove(std::size_t at) {
  const std::size_t last = size_ - 1;
  for (auto* field : {&x, &y, &mx, &my, &id, &hint}) (*field)[at] = (*field)[last];
  tag[at] = tag[last];
  resize(last);
}

void Robots::move(Tasks& tasks) {
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t i = first; i < last; ++i) {
      x[i] += next_mx[i];
      y[i] += next_my[i];
      tag[i] = static_cast<std::uint16_t>((tag[i] & kKind) | kSettled | ((next_kept[i] & kIsKept) ? kKept : 0U));
    }
  });
  mx.swap(next_mx);
  my.swap(next_my);
}

void Robots::follow_density(double least, double most) {
  std::int64_t sum = 0;  // of whole numbers: the order does not matter
  for (std::size_t i = 0; i < size_; ++i) sum += hint[i];
  if (size_ > 0) strip_ = std::clamp(kStripFactor * static_cast<double>(sum) / static_cast<double>(size_), least, most);
}

void Robots::find_bounds(Tasks& tasks) {
  extents_.resize(2 * ranges_of(size_, kGrain));
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    extents_[2 * (first / kGrain)] = extent_of(x.data() + first, last - first);
    extents_[2 * (first / kGrain) + 1] = extent_of(y.data() + first, last - first);
  });
  Extent in_x = extents_[0], in_y = extents_[1];
  for (std::size_t k = 2; k < extents_.size(); k += 2) {
    in_x = both(in_x, extents_[k]);
    in_y = both(in_y, extents_[k + 1]);
  }
  bounds_ = {in_x.low, in_x.high, in_y.low, in_y.high};
}

/// About as many cells as robots at most.
void Robots::lay_out_cells() {
  const double cells = static_cast<double>(size_) + 64.0;
  const double width = static_cast<double>(bounds_.x1 - bounds_.x0 + 1);
  const double height = static_cast<double>(bounds_.y1 - bounds_.y0 + 1);
  per_strip_ = 1.0 / std::max(strip_, height / cells);
  first_row_ = row_of(bounds_.y0);
  rows_ = row_of(bounds_.y1) - first_row_ + 1;
  bucket_ = std::max(1.0 / (kBucketsPerStrip * per_strip_), width * static_cast<double>(rows_) / cells);
  per_bucket_ = 1.0 / bucket_;
  first_column_ = column_of(bounds_.x0);
  columns_ = column_of(bounds_.x1) - first_column_ + 1;
}

/// Robots into their cells, in any order. The number of a robot's cell goes to next_my, how many came to it before to
/// next_mx; what a step writes is free while robots are sorted. The robots in the new order go to wish_mx.
void Robots::scatter(Tasks& tasks) {
  const std::size_t cells = static_cast<std::size_t>(rows_ * columns_);
  start_.resize(cells + 1);
  tasks.for_ranges(cells + 1, kGrain, [&](std::size_t first, std::size_t last, int) {
    std::fill(start_.begin() + static_cast<std::ptrdiff_t>(first), start_.begin() + static_cast<std::ptrdiff_t>(last),
              0);
  });
  count_in_cells(tasks);
  std::int32_t before = 0;
  for (std::size_t c = 1; c <= cells; ++c) start_[c] = before += start_[c];
  const std::int32_t *start = start_.data(), *cell = next_my.data(), *nth = next_mx.data();
  std::int32_t* order = wish_mx.data();
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t i = first; i < last; ++i) order[start[cell[i]] + nth[i]] = static_cast<std::int32_t>(i);
  });
}

/// start_[c + 1] counts cell c. Ranges are long, so that few cells have robots of two: only there threads meet.
void Robots::count_in_cells(Tasks& tasks) {
  const auto threads = static_cast<std::size_t>(tasks.threads());
  const std::size_t grain = threads == 1 ? size_ : std::max(kGrain, size_ / (kRangesPerThread * threads) + 1);
  const CellRule rule{per_bucket_, per_strip_, static_cast<double>(first_column_), static_cast<double>(first_row_),
                      static_cast<double>(columns_)};
  std::int32_t *cell = next_my.data(), *nth = next_mx.data(), *count = start_.data() + 1;
  if (size_ <= grain) {
    for (std::size_t first = 0; first < size_; first += kNumbered) {
      const std::size_t last = std::min(size_, first + kNumbered);
      number_cells(rule, x.data() + first, y.data() + first, last - first, cell + first);
      for (std::size_t i = first; i < last; ++i) nth[i] = count[cell[i]]++;
    }
    return;
  }
  extents_.resize(ranges_of(size_, grain));
  tasks.for_ranges(size_, grain, [&](std::size_t first, std::size_t last, int) {
    number_cells(rule, x.data() + first, y.data() + first, last - first, cell + first);
    extents_[first / grain] = extent_of(cell + first, last - first);
  });
  make_exclusive(extents_);
  tasks.for_ranges(size_, grain, [&](std::size_t first, std::size_t last, int) {
    const Extent own = extents_[first / grain];
    for (std::size_t i = first; i < last; ++i) {
      const std::int32_t c = cell[i];
      nth[i] = c > own.low && c < own.high ? count[c]++ : __atomic_fetch_add(count + c, 1, __ATOMIC_RELAXED);
    }
  });
}

/// Most are in order, since they were in the step before: only those that are not above the last one are looked at. Of
/// each range of cells the x of its robots go to next_mx, in the new order.
void Robots::order_within_cells(Tasks& tasks) {
  const std::size_t cells = static_cast<std::size_t>(rows_ * columns_);
  tasks.for_ranges(cells, kGrain, [&](std::size_t first, std::size_t last, int) {
    const auto begin = static_cast<std::size_t>(start_[first]), end = static_cast<std::size_t>(start_[last]);
    for (std::size_t p = begin; p < end; ++p) next_mx[p] = x[wish_mx[p]];
    for (std::size_t from = begin + 1; from < end; from += kBlock) {
      std::uint64_t low = not_above_the_last(next_mx.data() + from, std::min(kBlock, end - from));
      while (low != 0) {
        const auto k = static_cast<std::size_t>(__builtin_ctzll(low));
        low &= low - 1;
        const std::size_t p = from + k;
        const std::int32_t cell = next_my[wish_mx[p]];
        if (next_my[wish_mx[p - 1]] != cell) continue;
        put_in_order(p, start_[cell], start_[cell + 1]);
        // Whoever is next was above another.
        if (k + 1 < kBlock && p + 1 < end && next_mx[p + 1] <= next_mx[p]) low |= std::uint64_t{1} << (k + 1);
      }
    }
  });
  x.swap(next_mx);
}

/// The robot at p of the cell that begins and ends there, among those before it, which are in order.
void Robots::put_in_order(std::size_t p, std::int32_t begin, std::int32_t end) {
  std::int32_t* const order = wish_mx.data();
  std::int32_t* const at_x = next_mx.data();
  if (end - begin > kFewInCell) {
    std::sort(order + begin, order + end,
              [this](std::int32_t a, std::int32_t b) { return x[a] != x[b] ? x[a] < x[b] : id[a] < id[b]; });
    for (std::int32_t k = begin; k < end; ++k) at_x[k] = x[order[k]];
    return;
  }
  const std::int32_t robot = order[p], its_x = at_x[p];
  auto k = static_cast<std::int32_t>(p);
  for (; k > begin; --k) {
    if (at_x[k - 1] < its_x || (at_x[k - 1] == its_x && id[order[k - 1]] < id[robot])) break;
    order[k] = order[k - 1];
    at_x[k] = at_x[k - 1];
  }
  order[k] = robot;
  at_x[k] = its_x;
}

/// next_mx is free while robots are sorted.
void Robots::permute(Array<std::int32_t>& field, Tasks& tasks) {
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    const std::int32_t *from = field.data(), *order = wish_mx.data();
    std::int32_t* to = next_mx.data();
    for (std::size_t i = first; i < last; ++i) to[i] = from[order[i]];
  });
  field.swap(next_mx);
}

void Robots::permute_tags(Tasks& tasks) {
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t i = first; i < last; ++i) next_mx[i] = tag[wish_mx[i]];
  });
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t i = first; i < last; ++i) tag[i] = static_cast<std::uint16_t>(next_mx[i]);
  });
}

void Robots::sort(Tasks& tasks) {
  if (size_ == 0) return;
  find_bounds(tasks);
  lay_out_cells();
  scatter(tasks);
  order_within_cells(tasks);
  for (auto* field : {&y, &mx, &my, &id, &hint}) permute(*field, tasks);
  permute_tags(tasks);
}

Stretch Robots::searched(const Cells& cells, std::int32_t from, std::int32_t to) const {
  const std::int32_t* begin = x.data();
  const std::int32_t* first = std::lower_bound(begin + from, begin + to, cells.x0);
  const std::int32_t* last = std::upper_bound(first, begin + to, cells.x1);
  return {static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin)};
}

std::size_t Robots::strip_end(std::size_t i) const {
  return static_cast<std::size_t>(start_[(row_of(y[i]) - first_row_ + 1) * columns_]);
}

std::size_t Robots::bytes() const {
  std::size_t words = start_.capacity();
  for (const auto* field : {&x, &y, &mx, &my, &id, &hint, &wish_mx, &wish_my, &safe_mx, &safe_my, &next_mx, &next_my})
    words += field->capacity();
  return 4 * words + 2 * tag.capacity() + next_kept.capacity();
}

}  // namespace exactvo::formation::crowd
