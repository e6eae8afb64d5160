// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Words for the values of an enumeration, from one table for both ways.

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace exactvo::geometry {

/// Each value with its word.
template <class Enum, std::size_t N>
using Names = std::array<std::pair<Enum, const char*>, N>;

/// The word of a value; "" where the table has none.
template <class Enum, std::size_t N>
const char* name_in(const Names<Enum, N>& names, Enum value) {
  for (const auto& [known, word] : names)
    if (known == value) return word;
  return "";
}

/// Sets `out` to the value of a word; false, and `out` as it was, where the table has no such word.
template <class Enum, std::size_t N>
bool parse_in(const Names<Enum, N>& names, const std::string& text, Enum& out) {
  for (const auto& [value, word] : names) {
    if (text != word) continue;
    out = value;
    return true;
  }
  return false;
}

/// All words, in the table's order.
template <class Enum, std::size_t N>
std::vector<std::string> words_in(const Names<Enum, N>& names) {
  std::vector<std::string> words;
  for (const auto& entry : names) words.emplace_back(entry.second);
  return words;
}

}  // namespace exactvo::geometry
