// SPDX-License-Identifier: GPL-3.0-or-later
#include "sets.h"

#include <algorithm>
#include <cmath>

namespace exactvo::bench {
namespace {

/// Padding lines: see batch.h.
constexpr double kAlwaysHolds = -1e30;

constexpr std::size_t kBlock = 16;

std::size_t longest(const std::vector<lp::Problem>& problems) {
  std::size_t lines = 0;
  for (const lp::Problem& p : problems) lines = std::max(lines, p.constraints.size());
  return lines;
}

TextbookLine textbook_line(const lp::HalfPlane& h) {
  const double squared = squared_norm(h.normal);
  const lp::Vec2 foot = (h.offset / squared) * h.normal;
  const double inverse = 1.0 / std::sqrt(squared);
  return {static_cast<float>(foot.x), static_cast<float>(foot.y), static_cast<float>(h.normal.y * inverse),
          static_cast<float>(-h.normal.x * inverse)};
}

}  // namespace

void sort_hard_first(lp::Problem& problem) {
  std::stable_sort(problem.constraints.begin(), problem.constraints.end(),
                   [](const lp::Constraint& a, const lp::Constraint& b) {
                     return a.priority == lp::Priority::hard && b.priority == lp::Priority::soft;
                   });
}

template <class T>
Arrays<T>::Arrays(const std::vector<lp::Problem>& source)
    : count(source.size()),
      lines(longest(source)),
      stride((source.size() + kBlock - 1) / kBlock * kBlock),
      normal_x(lines * stride, T(1)),
      normal_y(lines * stride, T(0)),
      offset(lines * stride, static_cast<T>(kAlwaysHolds)),
      preferred_x(stride),
      preferred_y(stride),
      disc(stride, T(1)),
      hard(stride),
      velocity_x(stride),
      velocity_y(stride),
      violation(stride),
      status(stride),
      proven(stride) {
  for (std::size_t i = 0; i < count; ++i) {
    const lp::Problem& p = source[i];
    preferred_x[i] = static_cast<T>(p.preferred.x);
    preferred_y[i] = static_cast<T>(p.preferred.y);
    disc[i] = static_cast<T>(p.bound.disc);
    for (std::size_t k = 0; k < p.constraints.size(); ++k) {
      const lp::Constraint& c = p.constraints[k];
      const std::size_t at = i / kBlock * kBlock * lines + k * kBlock + i % kBlock;
      normal_x[at] = static_cast<T>(c.half_plane.normal.x);
      normal_y[at] = static_cast<T>(c.half_plane.normal.y);
      offset[at] = static_cast<T>(c.half_plane.offset);
      hard[i] += c.priority == lp::Priority::hard;
    }
    any_hard = any_hard || hard[i] > 0;
  }
}

template <class T>
lp::BatchProblems<T> Arrays<T>::problems() const {
  return {count,
          lines,
          kBlock,
          normal_x.data(),
          normal_y.data(),
          offset.data(),
          preferred_x.data(),
          preferred_y.data(),
          disc.data(),
          any_hard ? hard.data() : nullptr};
}

template <class T>
lp::BatchAnswers<T> Arrays<T>::answers(bool prove) {
  return {velocity_x.data(),
          velocity_y.data(),
          violation.data(),
          status.data(),
          nullptr,
          stride,
          prove ? proven.data() : nullptr};
}

template struct Arrays<float>;
template struct Arrays<double>;

TextbookSet::TextbookSet(const std::vector<lp::Problem>& problems) {
  first.push_back(0);
  for (const lp::Problem& p : problems) {
    int hard_lines = 0;
    for (const lp::Constraint& c : p.constraints) {
      lines.push_back(textbook_line(c.half_plane));
      hard_lines += c.priority == lp::Priority::hard;
    }
    first.push_back(lines.size());
    hard.push_back(hard_lines);
    speed.push_back(static_cast<float>(p.bound.disc));
    preferred_x.push_back(static_cast<float>(p.preferred.x));
    preferred_y.push_back(static_cast<float>(p.preferred.y));
  }
}

}  // namespace exactvo::bench
