// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The numbers of a run as bytes, for its snapshots.

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "exactvo/formation/crowd.h"

namespace exactvo::formation::detail {

class StateWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void put_all(const T& values) {
    put(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) put(value);
  }
  void put_all(const std::string& bytes) {
    put(static_cast<std::uint64_t>(bytes.size()));
    bytes_ += bytes;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Throws CrowdError (bad_snapshot) where the bytes end too early.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : left_(bytes) {}

  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    const std::string_view bytes = take(sizeof(T));
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  template <class T>
  T get_all() {
    T values;
    const auto count = get<std::uint64_t>();
    require(count <= left_.size() / sizeof(typename T::value_type));
    for (std::uint64_t k = 0; k < count; ++k) values.push_back(get<typename T::value_type>());
    return values;
  }
  /// A stretch that begins with its size.
  std::string_view get_stretch() {
    const auto size = get<std::uint64_t>();
    require(size <= left_.size());
    return take(static_cast<std::size_t>(size));
  }
  void require(bool holds) const {
    if (!holds)
      throw CrowdError(CrowdProblem::bad_snapshot,
                       "snapshot: found other bytes, expected those of a run of this scenario and these options");
  }
  void require_end() const { require(left_.empty()); }

 private:
  std::string_view take(std::size_t size) {
    require(size <= left_.size());
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }

  std::string_view left_;
};

}  // namespace exactvo::formation::detail
