// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Instance sets in the layouts that the solvers want.

#include <new>
#include <string>
#include <vector>

#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/problem.h"
#include "textbook.h"

namespace exactvo::bench {

/// Problems with unit normals and a disc, hard lines first.
struct Set {
  std::string name;
  std::vector<lp::Problem> problems;
};

/// Memory that begins with a line of cache: a wide register loaded across two costs twice as much.
template <class T>
struct Aligned {
  using value_type = T;
  Aligned() = default;
  template <class U>
  Aligned(const Aligned<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
  template <class U>
  bool operator==(const Aligned<U>&) const {
    return true;
  }
  template <class U>
  bool operator!=(const Aligned<U>&) const {
    return false;
  }
};
template <class T>
using AlignedVector = std::vector<T, Aligned<T>>;

/// Problems of a set as arrays of T, padded to the longest.
template <class T>
struct Arrays {
  explicit Arrays(const std::vector<lp::Problem>& problems);
  lp::BatchProblems<T> problems() const;
  lp::BatchAnswers<T> answers(bool prove = false);

  std::size_t count, lines, stride;  ///< stride: count rounded up to whole blocks
  AlignedVector<T> normal_x, normal_y, offset, preferred_x, preferred_y, disc;
  std::vector<std::int32_t> hard;
  bool any_hard = false;
  AlignedVector<T> velocity_x, velocity_y, violation;
  std::vector<std::uint8_t> status, proven;
};

/// A set as the textbook solver wants it: hard lines first.
struct TextbookSet {
  explicit TextbookSet(const std::vector<lp::Problem>& problems);
  std::vector<TextbookLine> lines;
  std::vector<std::size_t> first;  ///< of problem i; count + 1 entries
  std::vector<int> hard;
  std::vector<float> speed, preferred_x, preferred_y;
};

/// Hard constraints first, otherwise in order: what arrays and files want.
void sort_hard_first(lp::Problem& problem);

}  // namespace exactvo::bench
