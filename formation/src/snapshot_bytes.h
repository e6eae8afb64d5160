// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Numbers as bytes behind each other, with a checksum at the end: snapshots of crowds and of their runs.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ios>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactvo/formation/crowd.h"

namespace exactvo::formation::crowd {

/// Throws CrowdError: bad_snapshot.
[[noreturn]] inline void refuse_snapshot(const std::string& found, const std::string& expected) {
  throw CrowdError(CrowdProblem::bad_snapshot, "snapshot: found " + found + ", expected " + expected);
}

/// FNV-1a, a byte at a time.
class Checksum {
 public:
  void add(const void* bytes, std::size_t count) {
    const auto* b = static_cast<const unsigned char*>(bytes);
    for (std::size_t k = 0; k < count; ++k) hash_ = (hash_ ^ b[k]) * 1099511628211ULL;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

/// The number of doubles in a struct of doubles alone. Other structs are not written whole: bytes between their members
/// would go into the checksum.
template <class A>
inline constexpr std::size_t doubles_of = 0;
template <>
inline constexpr std::size_t doubles_of<geometry::Vec2> = 2;
template <>
inline constexpr std::size_t doubles_of<geometry::Segment> = 4;

template <class A>
inline constexpr bool is_plain = std::is_arithmetic_v<A> ||
                                 (std::is_trivially_copyable_v<A> && sizeof(A) == doubles_of<A> * sizeof(double));

class SnapshotWriter {
 public:
  explicit SnapshotWriter(std::ostream& to) : to_(to) {}

  /// Puts them in this order. `SnapshotReader::fields` takes the same list.
  template <class... Fields>
  void fields(const Fields&... values) {
    (put(values), ...);
  }
  template <class A>
  void put(const A& value) {
    put_all(&value, 1);
  }
  /// Whether there is one, then it or what stands for none.
  template <class A>
  void put(const std::optional<A>& value) {
    fields(value.has_value(), value.value_or(A{}));
  }
  /// Its size, and what it holds.
  template <class A>
  void put(const std::vector<A>& list) {
    put_list(list);
  }
  void put(const std::string& text) { put_list(text); }
  template <class A>
  void put_all(const A* values, std::size_t count) {
    static_assert(is_plain<A>);
    sum_.add(values, count * sizeof(A));
    to_.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(A)));
    if (!to_) throw std::ios_base::failure("a snapshot could not be written");
  }
  void finish() { put(std::uint64_t{sum_.value()}), to_.flush(); }

 private:
  template <class List>
  void put_list(const List& list) {
    put(static_cast<std::uint64_t>(list.size()));
    put_all(list.data(), list.size());
  }

  std::ostream& to_;
  Checksum sum_;
};

/// Refuses what ends too early or has another checksum; `expected` says what it should have been.
class SnapshotReader {
 public:
  SnapshotReader(std::istream& from, std::string expected) : from_(from), expected_(std::move(expected)) {}

  template <class... Fields>
  void fields(Fields&... values) {
    (get(values), ...);
  }
  template <class A>
  A get() {
    A value{};
    get(value);
    return value;
  }
  template <class A>
  void get(A& value) {
    get_all(&value, 1);
  }
  template <class A>
  void get(std::optional<A>& value) {
    const bool is_any = get<bool>();
    const A any = get<A>();
    value = is_any ? std::optional(any) : std::nullopt;
  }
  template <class A>
  void get(std::vector<A>& list) {
    get_some(list, get<std::uint64_t>());
  }
  void get(std::string& text) { get_some(text, get<std::uint64_t>()); }
  template <class A>
  void get_all(A* values, std::size_t count) {
    static_assert(is_plain<A>);
    from_.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(A)));
    require(!from_.fail(), "its end too early");
    sum_.add(values, count * sizeof(A));
  }
  /// In pieces: a count that was changed does not ask for more memory than there is to read.
  template <class List>
  void get_some(List& list, std::size_t count) {
    constexpr std::size_t kAtOnce = 1 << 16;
    list.clear();
    while (list.size() < count) {
      const std::size_t had = list.size(), more = std::min(kAtOnce, count - had);
      list.resize(had + more);
      get_all(list.data() + had, more);
    }
  }
  void finish() {
    const std::uint64_t computed = sum_.value();
    require(get<std::uint64_t>() == computed, "another checksum than its content has");
  }
  void require(bool holds, const char* found) const {
    if (!holds) refuse_snapshot(found, expected_);
  }

 private:
  std::istream& from_;
  std::string expected_;
  Checksum sum_;
};

}  // namespace exactvo::formation::crowd
