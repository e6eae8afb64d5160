// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the texts of certificates share: words with single blanks between them, hex floats, the digest.

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "exactvo/geometry/vec2.h"

namespace exactvo::vo::detail {

using geometry::Vec2;

/// Words separated by single spaces; the first that is not as expected makes everything after it fail.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  void expect(std::string_view word) { ok_ = ok_ && next() == word; }
  std::string_view next() {
    const std::size_t end = rest_.find(' ');
    const std::string_view word = rest_.substr(0, end);
    at_end_ = end == std::string_view::npos;
    rest_.remove_prefix(at_end_ ? rest_.size() : end + 1);
    return word;
  }
  double number() {
    std::string_view word = next();
    const bool negative = !word.empty() && word[0] == '-';
    if (negative) word.remove_prefix(1);
    double value = 0.0;
    if (ok_ && word == "inf" && !negative) return std::numeric_limits<double>::infinity();
    if (word.substr(0, 2) != "0x") ok_ = false;
    if (!ok_) return value;
    const char* const last = word.data() + word.size();
    const auto result = std::from_chars(word.data() + 2, last, value, std::chars_format::hex);
    ok_ = result.ec == std::errc() && result.ptr == last;
    return negative ? -value : value;
  }
  Vec2 point() {
    const double x = number();
    return {x, number()};
  }
  /// The same behind a word.
  void read(std::string_view name, double& x) {
    expect(name);
    x = number();
  }
  void read(std::string_view name, Vec2& v) {
    expect(name);
    v = point();
  }
  template <typename Integer>
  Integer integer(int base) {
    const std::string_view word = next();
    Integer value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value, base);
    ok_ = ok_ && result.ec == std::errc() && result.ptr == word.data() + word.size();
    return value;
  }
  std::uint64_t digest() {
    expect("digest");
    return integer<std::uint64_t>(16);
  }
  bool ok() const { return ok_; }
  bool finished() const { return ok_ && at_end_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
  bool at_end_ = false;
};

inline std::string digest_text(std::uint64_t digest) {
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(digest));
  return buffer;
}

inline std::uint64_t bits_of(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// FNV-1a, 64 bits, of 8-byte words, low byte first.
class Fnv {
 public:
  void add(double x) { add(bits_of(x)); }
  void add(Vec2 v) {
    add(v.x);
    add(v.y);
  }
  void add(std::uint64_t word) {
    for (int i = 0; i < 8; ++i) {
      hash_ ^= (word >> (8 * i)) & 0xFF;
      hash_ *= 0x100000001B3ULL;
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace exactvo::vo::detail
