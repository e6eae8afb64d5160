// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/escape.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace exactvo::tools {

namespace {

struct Character {
  std::size_t bytes = 1;
  std::uint32_t code = 0;
  bool valid = false;
};

unsigned byte_at(const std::string& text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

/// What a first byte promises: how many bytes, the bits it carries, and the least code that needs so many.
struct Promise {
  std::size_t bytes;
  std::uint32_t bits;
  std::uint32_t least;
};

Promise promise_of(unsigned first) {
  if (first < 0x80) return {1, first, 0};
  if (first >= 0xC0 && first < 0xE0) return {2, first & 0x1Fu, 0x80};
  if (first >= 0xE0 && first < 0xF0) return {3, first & 0x0Fu, 0x800};
  if (first >= 0xF0 && first < 0xF8) return {4, first & 0x07u, 0x10000};
  return {0, 0, 0};
}

Character character_at(const std::string& text, std::size_t i) {
  const Promise promise = promise_of(byte_at(text, i));
  if (promise.bytes == 0) return {};
  std::uint32_t code = promise.bits;
  for (std::size_t k = 1; k < promise.bytes; ++k) {
    const unsigned next = byte_at(text, i + k);
    if ((next & 0xC0u) != 0x80u) return {};
    code = (code << 6) | (next & 0x3Fu);
  }
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (code < promise.least || code > 0x10FFFF || surrogate) return {};
  return {promise.bytes, code, true};
}

bool is_harmless(const Character& c) {
  if (!c.valid || c.code < 0x20 || (c.code >= 0x7F && c.code < 0xA0)) return false;
  const bool separates_lines = c.code == 0x2028 || c.code == 0x2029;
  const bool turns_writing = c.code == 0x200E || c.code == 0x200F || (c.code >= 0x202A && c.code <= 0x202E) ||
                             (c.code >= 0x2066 && c.code <= 0x2069);
  return !separates_lines && !turns_writing;
}

std::string escaped(const std::string& bytes) {
  if (bytes == "\n") return "\\n";
  if (bytes == "\t") return "\\t";
  std::string text;
  for (const char c : bytes) text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return text;
}

std::string escaped_except(const std::string& text, const std::string& kept) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    const std::string bytes = text.substr(i, c.bytes);
    result += is_harmless(c) || bytes == kept ? bytes : escaped(bytes);
    i += c.bytes;
  }
  return result;
}

}  // namespace

std::string shown(const std::string& text) {
  return escaped_except(text, "");
}

std::string shown_lines(const std::string& text) {
  return escaped_except(text, "\n");
}

bool has_control_characters(const std::string& text) {
  return shown(text) != text;
}

}  // namespace exactvo::tools
