// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/escape.h"

#include <fmt/format.h>

#include <boost/locale/utf.hpp>

namespace exactvo::tools {

namespace {

using boost::locale::utf::code_point;

/// Bytes that are no UTF-8 have no code.
bool is_harmless(code_point c) {
  if (!boost::locale::utf::is_valid_codepoint(c) || c < 0x20 || (c >= 0x7F && c < 0xA0)) return false;
  const bool separates_lines = c == 0x2028 || c == 0x2029;
  const bool turns_writing = c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
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
  for (auto at = text.begin(); at != text.end();) {
    auto next = at;
    const code_point c = boost::locale::utf::utf_traits<char>::decode(next, text.end());
    if (!boost::locale::utf::is_valid_codepoint(c)) next = at + 1;
    const std::string bytes(at, next);
    result += is_harmless(c) || bytes == kept ? bytes : escaped(bytes);
    at = next;
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
