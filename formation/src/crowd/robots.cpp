// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/robots.h"

#include <algorithm>
#include <cmath>

namespace exactvo::formation::crowd {
namespace {

constexpr std::size_t kGrain = 16384;

/// Height of a strip by the mean distance of the last neighbour: measured, flat between 1.2 and 1.5.
constexpr double kStripFactor = 1.35;

/// Buckets a strip's height.
constexpr double kBucketsPerStrip = 3.0;

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
      tag[i] = static_cast<std::uint16_t>((tag[i] & kKind) | kSettled | (next_kept[i] ? kKept : 0U));
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

void Robots::find_bounds() {
  bounds_ = {x[0], x[0], y[0], y[0]};
  for (std::size_t i = 1; i < size_; ++i) {
    bounds_.x0 = std::min<std::int64_t>(bounds_.x0, x[i]);
    bounds_.x1 = std::max<std::int64_t>(bounds_.x1, x[i]);
    bounds_.y0 = std::min<std::int64_t>(bounds_.y0, y[i]);
    bounds_.y1 = std::max<std::int64_t>(bounds_.y1, y[i]);
  }
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

/// The numbers go to next_my, which is free while robots are sorted.
void Robots::number_cells(Tasks& tasks) {
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t i = first; i < last; ++i)
      next_my[i] = static_cast<std::int32_t>((row_of(y[i]) - first_row_) * columns_ + column_of(x[i]) - first_column_);
  });
}

/// Robots into their cells, in any order. First start_[c + 2] counts cell c, then start_[c + 1] is where it begins, and
/// while it fills, where its next robot goes; in the end start_[c] is where it begins.
void Robots::scatter(Tasks& tasks) {
  const std::size_t cells = static_cast<std::size_t>(rows_ * columns_);
  start_.assign(cells + 2, 0);
  const std::int32_t* cell = next_my.data();
  std::int32_t* count = start_.data() + 2;
  std::int32_t* next = start_.data() + 1;
  std::int32_t* order = order_.data();
  const bool alone = tasks.threads() == 1;
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    if (alone)
      for (std::size_t i = first; i < last; ++i) ++count[cell[i]];
    else
      for (std::size_t i = first; i < last; ++i) __atomic_fetch_add(count + cell[i], 1, __ATOMIC_RELAXED);
  });
  for (std::size_t c = 1; c < cells + 2; ++c) start_[c] += start_[c - 1];
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    if (alone)
      for (std::size_t i = first; i < last; ++i) order[next[cell[i]]++] = static_cast<std::int32_t>(i);
    else
      for (std::size_t i = first; i < last; ++i)
        order[__atomic_fetch_add(next + cell[i], 1, __ATOMIC_RELAXED)] = static_cast<std::int32_t>(i);
  });
}

void Robots::order_within_cells(Tasks& tasks) {
  const auto before = [this](std::int32_t a, std::int32_t b) { return x[a] != x[b] ? x[a] < x[b] : id[a] < id[b]; };
  const std::size_t cells = static_cast<std::size_t>(rows_ * columns_);
  tasks.for_ranges(cells, kGrain, [&](std::size_t first, std::size_t last, int) {
    std::int32_t* order = order_.data();
    for (std::size_t c = first; c < last; ++c) {
      const std::int32_t begin = start_[c], end = start_[c + 1];
      if (end - begin > kFewInCell) {
        std::sort(order + begin, order + end, before);
        continue;
      }
      for (std::int32_t a = begin + 1; a < end; ++a) {
        const std::int32_t robot = order[a];
        std::int32_t k = a;
        for (; k > begin && before(robot, order[k - 1]); --k) order[k] = order[k - 1];
        order[k] = robot;
      }
    }
  });
}

/// next_mx is free while robots are sorted.
void Robots::permute(Array<std::int32_t>& field, Tasks& tasks) {
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    const std::int32_t* from = field.data();
    for (std::size_t i = first; i < last; ++i) next_mx[i] = from[order_[i]];
  });
  field.swap(next_mx);
}

void Robots::sort(Tasks& tasks) {
  if (size_ == 0) return;
  find_bounds();
  lay_out_cells();
  number_cells(tasks);
  scatter(tasks);
  order_within_cells(tasks);
  for (auto* field : {&x, &y, &mx, &my, &id, &hint}) permute(*field, tasks);
  tasks.for_ranges(size_, kGrain, [&](std::size_t first, std::size_t last, int) {
    for (std::size_t i = first; i < last; ++i) tags_scratch_[i] = tag[order_[i]];
  });
  tag.swap(tags_scratch_);
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
  for (const auto* field : {&x, &y, &mx, &my, &id, &hint, &next_mx, &next_my, &order_}) words += field->capacity();
  return 4 * words + 2 * (tag.capacity() + tags_scratch_.capacity()) + next_kept.capacity();
}

}  // namespace exactvo::formation::crowd
