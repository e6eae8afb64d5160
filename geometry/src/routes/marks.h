// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A value for each number, emptied in no time: each number remembers the round in which it was given one.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace exactvo::geometry::routing {

/// Values of numbers, of which most are never given one.
template <typename T>
class Remembered {
 public:
  /// `round` for tests: how many times it was emptied before.
  explicit Remembered(std::size_t count = 0, std::uint32_t round = 1) : round_(round), entries_(count) {}

  void clear() {
    if (++round_ != 0) return;
    for (Entry& e : entries_) e.round = 0;
    round_ = 1;
  }
  /// Null where none was given.
  T* find(int i) {
    Entry& e = entries_[static_cast<std::size_t>(i)];
    return e.round == round_ ? &e.value : nullptr;
  }
  const T* find(int i) const { return const_cast<Remembered*>(this)->find(i); }
  void set(int i, const T& value) { entries_[static_cast<std::size_t>(i)] = {value, round_}; }

 private:
  struct Entry {
    T value{};
    std::uint32_t round = 0;
  };
  std::uint32_t round_;
  std::vector<Entry> entries_;
};

}  // namespace exactvo::geometry::routing
