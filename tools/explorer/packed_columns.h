// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The columns of numbers of a packed run (packed_run.h), coded so that they deflate well; page/columns.js reads them.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace exactvo::tools {

/// Columns one after the other, each beginning at a multiple of 8 bytes.
class PackedColumns {
 public:
  /// Each entry XORed with the one `stride` before it, which leaves few bits of what changes slowly; then the bytes of
  /// all entries by their place in the entry. `stride` 0: no XOR.
  void add(const char* name, const std::vector<double>& values, std::size_t stride);
  /// The zigzag of each entry's second difference along `stride`: 0 of what moves evenly.
  void add(const char* name, const std::vector<std::int32_t>& values, std::size_t stride);
  void add(const char* name, const std::vector<std::uint32_t>& values);
  /// Each entry less the one `stride` before it. `stride` 0: as it is.
  void add(const char* name, const std::vector<std::uint8_t>& values, std::size_t stride);

  /// Of each column its name, type, number of entries and stride.
  const nlohmann::ordered_json& names() const { return names_; }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Word>
  void append(const char* name, const char* type, std::size_t stride, const std::vector<Word>& words);

  nlohmann::ordered_json names_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

}  // namespace exactvo::tools
